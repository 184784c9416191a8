/* painter.h: what makes `render`'s pictures: the renderer, or with --reference the path tracer. */
#ifndef CLI_PAINTER_H
#define CLI_PAINTER_H

#include "picture.h"
#include "weald/reference.h"

struct cli_painter {
    struct cli_session *session;
    struct wd_renderer *renderer;   /* one of both */
    struct wd_reference *reference;
    char *checkpoint;               /* of a single picture by path tracing; NULL: none */
};

enum wd_result cli_painter_open(struct cli_painter *painter, struct cli_session *session,
                                const struct wd_forest *forest, const struct cli_plan *plan);
enum wd_result cli_painter_paint(struct cli_painter *painter, const struct wd_render_params *params,
                                 struct wd_picture *picture);
/* Times of the newest picture, if they were asked for. */
void cli_painter_print_times(struct cli_painter *painter);
void cli_painter_close(struct cli_painter *painter); /* accepts {0} */

#endif
