#include "frame/uniforms.h"

#include <math.h>
#include <string.h>

#include "frame/nearest.h"
#include "world/surroundings.h"

static const float NEAR_M = 0.1f;

/* Where sample i lies in its pixel: the R2 sequence (Roberts 2018), which fills the square evenly
 * for any count; a single sample takes the middle. */
static void sample_offset(uint32_t index, uint32_t count, float offset_px[2])
{
    const double a1 = 0.7548776662466927, a2 = 0.5698402909980532;
    offset_px[0] = offset_px[1] = 0.0f;
    if (count < 2)
        return;
    offset_px[0] = (float)(fmod(0.5 + a1 * index, 1.0) - 0.5);
    offset_px[1] = (float)(fmod(0.5 + a2 * index, 1.0) - 0.5);
}

static void fill_camera(struct wd_frame_uniforms *uniforms, struct wd_view *view,
                        const struct wd_uniforms_params *params)
{
    struct wd_view_params camera = {params->camera, params->width, params->height, NEAR_M, {0}};
    struct wd_view steady;
    wd_view_init(&steady, &camera);
    memcpy(uniforms->steady_clip_from_rel, steady.clip_from_rel, sizeof steady.clip_from_rel);
    /* backwards, so that the G-buffer is left with the sample through the pixels' middles */
    sample_offset(params->sample_count - 1 - params->sample_index, params->sample_count,
                  camera.offset_px);
    wd_view_init(view, &camera);
    memcpy(uniforms->clip_from_rel, view->clip_from_rel, sizeof view->clip_from_rel);
    wd_matrix_invert(uniforms->rel_from_clip, view->clip_from_rel);
    wd_surroundings_set_camera(uniforms, view->eye_m);
    uniforms->near_m = NEAR_M;
    uniforms->width = params->width;
    uniforms->height = params->height;
}

/* The previous camera's matrix for places relative to the present one. */
static void fill_previous(struct wd_frame_uniforms *uniforms,
                          const struct wd_uniforms_params *params)
{
    struct wd_view previous;
    const struct wd_view_params camera = {
        params->previous_camera, params->width, params->height, NEAR_M, {0}};
    wd_view_init(&previous, &camera);
    float shift[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    for (int k = 0; k < 3; k++)
        shift[3][k] = (float)(params->camera.position_m[k] - params->previous_camera.position_m[k]);
    wd_matrix_multiply(uniforms->previous_clip_from_rel, previous.clip_from_rel, shift);
    uniforms->time_s = (float)params->time_s;
    uniforms->previous_time_s = (float)params->previous_time_s;
}

void wd_uniforms_init(struct wd_frame_uniforms *uniforms, struct wd_view *view,
                      struct wd_view cascades[WD_CASCADES], const struct wd_uniforms_params *params)
{
    const struct wd_forest_device *forest = params->forest;
    const struct wd_scene *scene = forest->scene;
    *uniforms = (struct wd_frame_uniforms){
        .sample_index = params->sample_index,
        .sample_count = params->sample_count,
        .view_mode = params->view_mode,
        .shadow_taps = (uint32_t)scene->quality.shadow_taps,
    };
    fill_camera(uniforms, view, params);
    fill_previous(uniforms, params);
    wd_surroundings_fill(uniforms, scene, &forest->world->terrain);
    struct wd_cascades_params sun = {
        .view = view,
        .distance_m = (float)scene->quality.shadow_distance_m,
        .near_m = NEAR_M,
        .nearest_m = wd_nearest_seen(forest, view),
        .size = params->shadow_size,
        .max_z_m = forest->world->terrain.max_m + forest->max_tree_height_m,
        .max_height_m = forest->max_tree_height_m,
    };
    memcpy(sun.sun_direction, uniforms->sun_direction, sizeof sun.sun_direction);
    wd_cascades_init(cascades, uniforms, &sun);
}
