#include "frame/uniforms.h"

#include <math.h>
#include <string.h>

#include "frame/nearest.h"
#include "shared/wind.h"
#include "world/surroundings.h"

/* What sample i of a picture stands for: a place in the pixel, on the lens and in the time that the
 * shutter is open, each -0.5..0.5. */
struct exposure {
    double pixel[2], lens[2], time;
};

/* R sequences (Roberts 2018), which fill the square and the cube evenly for any count: number `step`
 * from the middle of all, -0.5..0.5. */
static double spread(int dimension, uint32_t step)
{
    static const double steps[5] = {0.7548776662466927, 0.5698402909980532, 0.8191725133961645,
                                    0.6710436067037893, 0.5497004779019703};
    return fmod(0.5 + steps[dimension] * step, 1.0) - 0.5;
}

/* From so many samples on, those beside the middle lie about it in the mean (of 16 they would be 0.09
 * pixels aside). Of fewer some would fall on one place. */
enum { CENTERED_SAMPLES = 8 };

static double aside(int dimension, uint32_t count)
{
    double sum = 0.0;
    for (uint32_t step = 1; count >= CENTERED_SAMPLES && step < count; step++)
        sum += spread(dimension, step) / (count - 1);
    return sum;
}

/* The middle comes last, so that the G-buffer is left with it; a single sample takes the middle. */
static struct exposure exposure_of(uint32_t index, uint32_t count)
{
    uint32_t step = count - 1 - index;
    struct exposure exposure = {.lens = {spread(2, step), spread(3, step)}, .time = spread(4, step)};
    for (int k = 0; k < 2; k++)
        exposure.pixel[k] = step ? spread(k, step) - aside(k, count) : 0.0;
    return exposure;
}

/* The unit disc from the square (Shirley and Chiu 1997). */
static void disc_of(const double square[2], double disc[2])
{
    double x = 2 * square[0], y = 2 * square[1];
    bool wide = fabs(x) > fabs(y);
    double radius = wide ? x : y;
    double turn = radius == 0.0 ? 0.0 : 0.785398163397448 * (wide ? y / x : 2.0 - x / y);
    disc[0] = radius * cos(turn);
    disc[1] = radius * sin(turn);
}

/* The camera on its way while the shutter is open. */
static struct wd_camera moving_camera(const struct wd_uniforms_params *params, double time)
{
    double share = params->forest->scene->lens.shutter * time;
    const struct wd_camera *was = &params->previous_camera;
    struct wd_camera camera = params->camera;
    for (int k = 0; k < 3; k++)
        camera.position_m[k] += share * (camera.position_m[k] - was->position_m[k]);
    camera.yaw_rad += share * remainder(camera.yaw_rad - was->yaw_rad, 6.283185307179586);
    camera.pitch_rad += share * (camera.pitch_rad - was->pitch_rad);
    return camera;
}

/* A place on the lens is an eye beside the middle, whose picture is shifted so that the plane in
 * focus stays. */
static void move_on_lens(struct wd_view_params *view, const struct wd_scene *scene,
                         const double lens[2])
{
    double half_height = tan(view->camera.fov_rad * 0.5), disc[2];
    double right[3], forward[3], up[3];
    disc_of(lens, disc);
    double radius_m = wd_scene_lens_radius_m(scene, view->camera.fov_rad);
    double px_per_m = 0.5 * view->height / (half_height * scene->lens.focus_m);
    wd_camera_axes(&view->camera, right, forward, up);
    for (int k = 0; k < 3; k++)
        view->camera.position_m[k] += radius_m * (disc[0] * right[k] + disc[1] * up[k]);
    view->offset_px[0] += (float)(radius_m * disc[0] * px_per_m);
    view->offset_px[1] -= (float)(radius_m * disc[1] * px_per_m);
}

/* `steady`: the view of the whole picture, which its samples lie about. */
static void fill_camera(struct wd_frame_uniforms *uniforms, struct wd_view *view,
                        struct wd_view *steady, const struct wd_uniforms_params *params)
{
    const struct wd_scene *scene = params->forest->scene;
    struct wd_view_params camera = {
        params->camera, params->width, params->height, WD_NEAR_M, params->samples, {0}};
    struct exposure exposure = exposure_of(params->sample_index, params->sample_count);
    wd_view_init(steady, &camera);
    memcpy(uniforms->steady_clip_from_rel, steady->clip_from_rel, sizeof steady->clip_from_rel);
    camera.camera = moving_camera(params, exposure.time);
    for (int k = 0; k < 2; k++)
        camera.offset_px[k] = (float)exposure.pixel[k];
    if (scene->lens.f_number > 0.0)
        move_on_lens(&camera, scene, exposure.lens);
    wd_view_init(view, &camera);
    memcpy(uniforms->clip_from_rel, view->clip_from_rel, sizeof view->clip_from_rel);
    wd_matrix_invert(uniforms->rel_from_clip, view->clip_from_rel);
    wd_surroundings_set_camera(uniforms, view->eye_m);
    uniforms->near_m = WD_NEAR_M;
    uniforms->width = params->width;
    uniforms->height = params->height;
    double span_s = params->time_s - params->previous_time_s;
    double begin_s = wd_wind_begin_s(params->time_s);
    uniforms->wind_period = wd_wind_period_of(params->time_s);
    uniforms->time_s = (float)(params->time_s - begin_s + span_s * scene->lens.shutter * exposure.time);
    uniforms->previous_time_s = (float)(params->previous_time_s - begin_s);
}

/* The previous camera's matrix for places relative to the present one. */
static void fill_previous(struct wd_frame_uniforms *uniforms,
                          const struct wd_uniforms_params *params)
{
    struct wd_view previous;
    const struct wd_view_params camera = {
        params->previous_camera, params->width, params->height, WD_NEAR_M, params->samples, {0}};
    wd_view_init(&previous, &camera);
    float shift[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    for (int k = 0; k < 3; k++)
        shift[3][k] = (float)(params->camera.position_m[k] - params->previous_camera.position_m[k]);
    wd_matrix_multiply(uniforms->previous_clip_from_rel, previous.clip_from_rel, shift);
}

/* Gaps of crowns throw images of the sun that are far wider than they are. Pictures with one set of maps for all
 * samples look for gaps at so many times as many places. */
enum { MORE_TAPS = 3 };

static uint32_t shadow_taps_of(const struct wd_scene *scene, const struct wd_uniforms_params *params)
{
    uint32_t taps = (uint32_t)scene->quality.shadow_taps;
    return params->samples >= WD_FINE_SAMPLES ? MORE_TAPS * taps : taps;
}

void wd_uniforms_init(struct wd_frame_uniforms *uniforms, struct wd_view *view,
                      struct wd_view cascades[WD_CASCADES], const struct wd_uniforms_params *params)
{
    const struct wd_forest_device *forest = params->forest;
    const struct wd_scene *scene = forest->scene;
    *uniforms = (struct wd_frame_uniforms){
        .sample_index = params->sample_index,
        .sample_count = params->sample_count,
        .adds = params->adds,
        .view_mode = params->view_mode,
        .shadow_taps = shadow_taps_of(scene, params),
    };
    struct wd_view steady;
    fill_camera(uniforms, view, &steady, params);
    fill_previous(uniforms, params);
    wd_surroundings_fill(uniforms, scene, forest->world, &params->sun);
    memcpy(uniforms->leaf_scatter, forest->leaf_scatter, sizeof uniforms->leaf_scatter);
    struct wd_cascades_params sun = {
        .view = &steady, /* all samples look into the first one's maps */
        .eye_m = view->eye_m,
        .distance_m = (float)scene->quality.shadow_distance_m,
        .near_m = WD_NEAR_M,
        .nearest_m = wd_nearest_seen(forest, &steady),
        .farthest_m = wd_farthest_seen(&forest->world->terrain, &steady),
        .size = params->shadow_size,
        .max_z_m = forest->world->terrain.max_m + forest->max_tree_height_m,
        .min_z_m = forest->world->terrain.min_m,
        .max_height_m = forest->max_tree_height_m,
        .calm_m = params->calm_m,
    };
    memcpy(sun.sun_direction, uniforms->sun_direction, sizeof sun.sun_direction);
    wd_cascades_init(cascades, uniforms, &sun);
    if (params->maps == WD_SHADOW_PERSPECTIVE)
        wd_perspective_map_init(&cascades[0], uniforms, &sun);
}
