/* film.h: many frames along a path, or of the wind before a standing camera. */
#ifndef CLI_FILM_H
#define CLI_FILM_H

#include "painter.h"

struct cli_film {
    struct cli_session *session;
    const struct wd_forest *forest;
    const struct cli_plan *plan;
    struct wd_film *output;
    const char *path;  /* NULL: the camera stands still */
    struct wd_camera camera; /* at the beginning */
    double duration_s; /* of the path */
    double frames_per_second;
    uint64_t frame_count; /* of the whole film */
    uint64_t first_frame, frames_wanted, frames_done;
    struct wd_budget budget; /* with --budget-ms */
    uint64_t over_budget;    /* frames that took longer */
};

/* Whether --only, if it is given, can be followed. */
bool cli_only_check(struct cli_session *session, bool numbered);
/* As asked for, or as usual. */
double cli_frames_per_second(const struct cli_options *options);
/* Where a camera was that goes on to `next` as it came `here`. */
void cli_camera_before(struct wd_camera *before, const struct wd_camera *here, const struct wd_camera *next);

/* Settles the frames and opens the output, before the long work. `*film` is ready for
 * cli_film_close whatever the result. */
enum wd_result cli_film_open(struct cli_film *film, struct cli_session *session,
                             const struct wd_forest *forest, const struct cli_plan *plan);
enum wd_result cli_film_shoot(struct cli_film *film, struct cli_painter *painter);
/* Keeps the finished frames unless the output itself failed, and says so. Returns `result`, or
 * what went wrong in finishing. */
enum wd_result cli_film_close(struct cli_film *film, enum wd_result result);

#endif
