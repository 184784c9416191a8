/* sheet_error.h: how far a form of a tree is from its full mesh, by two pictures of it. */
#ifndef CLI_SHEET_ERROR_H
#define CLI_SHEET_ERROR_H

#include <stdint.h>

#include "weald/renderer.h"

/* What a picture shows of trees. */
struct cli_shown {
    double pixels;    /* covered, of a cell */
    double radiance;  /* mean luminance of what covers them */
    float *luminance; /* side x side, 0 where no tree is; NULL: not taken */
    uint32_t side;
};
void cli_shown_finish(struct cli_shown *shown); /* accepts {0} */

/* Times as many pixels along a side as a cell of `side` pixels has, which the full mesh is measured with:
 * 8, or fewer where the picture would be larger than 2048 pixels. */
uint32_t cli_shown_zoom(uint32_t side);

/* Takes a square picture of side * zoom pixels, with colour and tree ids, drawn with one sample. */
bool cli_shown_take(struct cli_shown *shown, const struct wd_picture *picture, uint32_t zoom);

struct cli_form_error {
    double coverage_pct, radiance_pct; /* bias */
    double picture_pct; /* root mean square of pixels' differences, over the mean radiance of trees */
};
struct cli_form_error cli_form_error_of(const struct cli_shown *form, const struct cli_shown *full);

#endif
