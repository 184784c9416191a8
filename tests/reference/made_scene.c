#include "made_scene.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "tree/vec.h"

struct wd_vec3 made_sky_white(const struct wd_frame_uniforms *frame, struct wd_vec3 direction)
{
    (void)frame, (void)direction;
    return WD_V3(1, 1, 1);
}

struct wd_vec3 made_sky_black(const struct wd_frame_uniforms *frame, struct wd_vec3 direction)
{
    (void)frame, (void)direction;
    return WD_V3(0, 0, 0);
}

void made_scene_init(struct made_scene *made)
{
    *made = (struct made_scene){0};
    made->models.device = rtcNewDevice("threads=1");
    made->models.models = &made->model;
    made->models.count = made->models.variants = 1;
    made->model.model = (struct wd_model){.height_m = 1,
                                          .crown_m = 1,
                                          .roughness = 0.6f,
                                          .behind = {1, 1, 1},
                                          .ahead = {1, 1, 1}};
    made->model.look = &made->look;
    made->look.albedo = wd_alloc(WD_LOOK_LAYERS * WD_TRACE_MAP_BYTES);
    made->look.detail = wd_alloc(WD_LOOK_LAYERS * WD_TRACE_MAP_BYTES);
    memset(made->holes, 1, sizeof made->holes);
    made->world.terrain = (struct wd_terrain){
        .width = 2, .height = 2, .cell_m = 1000, .height_m = made->heights, .hole = made->holes};
    made->world.trees = made->trees;
    made->world.layer_of_tree = made->layers;
    memset(made->layers, 255, sizeof made->layers);
    made->frame.fog_height_m = 1000;
    made->frame.water_level_m = -1e9f;
    made->frame.sun_direction[2] = 1;
    made->frame.sun_cos_radius = 0.99999f;
    made->tracer = (struct wd_tracer){.scene = &made->traced, .sky = made_sky_black, .bounces = 8};
}

void made_scene_finish(struct made_scene *made)
{
    wd_trace_scene_finish(&made->traced);
    if (made->model.scene)
        rtcReleaseScene(made->model.scene);
    wd_tree_mesh_finish(&made->model.grown.full);
    free(made->look.albedo);
    free(made->look.detail);
    rtcReleaseDevice(made->models.device);
}

void made_scene_add_quad(struct made_scene *made, struct wd_vec3 corner, struct wd_vec3 a,
                         struct wd_vec3 b, uint32_t kind)
{
    struct wd_tree_mesh *mesh = &made->model.grown.full;
    struct wd_vec3 normal = wd_v3_unit(wd_v3_cross(a, b));
    const float packed[3] = {normal.x, normal.y, normal.z};
    uint32_t first = mesh->vertex_count;
    for (int k = 0; k < 4; k++) {
        float u = k == 1 || k == 2, v = k >= 2;
        struct wd_vec3 p = wd_v3_mad(wd_v3_mad(corner, a, u), b, v);
        const struct wd_tree_vertex vertex = {{p.x, p.y, p.z}, wd_pack_normal(packed),
                                              wd_pack_uv(u, v), 0xffffffffu, kind};
        wd_tree_mesh_add_vertex(mesh, &vertex);
    }
    wd_tree_mesh_add_triangle(mesh, first, first + 1, first + 2);
    wd_tree_mesh_add_triangle(mesh, first, first + 2, first + 3);
}

void made_scene_add_tree(struct made_scene *made, float x_m, float y_m, float z_m)
{
    size_t i = made->world.tree_count++;
    made->trees[i] = (struct wd_tree){
        .x_mm = (int32_t)(x_m * 1000),
        .y_mm = (int32_t)(y_m * 1000),
        .z_mm = (int32_t)(z_m * 1000),
        .id = (uint32_t)i + 1,
        .size = 100u | 100u << 16,
        .look = WD_TREE_LOOK(0u, 128u, 0u),
    };
}

void made_scene_set_look(struct made_scene *made, uint8_t value, uint8_t detail)
{
    memset(made->look.albedo, value, WD_LOOK_LAYERS * WD_TRACE_MAP_BYTES);
    memset(made->look.detail, detail, WD_LOOK_LAYERS * WD_TRACE_MAP_BYTES);
    for (size_t i = 3; i < WD_LOOK_LAYERS * WD_TRACE_MAP_BYTES; i += 4)
        made->look.albedo[i] = 255;
}

void made_scene_build(struct made_scene *made)
{
    const struct wd_trace_view view = wd_trace_view_of(&(struct wd_camera){.fov_rad = 0.9}, 48, 32);
    wd_trace_model_build(&made->model, made->models.device);
    assert_true(wd_trace_scene_init(&made->traced, &made->models, &made->scene, &made->world,
                                    &made->frame, &view, NULL));
}

struct wd_vec3 made_scene_look(const struct made_scene *made, struct wd_vec3 direction,
                               uint32_t samples)
{
    struct wd_trace_counts counts = {0};
    struct wd_vec3 sum = {0};
    for (uint32_t i = 0; i < samples; i++) {
        struct wd_vec3 radiance = wd_path_radiance(&made->tracer, WD_V3(0, 0, 0), wd_v3_unit(direction),
                                                   wd_sampler_of(3, 7, 0, i), &counts);
        sum = wd_v3_mad(sum, radiance, 1 / (float)samples);
    }
    assert_int_equal(counts.self_hits, 0);
    return sum;
}
