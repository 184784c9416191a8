#include "reference/view.h"

#include <math.h>

#include "world/surroundings.h"

struct wd_trace_view wd_trace_view_of(const struct wd_camera *camera, uint32_t width,
                                      uint32_t height)
{
    double right[3], forward[3], up[3];
    wd_camera_axes(camera, right, forward, up);
    double half_height = tan(camera->fov_rad * 0.5), half_width = half_height * width / height;
    struct wd_trace_view view = {.width = width, .height = height};
    view.right = WD_V3(right[0] * half_width, right[1] * half_width, right[2] * half_width);
    view.up = WD_V3(up[0] * half_height, up[1] * half_height, up[2] * half_height);
    view.forward = WD_V3(forward[0], forward[1], forward[2]);
    return view;
}

float wd_trace_pixel_rad(const struct wd_trace_view *view)
{
    return 2 * wd_v3_length(view->up) / (float)view->height;
}

struct wd_vec3 wd_trace_view_ray(const struct wd_trace_view *view, float x, float y)
{
    float across = 2 * x / (float)view->width - 1, down = 2 * y / (float)view->height - 1;
    return wd_v3_mad(wd_v3_mad(view->forward, view->right, across), view->up, -down);
}

/* How far within the plane of `normal` through the eye the way comes. */
static float farthest(struct wd_vec3 normal, struct wd_vec3 from, struct wd_vec3 to)
{
    struct wd_vec3 unit = wd_v3_unit(normal);
    return wd_maxf(wd_v3_dot(unit, from), wd_v3_dot(unit, to));
}

bool wd_trace_view_sees(const struct wd_trace_view *view, struct wd_vec3 from, struct wd_vec3 to, float radius_m)
{
    if (view->lens_m > 0) /* rays leave all of the lens, meet at focus_m, and part again */
        radius_m += view->lens_m *
                    wd_maxf(1, wd_maxf(wd_v3_length(from), wd_v3_length(to)) / view->focus_m);
    const struct wd_vec3 sides[2] = {view->right, view->up};
    bool seen = farthest(view->forward, from, to) >= -radius_m;
    for (int i = 0; i < 2; i++) {
        float half = wd_v3_length(sides[i]);
        struct wd_vec3 ahead = wd_v3_scale(view->forward, half * half);
        seen = seen && farthest(wd_v3_sub(ahead, sides[i]), from, to) >= -radius_m &&
               farthest(wd_v3_mad(ahead, sides[i], 1), from, to) >= -radius_m;
    }
    return seen;
}
