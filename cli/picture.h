/* picture.h: what `render` has been asked to draw. */
#ifndef CLI_PICTURE_H
#define CLI_PICTURE_H

#include "output_name.h"

struct cli_plan {
    enum cli_output_kind kind;
    bool film;
    struct wd_render_params params; /* the camera apart, the same for all frames */
};

/* "FILE: WHAT 1280x720, 16 samples, 2.1 MB, 12.3 s" */
void cli_say_written(struct cli_session *session, const struct cli_plan *plan, const char *what);

#endif
