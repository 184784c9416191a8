#include "methods/tree_draw.h"

#include <string.h>

#include "frame/targets.h"
#include "methods/spray_draw.h"

static const uint32_t tree_mesh_vert[] =
#include "tree_mesh.vert.inc"
    ;
static const uint32_t tree_mesh_frag[] =
#include "tree_mesh.frag.inc"
    ;
static const uint32_t tree_mesh_shadow_frag[] =
#include "tree_mesh_shadow.frag.inc"
    ;
static const uint32_t tree_card_vert[] =
#include "tree_card.vert.inc"
    ;
static const uint32_t tree_card_frag[] =
#include "tree_card.frag.inc"
    ;
static const uint32_t tree_card_shadow_frag[] =
#include "tree_card_shadow.frag.inc"
    ;

#define SPIRV(words)                                                                               \
    {                                                                                              \
        words, sizeof words, #words                                                                \
    }

/* --- pipelines --------------------------------------------------------------------------- */

static void set_targets(struct wd_graphics_params *params, enum wd_tree_pass pass)
{
    params->depth_format = WD_DEPTH_FORMAT;
    params->topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    params->push_size = sizeof(struct wd_tree_push);
    if (pass == WD_PASS_CAMERA) {
        params->color_count = 3;
        params->color_formats[0] = WD_ALBEDO_FORMAT;
        params->color_formats[1] = WD_NORMAL_FORMAT;
        params->color_formats[2] = WD_SURFACE_FORMAT;
    } else {
        params->depth_bias_slope = -1.0f; /* reversed depth: away from the sun is down */
    }
}

static bool init_mesh(struct wd_pipeline *pipeline, struct wd_gpu *gpu, enum wd_tree_pass pass,
                      uint32_t detail)
{
    const uint32_t constants[] = {pass == WD_PASS_SHADOW, detail};
    struct wd_graphics_params params = {
        .vertex = SPIRV(tree_mesh_vert),
        .bindings = {8,
                     {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                      VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                      VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                      VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                      VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                      VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}},
        .constants = {2, constants},
    };
    const struct wd_spirv fragments[] = {SPIRV(tree_mesh_frag), SPIRV(tree_mesh_shadow_frag)};
    params.fragment = fragments[pass];
    set_targets(&params, pass);
    return wd_pipeline_init_graphics(pipeline, gpu, &params);
}

static bool init_card(struct wd_pipeline *pipeline, struct wd_gpu *gpu, enum wd_tree_pass pass,
                      uint32_t listed)
{
    const uint32_t constants[] = {pass == WD_PASS_SHADOW, listed};
    struct wd_graphics_params params = {
        .vertex = SPIRV(tree_card_vert),
        .bindings = {7,
                     {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                      VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                      VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                      VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                      VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}},
        .constants = {2, constants},
    };
    const struct wd_spirv fragments[] = {SPIRV(tree_card_frag), SPIRV(tree_card_shadow_frag)};
    params.fragment = fragments[pass];
    set_targets(&params, pass);
    return wd_pipeline_init_graphics(pipeline, gpu, &params);
}

bool wd_tree_pipelines_init(struct wd_tree_pipelines *pipelines, struct wd_gpu *gpu)
{
    *pipelines = (struct wd_tree_pipelines){0};
    if (!init_mesh(&pipelines->mesh_detail, gpu, WD_PASS_CAMERA, 1) ||
        !wd_spray_pipeline_init(&pipelines->spray, gpu)) {
        wd_tree_pipelines_finish(pipelines, gpu);
        return false;
    }
    for (int pass = WD_PASS_CAMERA; pass <= WD_PASS_SHADOW; pass++) {
        if (!init_mesh(&pipelines->mesh[pass], gpu, pass, 0) ||
            !init_card(&pipelines->card_range[pass], gpu, pass, 0) ||
            !init_card(&pipelines->card_listed[pass], gpu, pass, 1)) {
            wd_tree_pipelines_finish(pipelines, gpu);
            return false;
        }
    }
    return true;
}

void wd_tree_pipelines_finish(struct wd_tree_pipelines *pipelines, struct wd_gpu *gpu)
{
    wd_pipeline_finish(&pipelines->mesh_detail, gpu);
    wd_pipeline_finish(&pipelines->spray, gpu);
    for (int pass = WD_PASS_CAMERA; pass <= WD_PASS_SHADOW; pass++) {
        wd_pipeline_finish(&pipelines->mesh[pass], gpu);
        wd_pipeline_finish(&pipelines->card_range[pass], gpu);
        wd_pipeline_finish(&pipelines->card_listed[pass], gpu);
    }
}

/* --- drawing ----------------------------------------------------------------------------- */

static struct wd_tree_push tree_push(const struct wd_tree_draw *draw, uint32_t level)
{
    return (struct wd_tree_push){.variants = draw->forest->variants,
                                 .cascade = draw->view->cascade,
                                 .level = level,
                                 .show = 1.0f,
                                 .pixels_per_radian = draw->view->pixels_per_radian};
}

/* Instances in the frame's upload memory; false marks the frame failed already. */
static bool upload_instances(const struct wd_tree_draw *draw, const struct wd_instance *instances,
                             size_t count, struct wd_binding *binding)
{
    void *memory = wd_cmd_upload(draw->cmd, count * sizeof *instances, binding);
    if (memory)
        memcpy(memory, instances, count * sizeof *instances);
    return memory != NULL;
}

static void draw_indexed(const struct wd_tree_draw *draw, uint32_t indices, uint32_t instances,
                         uint32_t first_index, int32_t vertex_offset, uint32_t first_instance)
{
    wd_cmd_draw_indexed(draw->cmd, &(VkDrawIndexedIndirectCommand){indices, instances, first_index,
                                                                   vertex_offset, first_instance});
    draw->stats->draw_calls++;
    draw->stats->triangles += (uint64_t)indices / 3 * instances;
}

/* The leaves of a model, or something in their place. */
static struct wd_binding bind_leaves(const struct wd_forest_device *forest, uint32_t model)
{
    const struct wd_spray_range *range = &forest->sprays.ranges[model];
    uint32_t count = range->leaf_count ? range->leaf_count : 1;
    return (struct wd_binding){
        .buffer = &forest->sprays.leaves,
        .offset = (VkDeviceSize)range->first_leaf * sizeof(struct wd_tree_leaf),
        .size = (VkDeviceSize)count * sizeof(struct wd_tree_leaf),
    };
}

static void bind_mesh(const struct wd_tree_draw *draw, const struct wd_mesh_batch *batch,
                      struct wd_binding instances, float spray_scale)
{
    const struct wd_forest_device *forest = draw->forest;
    const struct wd_mesh_range *range = &forest->ranges[batch->model][batch->level];
    const struct wd_pipeline *pipeline =
        draw->pass == WD_PASS_CAMERA && batch->level == WD_LEVEL_MESH
            ? &draw->pipelines->mesh_detail
            : &draw->pipelines->mesh[draw->pass];
    const struct wd_binding vertices = {
        .buffer = &forest->vertices,
        .offset = (VkDeviceSize)range->first_vertex * sizeof(struct wd_tree_vertex),
        .size = (VkDeviceSize)range->vertex_count * sizeof(struct wd_tree_vertex),
    };
    const struct wd_binding bindings[] = {draw->uniforms,
                                          WD_BIND_BUFFER(&forest->trees),
                                          WD_BIND_BUFFER(&forest->models),
                                          vertices,
                                          instances,
                                          WD_BIND_IMAGE(&forest->looks, forest->look_sampler),
                                          WD_BIND_IMAGE(&forest->look_details,
                                                        forest->look_sampler),
                                          bind_leaves(forest, batch->model)};
    struct wd_tree_push push = tree_push(draw, batch->level);
    if (batch->level == WD_LEVEL_MESH)
        push.spray_reach = spray_scale * forest->sprays.ranges[batch->model].reach;
    push.pixels_per_radian = wd_leaf_pixels(draw->view, draw->pass);
    push.leaf_m = range->leaf_m;
    push.leaf_count = range->leaf_count;
    wd_cmd_bind(draw->cmd, pipeline, bindings);
    wd_cmd_push(draw->cmd, pipeline, &push, sizeof push);
    wd_cmd_bind_indices(draw->cmd, &forest->indices);
}

enum { WOOD = -1 };

/* Instances of a mesh with its wood alone, or with the leaves of a step and flowers. */
static void draw_mesh(const struct wd_tree_draw *draw, const struct wd_mesh_range *range, int step,
                      const struct wd_range *instances)
{
    uint32_t count = instances->end - instances->begin, flowers = range->leaf_ends[0];
    uint32_t end = step == WOOD ? range->wood_index_count : range->leaf_ends[step];
    if (step == 0)
        end = flowers = range->index_count; /* all at once */
    draw_indexed(draw, end, count, range->first_index, 0, instances->begin);
    if (step != WOOD && range->index_count > flowers)
        draw_indexed(draw, range->index_count - flowers, count, range->first_index + flowers, 0,
                     instances->begin);
}

static void draw_meshes(const struct wd_tree_draw *draw, const struct wd_selection *selection,
                        enum wd_draw_grouping grouping, float spray_scale)
{
    const struct wd_forest_device *forest = draw->forest;
    struct wd_binding instances;
    if (!selection->mesh_count ||
        !upload_instances(draw, selection->meshes, selection->mesh_count, &instances))
        return;
    for (size_t i = 0; i < selection->batch_count; i++) {
        const struct wd_mesh_batch *batch = &selection->batches[i];
        const struct wd_mesh_range *range = &forest->ranges[batch->model][batch->level];
        bind_mesh(draw, batch, instances, spray_scale);
        draw->stats->trees[batch->level] += batch->count;
        uint32_t draws = grouping == WD_DRAW_SINGLE ? batch->count : 1;
        for (uint32_t k = 0; k < draws; k++) {
            const struct wd_range part = {batch->first + k, batch->first + k + batch->count / draws,
                                          0};
            draw_mesh(draw, range, grouping == WD_DRAW_WOOD ? WOOD : (int)batch->leaf_step, &part);
        }
    }
}

static void bind_cards(const struct wd_tree_draw *draw, const struct wd_pipeline *pipeline,
                       struct wd_binding instances)
{
    const struct wd_forest_device *forest = draw->forest;
    bool shadow = draw->pass == WD_PASS_SHADOW;
    VkSampler albedo = shadow ? forest->point_sampler : forest->card_sampler;
    const struct wd_binding bindings[] = {
        draw->uniforms,
        WD_BIND_BUFFER(&forest->trees),
        WD_BIND_BUFFER(&forest->models),
        instances,
        WD_BIND_IMAGE(&forest->card_albedo, albedo),
        WD_BIND_IMAGE(&forest->card_normal, forest->point_sampler),
        WD_BIND_BUFFER(&forest->fades)};
    wd_cmd_bind(draw->cmd, pipeline, bindings);
    wd_cmd_bind_indices(draw->cmd, &forest->card_indices);
}

/* Trees (or list slots) of a range as cards, in draws of at most `batch`. */
static void draw_card_range(const struct wd_tree_draw *draw, const struct wd_pipeline *pipeline,
                            const struct wd_range *range, uint32_t batch)
{
    struct wd_tree_push push = tree_push(draw, WD_LEVEL_CARD);
    push.card_vertices =
        draw->pass == WD_PASS_SHADOW ? WD_SHADOW_CARD_VERTICES : range->card_vertices;
    wd_cmd_push(draw->cmd, pipeline, &push, sizeof push);
    for (uint32_t at = range->begin; at < range->end; at += batch) {
        uint32_t count = range->end - at < batch ? range->end - at : batch;
        draw_indexed(draw, count * push.card_vertices / 4 * 6, 1, 0,
                     (int32_t)(at * push.card_vertices), 0);
    }
    draw->stats->trees[WD_LEVEL_CARD] += range->end - range->begin;
}

void wd_tree_draw_card_ranges(const struct wd_tree_draw *draw, const struct wd_range *ranges,
                              size_t count, const struct wd_buffer *list)
{
    const struct wd_pipeline *pipeline = list ? &draw->pipelines->card_listed[draw->pass]
                                              : &draw->pipelines->card_range[draw->pass];
    if (!count)
        return;
    /* octree order reads no instances; the slot is filled all the same */
    bind_cards(draw, pipeline, WD_BIND_BUFFER(list ? list : &draw->forest->trees));
    for (size_t i = 0; i < count; i++)
        draw_card_range(draw, pipeline, &ranges[i], WD_CARD_BATCH);
}

static void draw_cards(const struct wd_tree_draw *draw, const struct wd_selection *selection,
                       enum wd_draw_grouping grouping)
{
    wd_tree_draw_card_ranges(draw, selection->ranges, selection->range_count, NULL);
    struct wd_binding instances;
    if (selection->card_count &&
        upload_instances(draw, selection->cards, selection->card_count, &instances)) {
        const struct wd_pipeline *pipeline = &draw->pipelines->card_listed[draw->pass];
        const struct wd_range list = {0, (uint32_t)selection->card_count, WD_CARD_VERTICES};
        bind_cards(draw, pipeline, instances);
        draw_card_range(draw, pipeline, &list, grouping == WD_DRAW_GROUPED ? WD_CARD_BATCH : 1);
    }
}

void wd_tree_draw_wood(const struct wd_tree_draw *draw, struct wd_selection *selection)
{
    wd_selection_sort(selection, draw->forest->model_count);
    draw_meshes(draw, selection, WD_DRAW_WOOD, 0);
}

void wd_tree_draw_selection(const struct wd_tree_draw *draw, struct wd_selection *selection,
                            enum wd_draw_grouping grouping)
{
    wd_selection_sort(selection, draw->forest->model_count);
    bool sprays = draw->pass == WD_PASS_CAMERA;
    float spray_scale = sprays ? wd_spray_scale(draw, selection) : 0;
    draw_meshes(draw, selection, grouping, spray_scale);
    if (sprays)
        wd_spray_draw(draw, selection, spray_scale);
    draw_cards(draw, selection, grouping);
}
