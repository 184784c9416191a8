/* viewer.h: a window to walk and fly through a forest. */
#ifndef VIEWER_VIEWER_H
#define VIEWER_VIEWER_H

#include "weald/renderer.h"

struct wd_viewer_params {
    const char *scene_path; /* its name is on the window; saved cameras lie beside it */
    const char *camera;     /* of the scene, or saved; NULL: the first */
    const char *path;       /* played from the beginning; NULL: none */
    const char *method;     /* NULL: the scene's */
    enum wd_view_mode view;
    uint32_t width, height;     /* of the window; 0: 1280x720 */
    double max_error_px;        /* see struct wd_render_params; 0: the method's own */
    double budget_ms;           /* of a frame, held by the error; 0: none */
    double max_fps;             /* frames a second at most; 0: as many as the display shows */
    bool single;                /* each frame by itself: nothing is accumulated */
    bool walk;                  /* begin on foot */
    const char *screenshot_dir; /* NULL: the working directory */
    const char *report_path;    /* where lines of JSON about the state go; NULL: nowhere */
    const char *gpu;
    enum wd_validation validation;
    unsigned threads;
    struct wd_log log;
    struct wd_progress progress;      /* of loading */
    bool (*keep_running)(void *user); /* asked once a frame; false closes the window. May be NULL */
    void *user;
};

/* Whether a window could be opened here; says why not. */
bool wd_viewer_display_present(const struct wd_log *log);

/* A camera that was saved beside the scene. False: none is called so, or the file cannot be understood, which is told. */
bool wd_viewer_saved_camera(struct wd_camera *camera, const char *scene_path, const char *name, const struct wd_log *log);

/* Shows `forest` until the window is closed or Escape is pressed: WD_OK. */
enum wd_result wd_viewer_run(const struct wd_forest *forest, const struct wd_viewer_params *params);

#endif
