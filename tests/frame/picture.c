#include "picture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "forest/canopy_light.h"
#include "forest/sky.h"
#include "frame/uniforms.h"
#include "world/placement.h"
#include "world/sun.h"

static void set_weather(struct wd_scene *scene)
{
    scene->sun.azimuth_deg = 215;
    scene->sun.elevation_deg = 45;
    scene->sun.angular_diameter_deg = 0.53;
    scene->sun.strength = 1;
    scene->sky.turbidity = 2.5;
    scene->sky.strength = 1;
    scene->fog.visibility_m = 30000;
    scene->fog.height_m = 1200;
    scene->wind.speed_mps = 3;
    scene->wind.direction_deg = 250;
    scene->wind.gust = 0.4;
    scene->water.clarity_m = 2.5;
    memcpy(scene->water.color, (float[3]){0.006f, 0.022f, 0.024f}, sizeof scene->water.color);
    memcpy(scene->ground.grass, (float[3]){0.075f, 0.105f, 0.035f}, sizeof scene->ground.grass);
    memcpy(scene->ground.soil, (float[3]){0.130f, 0.095f, 0.065f}, sizeof scene->ground.soil);
    memcpy(scene->ground.rock, (float[3]){0.200f, 0.190f, 0.175f}, sizeof scene->ground.rock);
    memcpy(scene->ground.litter, (float[3]){0.100f, 0.070f, 0.045f}, sizeof scene->ground.litter);
    scene->ground.rock_slope_deg = 38;
    scene->quality.shadow_taps = 5;
    scene->quality.shadow_size = 64;
    scene->quality.shadow_distance_m = 400;
    scene->quality.terrain_error_px = 1;
}

/* Groves by a sum of waves, none where it is steep. */
static void make_cover(struct wd_world *world)
{
    const struct wd_terrain *terrain = &world->terrain;
    world->cover_cell_m = 8;
    world->cover_width = (uint32_t)(wd_terrain_extent_x_m(terrain) / 8) + 1;
    world->cover_height = (uint32_t)(wd_terrain_extent_y_m(terrain) / 8) + 1;
    const struct wd_scene scene = {0};
    const struct wd_placement_params params = {.scene = &scene, .terrain = terrain};
    struct wd_ground_input ground;
    if (!wd_ground_input_init(&ground, &params))
        abort();
    world->cover = wd_alloc_array((size_t)world->cover_width * world->cover_height, 1);
    for (uint32_t j = 0; j < world->cover_height; j++) {
        for (uint32_t i = 0; i < world->cover_width; i++) {
            double x = i * 8.0, y = j * 8.0;
            double wave = sin(x / 130) + sin(y / 110 + x / 300) + 0.7 * sin(x / 41 - y / 53);
            struct wd_ground_place place = wd_ground_locate(&ground, (int32_t)(1000 * x), (int32_t)(1000 * y));
            bool steep = wd_ground_slope_squared(&ground, place) > 0.5f;
            double share = steep ? 0 : fmin(fmax(wave, 0), 1);
            world->cover[(size_t)j * world->cover_width + i] = (uint8_t)(255 * share);
        }
    }
}

/* No crowns: what hills alone leave of the sky. */
static bool make_canopy_light(struct picture_test *test)
{
    const struct wd_model none = {0};
    const struct wd_canopy_field_params params = {
        .world = &test->world, .models = &none, .variants = 1, .threads = 1};
    struct wd_canopy_field field;
    wd_canopy_field_init(&field, &params);
    bool ok = wd_canopy_light_upload(&test->forest.canopy_light, test->forest.canopy_light_scale, &test->gpu, &field);
    wd_canopy_field_finish(&field);
    return ok;
}

static bool make_forest(struct picture_test *test)
{
    const struct wd_buffer_params trees = {.name = "no trees",
                                           .size = sizeof(struct wd_packed_tree),
                                           .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                           .texels = VK_FORMAT_R32G32B32A32_UINT};
    const struct wd_packed_tree none = {0};
    test->forest.scene = &test->scene;
    test->forest.world = &test->world;
    test->forest.variants = 1;
    return wd_ground_init(&test->forest.ground, &test->gpu, &test->world, &test->log) &&
           wd_buffer_init(&test->forest.trees, &test->gpu, &trees) &&
           wd_buffer_upload(&test->gpu, &test->forest.trees, 0, &none, sizeof none) &&
           make_canopy_light(test) &&
           wd_sky_upload(&test->forest.sky, &test->gpu, &test->world.sky) &&
           wd_sampler_init(&test->forest.look_sampler, &test->gpu, WD_SAMPLER_TRILINEAR_REPEAT);
}

bool picture_init(struct picture_test *test, uint32_t width, uint32_t height, uint32_t cells,
                  double cell_m, double relief_m)
{
    const struct wd_gpu_params gpu = {.name = "software", .validation = WD_GPU_VALIDATION_ON};
    *test = (struct picture_test){0};
    set_weather(&test->scene);
    test->scene.terrain.kind = WD_TERRAIN_DIAMOND_SQUARE;
    test->scene.terrain.size_m[0] = test->scene.terrain.size_m[1] = cells * cell_m;
    test->scene.terrain.cell_m = cell_m;
    test->scene.terrain.relief_m = relief_m;
    test->scene.terrain.roughness = 0.9;
    test->scene.terrain.valley = 0.6;
    test->scene.terrain.vertical_scale = 1;
    if (!wd_terrain_init(&test->world.terrain, &test->scene, 7, 0, 0, NULL, &test->log))
        return false;
    make_cover(&test->world);
    return wd_gpu_init(&test->gpu, &gpu, &test->log) && wd_frames_init(&test->frames, &test->gpu) &&
           make_forest(test) && wd_targets_init(&test->targets, &test->gpu, width, height, 64) &&
           wd_terrain_pass_init(&test->terrain, &test->gpu) &&
           wd_light_pass_init(&test->light, &test->gpu) &&
           wd_post_pass_init(&test->post, &test->gpu);
}

void picture_finish(struct picture_test *test)
{
    wd_frames_finish(&test->frames);
    wd_ground_finish(&test->forest.ground, &test->gpu);
    wd_buffer_finish(&test->forest.trees, &test->gpu);
    wd_image_finish(&test->forest.canopy_light, &test->gpu);
    wd_image_finish(&test->forest.sky, &test->gpu);
    if (test->forest.look_sampler)
        vkDestroySampler(test->gpu.device, test->forest.look_sampler, NULL);
    wd_targets_finish(&test->targets, &test->gpu);
    wd_terrain_pass_finish(&test->terrain, &test->gpu);
    wd_light_pass_finish(&test->light, &test->gpu);
    wd_post_pass_finish(&test->post, &test->gpu);
    wd_gpu_finish(&test->gpu);
    free(test->world.cover);
    wd_terrain_finish(&test->world.terrain);
}

static void clear_shadows(struct picture_test *test, struct wd_cmd *cmd)
{
    for (uint32_t layer = 0; layer < WD_CASCADES; layer++) {
        const struct wd_rendering rendering = {.width = 64,
                                               .height = 64,
                                               .depth = &test->targets.shadow,
                                               .depth_view = test->targets.shadow_layers[layer],
                                               .depth_load = WD_LOAD_CLEAR};
        wd_cmd_begin_rendering(cmd, &rendering);
        wd_cmd_end_rendering(cmd);
    }
}

static void record(struct picture_test *test, struct wd_cmd *cmd, struct wd_binding uniforms)
{
    const struct wd_terrain_params terrain = {&test->forest.ground, &test->view, uniforms, 1};
    wd_cmd_scope_begin(cmd, "terrain");
    const struct wd_rendering targets = wd_targets_gbuffer(&test->targets, WD_LOAD_CLEAR);
    wd_cmd_begin_rendering(cmd, &targets);
    wd_terrain_pass_record(&test->terrain, cmd, &terrain);
    wd_cmd_end_rendering(cmd);
    wd_cmd_scope_end(cmd);
    const struct wd_light_params light = {&test->targets, &test->forest, &test->view,
                                          &test->uniforms, uniforms};
    wd_cmd_scope_begin(cmd, "light");
    wd_light_pass_record(&test->light, cmd, &light);
    if (test->velocity_px.buffer)
        wd_light_pass_record_velocity(&test->light, cmd, &light, &test->velocity_px);
    wd_cmd_scope_end(cmd);
    const struct wd_post_params post = {
        .targets = &test->targets, .uniforms = uniforms, .view_mode = test->view_mode};
    wd_cmd_scope_begin(cmd, "post");
    wd_post_pass_record(&test->post, cmd, &post);
    wd_cmd_scope_end(cmd);
}

static bool draw_sample(struct picture_test *test, const struct wd_camera *camera, uint32_t index)
{
    struct wd_cmd cmd;
    struct wd_view cascades[WD_CASCADES];
    const struct wd_uniforms_params params = {
        .forest = &test->forest,
        .camera = *camera,
        .previous_camera = test->previous_camera ? *test->previous_camera : *camera,
        .sun = wd_sun_of(&test->scene),
        .width = test->targets.width,
        .height = test->targets.height,
        .shadow_size = 64,
        .sample_index = index,
        .sample_count = test->samples ? test->samples : 1,
        .view_mode = test->view_mode,
    };
    if (!wd_frame_begin(&test->frames, &cmd))
        return false;
    clear_shadows(test, &cmd);
    wd_uniforms_init(&test->uniforms, &test->view, cascades, &params);
    struct wd_binding binding;
    struct wd_frame_uniforms *mapped = wd_cmd_upload(&cmd, sizeof *mapped, &binding);
    if (mapped)
        *mapped = test->uniforms;
    wd_ground_use(&test->forest.ground, &cmd);
    wd_cmd_use_image(&cmd, &test->forest.canopy_light, WD_USE_SHADER_READ);
    wd_cmd_use_image(&cmd, &test->forest.sky, WD_USE_SHADER_READ);
    wd_cmd_use_buffer(&cmd, &test->forest.trees, WD_USE_SHADER_READ);
    record(test, &cmd, binding);
    return wd_frame_submit(&cmd, VK_NULL_HANDLE, VK_NULL_HANDLE) && wd_frames_wait(&test->frames);
}

bool picture_draw(struct picture_test *test, const struct wd_camera *camera)
{
    const struct wd_light_needs needs = {&test->forest, test->view_mode, WD_LEAVES_ANY};
    bool ok = wd_terrain_pass_prepare(&test->terrain, &test->gpu, &test->forest.ground) &&
              wd_light_pass_prepare(&test->light, &test->gpu, &needs);
    for (uint32_t i = 0; ok && i < (test->samples ? test->samples : 1); i++)
        ok = draw_sample(test, camera, i);
    return ok;
}

struct wd_camera picture_camera(const struct picture_test *test, double x_m, double y_m,
                                double above_m, double yaw_deg, double pitch_deg)
{
    const double degree = 3.14159265358979 / 180;
    double ground_m = wd_terrain_height(&test->world.terrain, x_m, y_m);
    return (struct wd_camera){.position_m = {x_m, y_m, ground_m + above_m},
                              .yaw_rad = yaw_deg * degree,
                              .pitch_rad = pitch_deg * degree,
                              .fov_rad = 55 * degree};
}

static void *read_image(struct picture_test *test, struct wd_image *image)
{
    size_t size = (size_t)image->width * image->height * wd_format_texel_bytes(image->format);
    void *data = wd_alloc(size);
    if (!wd_image_read(&test->gpu, image, 0, 0, data, size))
        abort();
    return data;
}

uint8_t *picture_display(struct picture_test *test)
{
    return read_image(test, &test->targets.display);
}

float *picture_depth(struct picture_test *test)
{
    return read_image(test, &test->targets.depth);
}

float *picture_velocity(struct picture_test *test, const struct wd_camera *camera,
                        const struct wd_camera *previous)
{
    size_t size = (size_t)test->targets.width * test->targets.height * 2 * sizeof(float);
    const struct wd_buffer_params params = {
        .name = "velocity", .size = size, .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT};
    float *velocity_px = wd_alloc(size);
    test->previous_camera = previous;
    if (!wd_buffer_init(&test->velocity_px, &test->gpu, &params) || !picture_draw(test, camera) ||
        !wd_buffer_read(&test->gpu, &test->velocity_px, 0, velocity_px, size))
        abort();
    wd_buffer_finish(&test->velocity_px, &test->gpu);
    test->previous_camera = NULL;
    return velocity_px;
}
