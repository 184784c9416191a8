#include "frame/view.h"

#include <math.h>
#include <string.h>

#include "world/surroundings.h"

/* A cascade ends at this share of the next one's distance. */
static const double CASCADE_RATIO = 0.28;
/* The nearest and the farthest seen are counted in steps of these, so that a moving camera seldom changes
 * them; in smaller ones, so many from one to the other, where a long lens sees them close together. */
static const double NEAREST_STEP = 1.5, FARTHEST_STEP = 1.1, STEPS_BETWEEN = 8.0;
/* Through a long lens a slice is a rod: where a square about it is smaller than this share of the
 * sphere, the map holds that. Its size is counted in steps, too. */
static const double LENS_SHARE = 0.7;
static const double SIZE_STEP = 1.1;
/* Slices overlap where one fades into the next: by a share of the way to the first's end, where it is
 * thin by one of itself. */
static const double FADE = 0.1, FADE_THIN = 0.15;
/* Look-ups of what lies at a slice's edge. */
static const double LOOK_MARGIN_M = 0.2;
/* Cascades of leaves are not calm where anything is seen from nearer than this, or through a longer lens from
 * as many times farther. */
static const float LEAVES_M = 25.0f;
/* Penumbras and the offsets of shadow look-ups reach this far. */
static const float CASTER_MARGIN_M = 3.0f;
/* A lower sun than with this sine casts no longer shadows; nor do casters stand farther off than this. Maps hold so
 * much more, behind and before. */
static const double LEAST_RISE = 0.05, FARTHEST_CASTER_M = 20000.0, DEPTH_SPARE_M = 32.0;

static void sun_axes(struct wd_cascade_box *box, const float direction[3])
{
    double *t = box->toward, *r = box->right;
    for (int k = 0; k < 3; k++)
        t[k] = direction[k];
    /* Any axis across the sun's direction does, so long as it does not turn with the camera. */
    double length = hypot(t[0], t[1]);
    r[0] = length < 1e-4 ? 1.0 : -t[1] / length;
    r[1] = length < 1e-4 ? 0.0 : t[0] / length;
    box->up[0] = t[1] * r[2] - t[2] * r[1];
    box->up[1] = t[2] * r[0] - t[0] * r[2];
    box->up[2] = t[0] * r[1] - t[1] * r[0];
}

/* The sphere round the slice [near, far] of the view: centre on the axis at `*center` metres. */
static double slice_sphere(const struct wd_view *view, double near, double far, double *center)
{
    const struct wd_half_view half = wd_half_view_of(view);
    double corner = half.height * half.height + half.width * half.width; /* per metre, squared */
    double middle = 0.5 * (near + far) * (1.0 + corner);
    if (middle > far)
        middle = far;
    *center = middle;
    return sqrt((far - middle) * (far - middle) + corner * far * far);
}

/* Half of the side of the square across the sun's rays that holds the slice, and its middle along
 * `right` and `up`; counted in steps, so that a turning camera seldom changes the map's texels. */
static double slice_square(const struct wd_cascade_box *box, const struct wd_view *view, double near,
                           double far, double middle[2])
{
    const struct wd_half_view half = wd_half_view_of(view);
    double right[3], forward[3], up[3], half_m = 0.0;
    wd_camera_axes(&view->camera, right, forward, up);
    const double *axes[2] = {box->right, box->up};
    for (int axis = 0; axis < 2; axis++) {
        double wide = fabs(half.width * wd_dot(right, axes[axis])) +
                      fabs(half.height * wd_dot(up, axes[axis]));
        double along = wd_dot(forward, axes[axis]);
        double low = fmin(near * (along - wide), far * (along - wide));
        double high = fmax(near * (along + wide), far * (along + wide));
        middle[axis] = wd_dot(view->eye_m, axes[axis]) + 0.5 * (low + high);
        half_m = fmax(half_m, 0.5 * (high - low));
    }
    return pow(SIZE_STEP, ceil(log(half_m + LOOK_MARGIN_M) / log(SIZE_STEP)));
}

/* Moves the centre by whole texels, calm maps by large steps that they have room for, so that a
 * camera that moves or turns changes little. */
static void snap(struct wd_cascade_box *box, const struct wd_cascades_params *params,
                 double center[3])
{
    const double *axes[3] = {box->right, box->up, box->toward};
    double step = 2.0 * box->radius / params->size;
    if (box->calm) {
        step = box->radius / 8.0;
        box->radius += step;
    }
    for (int k = 0; k < 3; k++) {
        if (box->calm || k < 2)
            box->center[k] = floor(box->center[k] / step + 0.5) * step;
    }
    for (int k = 0; k < 3 && box->calm; k++)
        center[k] = axes[0][k] * box->center[0] + axes[1][k] * box->center[1] +
                    axes[2][k] * box->center[2];
}

static bool is_calm(const struct wd_cascades_params *params, int cascade, double radius)
{
    bool leaves = cascade < WD_LEAF_CASCADES && params->nearest_m < LEAVES_M * params->view->lod_scale;
    return params->calm_m > 0.0 && !leaves && 2.0 * radius / params->size >= params->calm_m;
}

static void cascade_box(struct wd_cascade_box *box, const struct wd_cascades_params *params,
                        int cascade, double near, double far)
{
    const struct wd_view *view = params->view;
    double distance, center[3];
    /* Rounded up, so that a turning camera changes nothing. */
    double radius = ceil(slice_sphere(view, near, far, &distance) * 16.0) / 16.0;
    *box = (struct wd_cascade_box){.radius = radius, .calm = is_calm(params, cascade, radius)};
    double right[3], forward[3], up[3];
    wd_camera_axes(&view->camera, right, forward, up);
    for (int k = 0; k < 3; k++)
        center[k] = view->eye_m[k] + forward[k] * distance;
    sun_axes(box, params->sun_direction);
    const double *axes[3] = {box->right, box->up, box->toward};
    for (int k = 0; k < 3; k++)
        box->center[k] = wd_dot(center, axes[k]);
    double middle[2], half_m = slice_square(box, view, near, far, middle);
    if (half_m < LENS_SHARE * box->radius) {
        box->radius = half_m;
        memcpy(box->center, middle, sizeof middle);
    }
    snap(box, params, center);
    radius = fmax(radius, box->radius);
    /* Casters stand between the slice and the sun, no higher than the highest of all. */
    double rise = fmax(box->toward[2], LEAST_RISE);
    double reach = (params->max_z_m - (center[2] - radius)) / rise;
    double extent = fmin(fmax(reach, 2.0 * radius), 2.0 * radius + FARTHEST_CASTER_M);
    box->depth = extent + 2.0 * DEPTH_SPARE_M;
    box->center[2] -= radius + DEPTH_SPARE_M;
}

static void cascade_view(struct wd_view *cascade, const struct wd_view *view, const double eye_m[3])
{
    const struct wd_cascade_box *box = &cascade->box;
    cascade->camera = view->camera;
    memcpy(cascade->eye_m, eye_m, sizeof cascade->eye_m);
    cascade->pixels_per_radian = view->pixels_per_radian;
    cascade->lod_scale = view->lod_scale;
    cascade->samples = view->samples;
    const double *rows[3] = {box->right, box->up, box->toward};
    const double scale[3] = {1.0 / box->radius, 1.0 / box->radius, 1.0 / box->depth};
    for (int row = 0; row < 3; row++) {
        double origin = (wd_dot(eye_m, rows[row]) - box->center[row]) * scale[row];
        for (int k = 0; k < 3; k++)
            cascade->clip_from_rel[k][row] = (float)(rows[row][k] * scale[row]);
        cascade->clip_from_rel[3][row] = (float)origin;
    }
    cascade->clip_from_rel[3][3] = 1.0f;
    /* -1 <= x, y <= 1 and 0 <= z; nothing lies beyond z = 1 */
    for (int plane = 0; plane < 5; plane++) {
        int row = plane / 2;
        float sign = plane % 2 ? -1.0f : 1.0f;
        for (int k = 0; k < 4; k++)
            cascade->frustum.planes[plane][k] = sign * cascade->clip_from_rel[k][row];
        cascade->frustum.planes[plane][3] += row < 2 ? 1.0f : 0.0f;
    }
    cascade->frustum.count = 5;
}

/* Metres that the camera sees: what is nearest, and both ends as cascades share them out. */
struct seen {
    double nearest, near, far;
};

/* The logarithm of a step no larger than either: halves of the first, so that it seldom changes itself. */
static double log_step(double largest, double wanted)
{
    double step = log(largest);
    while (step > log(wanted))
        step *= 0.5;
    return step;
}

static struct seen seen_range(const struct wd_cascades_params *params)
{
    double first = params->distance_m * pow(CASCADE_RATIO, WD_CASCADES);
    double near = fmin(params->nearest_m, 0.99 * params->distance_m); /* slices have a depth */
    double far = fmin(params->farthest_m, params->distance_m);
    double step = pow(fmax(far / fmax(near, first), 1.001), 1.0 / STEPS_BETWEEN);
    double near_step = log_step(NEAREST_STEP, step), far_step = log_step(FARTHEST_STEP, step);
    struct seen seen = {near, first, params->distance_m};
    if (near > first)
        seen.near = first * exp(near_step * floor(log(near / first) / near_step));
    if (far < params->distance_m)
        seen.far = fmax(exp(far_step * ceil(log(far) / far_step)), 2.0 * params->near_m);
    seen.far = fmax(seen.far, fmax(near, seen.near) * exp(far_step));
    return seen;
}

/* Where cascade i ends: a fixed ratio between neighbours, drawn out so that the first begins at the
 * nearest thing seen; but for the last no farther than the ground where the camera looks down on it. */
static double cascade_end(const struct wd_cascades_params *params, const struct seen *seen, int i)
{
    double end = seen->near * pow(params->distance_m / seen->near, (i + 1.0) / WD_CASCADES);
    return i + 1 == WD_CASCADES ? params->distance_m : fmin(end, seen->far);
}

/* What stands before the plane, or throws its shadow of length `shadow_m` across it. The plane counts
 * from the view's eye. */
static void add_caster_plane(struct wd_view *cascade, const float plane[4],
                             const struct wd_cascades_params *params, float shadow_m)
{
    float *own = cascade->frustum.planes[cascade->frustum.count++];
    float away = 0.0f;
    memcpy(own, plane, 4 * sizeof *own);
    for (int k = 0; k < 3; k++) {
        away -= plane[k] * params->sun_direction[k];
        own[3] += plane[k] * (float)(cascade->eye_m[k] - params->view->eye_m[k]);
    }
    own[3] += fmaxf(away, 0.0f) * shadow_m + CASTER_MARGIN_M;
}

/* Corner k of the slice [near, far] of the view, in the cascade's clip coordinates. */
static void slice_corner(const struct wd_cascade_box *box, const struct wd_view *view,
                         const double ends[2], uint32_t k, double at[2])
{
    const struct wd_half_view half = wd_half_view_of(view);
    double way_m = ends[k >> 2];
    double right[3], forward[3], up[3];
    wd_camera_axes(&view->camera, right, forward, up);
    const double *axes[2] = {box->right, box->up};
    for (int axis = 0; axis < 2; axis++) {
        double beside = k & 1 ? half.width : -half.width, above = k & 2 ? half.height : -half.height;
        double along = wd_dot(forward, axes[axis]) + beside * wd_dot(right, axes[axis]) +
                       above * wd_dot(up, axes[axis]);
        at[axis] = (wd_dot(view->eye_m, axes[axis]) + way_m * along - box->center[axis]) / box->radius;
    }
}

/* The line from corner i to corner j where all others lie to its left, moved out by `margin`. */
static bool slice_side(float side[3], double corners[8][2], uint32_t i, uint32_t j, double margin)
{
    double x = corners[j][0] - corners[i][0], y = corners[j][1] - corners[i][1], length = hypot(x, y);
    const double normal[2] = {-y / length, x / length};
    if (length < 1e-9)
        return false;
    for (uint32_t k = 0; k < 8; k++) {
        double away[2] = {corners[k][0] - corners[i][0], corners[k][1] - corners[i][1]};
        if (normal[0] * away[0] + normal[1] * away[1] < -1e-9)
            return false;
    }
    side[0] = (float)normal[0];
    side[1] = (float)normal[1];
    side[2] = (float)(margin - normal[0] * corners[i][0] - normal[1] * corners[i][1]);
    return true;
}

/* Sides of the slice as the sun sees it: its corners' convex hull. */
static void find_slice(struct wd_cascade_box *box, const struct wd_view *view, double near, double far)
{
    const double ends[2] = {near, far};
    double corners[8][2];
    uint32_t count = 0;
    for (uint32_t k = 0; k < 8; k++)
        slice_corner(box, view, ends, k, corners[k]);
    for (uint32_t k = 0; k < 64 && count < WD_SLICE_SIDES; k++)
        count += slice_side(box->slice[count], corners, k / 8, k % 8, CASTER_MARGIN_M / box->radius);
}

/* Trees whose shadows miss what the camera sees of the slice [near, far] are left out. A shadow is
 * taken to be no longer than on ground that falls away from the sun half as steeply as the sun
 * stands. */
static void keep_to_slice(struct wd_view *cascade, const struct wd_cascades_params *params,
                          double near, double far)
{
    const struct wd_frustum *seen = &params->view->frustum;
    double right[3], forward[3], up[3];
    wd_camera_axes(&params->view->camera, right, forward, up);
    const float beyond[4] = {(float)forward[0], (float)forward[1], (float)forward[2], (float)-near};
    const float before[4] = {(float)-forward[0], (float)-forward[1], (float)-forward[2], (float)far};
    float shadow_m = (float)(2.0 * params->max_height_m / fmax(params->sun_direction[2], LEAST_RISE));
    add_caster_plane(cascade, beyond, params, shadow_m);
    add_caster_plane(cascade, before, params, shadow_m);
    for (uint32_t i = 0; i < WD_FRUSTUM_SIDES; i++)
        add_caster_plane(cascade, seen->planes[i], params, shadow_m);
}

/* What shaders look the cascade's map up by. */
static void tell_shaders(struct wd_frame_uniforms *uniforms, int i, const struct wd_view *cascade,
                         const struct wd_cascades_params *params, double far, double fade_m)
{
    float(*from_rel)[4] = uniforms->shadow_from_rel[i], *numbers = uniforms->cascades[i];
    memcpy(from_rel, cascade->clip_from_rel, sizeof cascade->clip_from_rel);
    for (int column = 0; column < 4; column++) { /* from -1..1 to 0..1 */
        for (int row = 0; row < 2; row++)
            from_rel[column][row] *= 0.5f;
    }
    from_rel[3][0] += 0.5f;
    from_rel[3][1] += 0.5f;
    numbers[WD_CASCADE_FAR_M] = (float)far;
    numbers[WD_CASCADE_TEXEL_M] = (float)(2.0 * cascade->box.radius / params->size);
    numbers[WD_CASCADE_DEPTH_M] = (float)cascade->box.depth;
    numbers[WD_CASCADE_FADE_M] = (float)fade_m;
}

void wd_cascades_init(struct wd_view cascades[WD_CASCADES], struct wd_frame_uniforms *uniforms,
                      const struct wd_cascades_params *params)
{
    const double *eye_m = params->eye_m ? params->eye_m : params->view->eye_m;
    const struct wd_half_view half = wd_half_view_of(params->view);
    double corner = 1.0 / sqrt(1.0 + half.height * half.height + half.width * half.width);
    const struct seen seen = seen_range(params);
    double near = fmax(params->near_m, corner * seen.nearest);
    for (int i = 0; i < WD_CASCADES; i++) {
        double far = cascade_end(params, &seen, i), fade_m = fmin(FADE * far, FADE_THIN * (far - near));
        struct wd_view *cascade = &cascades[i];
        *cascade = (struct wd_view){.width = params->size, .height = params->size, .cascade = (uint32_t)i};
        cascade_box(&cascade->box, params, i, near, far);
        cascade_view(cascade, params->view, eye_m);
        if (!cascade->box.calm) {
            keep_to_slice(cascade, params, near, far);
            find_slice(&cascade->box, params->view, near, far);
        }
        tell_shaders(uniforms, i, cascade, params, far, fade_m);
        near = fmax(far - fade_m, near);
    }
}
