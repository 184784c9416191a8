/* grow.h: single trees as pictures, models and contact sheets. */
#ifndef CLI_GROW_H
#define CLI_GROW_H

#include "cli.h"
#include "weald/tree.h"

struct cli_specimen_view {
    uint32_t width, height, samples;
    uint32_t layers;   /* wd_layer_bits */
    double distance_m; /* of the eye; 0: so that all is in the frame */
    enum wd_specimen_form form;
    const char *method;
    enum wd_time_mode timing;
};

/* Draws specimens on plain ground; free the picture with wd_picture_finish whatever the result. */
enum wd_result cli_specimens_picture(struct cli_session *session, struct wd_renderer *renderer,
                                     const struct wd_specimen *const *specimens, uint32_t count,
                                     const struct cli_specimen_view *view,
                                     struct wd_picture *picture);

/* The month that --month or --season name; 0: none. */
bool cli_season_month(struct cli_session *session, double *month);

/* Draws the sheet that --sheet asks for. */
enum wd_result cli_sheet(struct cli_session *session);

#endif
