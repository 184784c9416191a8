/* state.h: all that the window's loop knows; shared by the viewer's own files only. */
#ifndef VIEWER_STATE_H
#define VIEWER_STATE_H

#include <SDL.h>

#include "cameras.h"
#include "motion.h"
#include "overlay.h"
#include "swapchain.h"
#include "viewer.h"

enum viewer_hold_key {
    VIEWER_FORWARD,
    VIEWER_BACK,
    VIEWER_LEFT,
    VIEWER_RIGHT,
    VIEWER_DOWN,
    VIEWER_UP,
    VIEWER_HOLD_KEYS,
};

/* A key that works as long as it is held, however long a frame takes. */
struct viewer_hold {
    bool down;
    double since_s; /* of the time not yet in held_s, while down */
    double held_s;  /* not yet taken by a step */
};

struct viewer_state {
    const struct wd_viewer_params *params;
    const struct wd_forest *forest;
    struct wd_renderer *renderer;
    SDL_Window *window;
    struct viewer_swapchain swapchain;
    struct viewer_overlay overlay;
    struct viewer_cameras cameras;
    struct viewer_motion motion;
    struct viewer_hold holds[VIEWER_HOLD_KEYS];
    double look_yaw_rad, look_pitch_rad; /* turned since the last step */
    const char *method, *drawn_method; /* the latter of the newest frame; NULL: there is none */
    const char *camera_name; /* of the camera last jumped to */
    uint32_t camera_index;   /* the scene's first, then the saved ones */
    enum wd_view_mode view;
    struct wd_sun sun; /* where it stands, once it */
    bool sun_moved;
    double path_time_s; /* < 0: no path is played */
    double begin_s, now_s, step_s;
    uint64_t frame_count;
    unsigned screenshot_count;
    uint32_t picked_id; /* 0: no tree */
    double frame_ms; /* from frame to frame, smoothed */
    struct wd_budget budget; /* where the parameters ask for one */
    char notice[256];
    double notice_until_s;
    uint64_t notice_until_frame; /* the later of both */
    bool accumulates;
    bool grabbed, times_shown, help_shown, quit;
    bool stale;     /* the swapchain no longer fits the window */
    bool minimised; /* told so by the window system */
    bool no_area;   /* the window has no pixels */
};

double viewer_seconds(void);
/* Whether the frame's time is held by the error bound. */
bool viewer_has_budget(const struct viewer_state *viewer);
/* As in struct wd_render_params. */
double viewer_error_px(const struct viewer_state *viewer);

/* As in struct wd_render_params. */
const struct wd_sun *viewer_sun(const struct viewer_state *viewer);

/* --- input.c */
void viewer_input_event(struct viewer_state *viewer, const SDL_Event *event);
/* Lets no time have passed in a pause that ends now: neither wind, path nor camera leap after a picture. */
void viewer_input_pause(struct viewer_state *viewer, double paused_s);
/* Moves the camera by all that was pressed since the last call. */
void viewer_input_step(struct viewer_state *viewer);

/* --- actions.c: what keys do */
void viewer_act_gait(struct viewer_state *viewer);
void viewer_act_method(struct viewer_state *viewer);
void viewer_act_method_before(struct viewer_state *viewer);
/* A quarter of an hour. */
void viewer_act_later(struct viewer_state *viewer);
void viewer_act_earlier(struct viewer_state *viewer);
void viewer_act_lod(struct viewer_state *viewer);
void viewer_act_accumulate(struct viewer_state *viewer);
void viewer_act_times(struct viewer_state *viewer);
void viewer_act_help(struct viewer_state *viewer);
void viewer_act_grab(struct viewer_state *viewer);
void viewer_act_quit(struct viewer_state *viewer);
void viewer_act_play(struct viewer_state *viewer);
void viewer_act_next_camera(struct viewer_state *viewer);
void viewer_act_save_camera(struct viewer_state *viewer);
void viewer_act_screenshot(struct viewer_state *viewer);
/* Tells of the tree at a place of the window, in its own units. */
void viewer_act_pick(struct viewer_state *viewer, int x, int y);
void viewer_act_report(struct viewer_state *viewer);
void viewer_notice(struct viewer_state *viewer, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
struct viewer_ground viewer_ground(const struct viewer_state *viewer);

/* --- report.c: appends a line of JSON to the report file, if one is wanted */
bool viewer_report(const struct viewer_state *viewer, const char *event);

/* --- status.c: the texts of the panels */
struct viewer_texts {
    char status[256], times[2048];
};
struct viewer_panels_content viewer_status(const struct viewer_state *viewer,
                                           struct viewer_texts *texts);

#endif
