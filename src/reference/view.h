/* view.h: the camera of a traced picture. Its place is the origin of rays' frame (reference/scene.h). */
#ifndef WD_REFERENCE_VIEW_H
#define WD_REFERENCE_VIEW_H

#include <stdbool.h>

#include "tree/vec.h"
#include "weald/forest.h"

struct wd_trace_view {
    struct wd_vec3 right, up, forward; /* to the picture's right and upper edge; of unit length */
    uint32_t width, height;
    float lens_m, focus_m; /* radius of the lens, distance of what is sharp; 0: a pinhole */
};
/* The view through a camera; its lens is a pinhole. */
struct wd_trace_view wd_trace_view_of(const struct wd_camera *camera, uint32_t width,
                                      uint32_t height);
/* Angle that a pixel in the picture's middle spans. */
float wd_trace_pixel_rad(const struct wd_trace_view *view);

/* Through a place in the picture, in pixels from its upper left corner; 1 m along the view axis. */
struct wd_vec3 wd_trace_view_ray(const struct wd_trace_view *view, float x, float y);

/* False where nothing nearer than `radius_m` to the way between two places can be in the picture. */
bool wd_trace_view_sees(const struct wd_trace_view *view, struct wd_vec3 from, struct wd_vec3 to, float radius_m);

#endif
