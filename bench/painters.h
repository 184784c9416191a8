/* painters.h: a scene's forest with both that paint it, to be held against each other. */
#ifndef BENCH_PAINTERS_H
#define BENCH_PAINTERS_H

#include <stdbool.h>

#include "weald/reference.h"

struct painters {
    struct wd_forest *forest;
    struct wd_renderer *renderer;
    struct wd_reference *reference;
};

/* `settings`: as of struct wd_forest_params. To be finished where it fails, too. */
bool painters_init(struct painters *painters, const char *scene, const char *const *settings,
                   const char *gpu);
void painters_finish(struct painters *painters); /* accepts {0} */

/* Both pictures are the caller's to finish, whatever comes back; {0} before. */
bool painters_paint(const struct painters *painters, const struct wd_render_params *draw,
                    const struct wd_reference_picture_params *trace, struct wd_picture *drawn,
                    struct wd_picture *traced);

#endif
