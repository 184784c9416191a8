/* Light space perspective shadow maps (Wimmer, Scherzer and Purgathofer 2004): one map of all that the
 * camera sees, warped so that more of it is spent near the eye. */
#include <math.h>
#include <string.h>

#include "frame/view.h"
#include "world/surroundings.h"

/* Seen more along the sun's rays than this (sine), maps are warped no further. */
static const double LEAST_SINE = 0.05;
/* As those of frame/cascades.c. */
static const double MARGIN_M = 3.0, LEAST_RISE = 0.05, FARTHEST_CASTER_M = 20000.0;

static void cross(double c[3], const double a[3], const double b[3])
{
    for (int k = 0; k < 3; k++)
        c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

/* Axes across the sun's rays: `up` lies as the camera looks. Returns the sine of the angle between. */
static double set_axes(struct wd_cascade_box *box, const struct wd_cascades_params *params,
                       const double forward[3], const double camera_up[3])
{
    for (int k = 0; k < 3; k++)
        box->toward[k] = params->sun_direction[k];
    const double *ahead = forward;
    double sine = sqrt(fmax(1 - wd_dot(forward, box->toward) * wd_dot(forward, box->toward), 0));
    if (sine < LEAST_SINE) {
        ahead = camera_up;
        sine = LEAST_SINE;
    }
    double along = wd_dot(ahead, box->toward), length = sqrt(fmax(1 - along * along, 1e-6));
    for (int k = 0; k < 3; k++)
        box->up[k] = (ahead[k] - along * box->toward[k]) / length;
    cross(box->right, box->up, box->toward);
    return sine;
}

enum { SIDE = 9, PLACES = 2 * SIDE * SIDE };

/* What the camera may see, along those axes, from the eye: ends of rays through the picture, as far as
 * they stay between the lowest ground and the highest tree. */
struct bounds {
    double low[3], high[3];
    double place[PLACES][3];
};

static double way_between(const struct wd_cascades_params *params, const double ray[3],
                          double far_m)
{
    double up_m = params->max_z_m - params->view->eye_m[2];
    double down_m = params->min_z_m - params->view->eye_m[2];
    if (ray[2] * far_m > fmax(up_m, MARGIN_M))
        return fmax(up_m, MARGIN_M) / ray[2];
    return ray[2] * far_m < fmin(down_m, -MARGIN_M) ? fmin(down_m, -MARGIN_M) / ray[2] : far_m;
}

static void add_place(struct bounds *bounds, const struct wd_cascade_box *box, int i,
                      const double ray[3], double way_m)
{
    const double *axes[3] = {box->right, box->up, box->toward};
    for (int axis = 0; axis < 3; axis++) {
        double at_m = way_m * wd_dot(ray, axes[axis]);
        bounds->place[i][axis] = at_m;
        bounds->low[axis] = fmin(bounds->low[axis], at_m - MARGIN_M);
        bounds->high[axis] = fmax(bounds->high[axis], at_m + MARGIN_M);
    }
}

static void find_bounds(struct bounds *bounds, const struct wd_cascade_box *box,
                        const struct wd_cascades_params *params, double near_m, double far_m)
{
    const struct wd_view *view = params->view;
    double right[3], forward[3], up[3], ray[3];
    const struct wd_half_view half = wd_half_view_of(view);
    wd_camera_axes(&view->camera, right, forward, up);
    for (int axis = 0; axis < 3; axis++) {
        bounds->low[axis] = INFINITY;
        bounds->high[axis] = -INFINITY;
    }
    for (int i = 0; i < PLACES; i++) {
        double x = half.width * (2.0 * (i % SIDE) / (SIDE - 1) - 1);
        double y = half.height * (2.0 * (i / SIDE % SIDE) / (SIDE - 1) - 1);
        for (int k = 0; k < 3; k++)
            ray[k] = forward[k] + x * right[k] + y * up[k];
        add_place(bounds, box, i, ray,
                  way_between(params, ray, i < PLACES / 2 ? near_m : far_m));
    }
}

/* The map is seen from a point `before_m` before what it holds: x and y over the distance from there,
 * which is w. Depth is 0 at the lowest place and at most 1. */
static void set_matrix(struct wd_view *map, const struct bounds *bounds, double before_m,
                       float texels, struct wd_frame_uniforms *uniforms)
{
    const struct wd_cascade_box *box = &map->box;
    double from = bounds->low[1] - before_m, span = bounds->high[1] - bounds->low[1];
    double wide = 0, deep = bounds->high[2] - bounds->low[2];
    for (int i = 0; i < PLACES; i++)
        wide = fmax(wide, (fabs(bounds->place[i][0]) + MARGIN_M) / (bounds->place[i][1] - from));
    double y_scale = (2 * before_m + span) / span, y_move = -2 * before_m * (before_m + span) / span;
    for (int k = 0; k < 3; k++) {
        map->clip_from_rel[k][0] = (float)(box->right[k] / wide);
        map->clip_from_rel[k][1] = (float)(box->up[k] * y_scale);
        map->clip_from_rel[k][2] = (float)(box->toward[k] * before_m / deep);
        map->clip_from_rel[k][3] = (float)box->up[k];
    }
    map->clip_from_rel[3][0] = 0;
    map->clip_from_rel[3][1] = (float)(-from * y_scale + y_move);
    map->clip_from_rel[3][2] = (float)(-bounds->low[2] * before_m / deep);
    map->clip_from_rel[3][3] = (float)-from;
    for (int i = 0; i < WD_CASCADES; i++) {
        uniforms->cascades[i][WD_CASCADE_TEXEL_M] = (float)(2 * wide) / texels;
        uniforms->cascades[i][WD_CASCADE_DEPTH_M] = (float)(deep / before_m);
    }
}

static void set_planes(struct wd_view *map)
{
    for (int plane = 0; plane < 5; plane++) {
        int row = plane / 2;
        float sign = plane % 2 ? -1.0f : 1.0f;
        for (int k = 0; k < 4; k++)
            map->frustum.planes[plane][k] = sign * map->clip_from_rel[k][row] +
                                            (row < 2 ? map->clip_from_rel[k][3] : 0.0f);
    }
    map->frustum.count = 5;
}

static void set_uniforms(struct wd_frame_uniforms *uniforms, const struct wd_view *map, float far_m)
{
    for (int i = 0; i < WD_CASCADES; i++) {
        uniforms->cascades[i][WD_CASCADE_FAR_M] = far_m;
        uniforms->cascades[i][WD_CASCADE_FADE_M] = 0.0f;
    }
    for (int column = 0; column < 4; column++) {
        const float *clip = map->clip_from_rel[column];
        const float texture[4] = {0.5f * (clip[0] + clip[3]), 0.5f * (clip[1] + clip[3]), clip[2],
                                  clip[3]};
        memcpy(uniforms->shadow_from_rel[0][column], texture, sizeof texture);
    }
}

void wd_perspective_map_init(struct wd_view *map, struct wd_frame_uniforms *uniforms,
                             const struct wd_cascades_params *params)
{
    const struct wd_view *view = params->view;
    double right[3], forward[3], up[3], far_m = params->distance_m;
    double near_m = fmin(fmax(params->near_m, 0.66 * params->nearest_m), 0.5 * far_m);
    wd_camera_axes(&view->camera, right, forward, up);
    *map = (struct wd_view){.camera = view->camera,
                            .width = params->size,
                            .height = params->size,
                            .pixels_per_radian = view->pixels_per_radian,
                            .lod_scale = view->lod_scale,
                            .samples = view->samples};
    memcpy(map->eye_m, view->eye_m, sizeof map->eye_m);
    double sine = set_axes(&map->box, params, forward, up);
    struct bounds bounds;
    find_bounds(&bounds, &map->box, params, near_m, far_m);
    /* casters stand between the slice and the sun, no higher than the highest of all */
    double rise = fmax(map->box.toward[2], LEAST_RISE);
    double over_m = (params->max_z_m - params->min_z_m) / rise;
    bounds.high[2] += fmin(over_m, FARTHEST_CASTER_M);
    double span = bounds.high[1] - bounds.low[1];
    double before_m = (near_m + sqrt(near_m * (near_m + span * sine))) / sine;
    set_matrix(map, &bounds, before_m, (float)params->size, uniforms);
    set_planes(map);
    set_uniforms(uniforms, map, params->distance_m);
}
