#include "methods/tree_draw.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "frame/targets.h"
#include "methods/leaf_view.h"
#include "methods/spray_draw.h"

static const uint32_t tree_mesh_vert[] =
#include "tree_mesh.vert.inc"
    ;
static const uint32_t tree_leaf_vert[] =
#include "tree_leaf.vert.inc"
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
        params->depth_bias_slope = WD_SHADOW_SLOPE;
    }
}

/* Of wood, or of leaves. */
static bool init_mesh(struct wd_pipeline *pipeline, struct wd_gpu *gpu, enum wd_tree_pass pass,
                      struct wd_spirv vertex, uint32_t detail, uint32_t falls)
{
    const uint32_t constants[] = {pass == WD_PASS_SHADOW, detail, falls};
    struct wd_graphics_params params = {
        .vertex = vertex,
        .bindings = {9,
                     {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                      VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                      VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                      VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                      VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                      VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}},
        .constants = {3, constants},
    };
    const struct wd_spirv fragments[] = {WD_SPIRV(tree_mesh_frag), WD_SPIRV(tree_mesh_shadow_frag)};
    params.fragment = fragments[pass];
    set_targets(&params, pass);
    params.push_size = sizeof(struct wd_mesh_push);
    return wd_pipeline_init_graphics(pipeline, gpu, &params);
}

static bool init_card(struct wd_pipeline *pipeline, struct wd_gpu *gpu, enum wd_tree_pass pass,
                      uint32_t listed)
{
    const uint32_t constants[] = {pass == WD_PASS_SHADOW, listed};
    struct wd_graphics_params params = {
        .vertex = WD_SPIRV(tree_card_vert),
        .bindings = {8,
                     {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                      VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                      VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                      VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                      VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                      VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}},
        .constants = {2, constants},
    };
    const struct wd_spirv fragments[] = {WD_SPIRV(tree_card_frag), WD_SPIRV(tree_card_shadow_frag)};
    params.fragment = fragments[pass];
    set_targets(&params, pass);
    return wd_pipeline_init_graphics(pipeline, gpu, &params);
}

static bool init_leaves(struct wd_tree_pipelines *pipelines, struct wd_gpu *gpu, uint32_t falls)
{
    const struct wd_spirv leaf = WD_SPIRV(tree_leaf_vert);
    for (int pass = WD_PASS_CAMERA; pass <= WD_PASS_SHADOW; pass++) {
        if (!init_mesh(&pipelines->leaf[pass][falls], gpu, pass, leaf, 0, falls) ||
            !init_mesh(&pipelines->leaf_listed[pass][falls], gpu, pass, leaf, 1, falls))
            return false;
    }
    return true;
}

bool wd_tree_pipelines_init(struct wd_tree_pipelines *pipelines, struct wd_gpu *gpu)
{
    const struct wd_spirv wood = WD_SPIRV(tree_mesh_vert);
    *pipelines = (struct wd_tree_pipelines){0};
    bool ok = init_mesh(&pipelines->mesh_detail, gpu, WD_PASS_CAMERA, wood, 1, 0) &&
              init_leaves(pipelines, gpu, 0);
    for (int pass = WD_PASS_CAMERA; ok && pass <= WD_PASS_SHADOW; pass++)
        ok = init_mesh(&pipelines->mesh[pass], gpu, pass, wood, 0, 0) &&
             wd_spray_pipeline_init(&pipelines->spray[pass], gpu, pass);
    if (!ok)
        *pipelines = (struct wd_tree_pipelines){0};
    return ok;
}

bool wd_tree_pipelines_prepare(struct wd_tree_pipelines *pipelines, struct wd_gpu *gpu,
                               const struct wd_forest_device *forest, bool cards)
{
    bool ok = true;
    if (!pipelines->leaf_listed[WD_PASS_SHADOW][1].kept && forest->falls)
        ok = init_leaves(pipelines, gpu, 1);
    for (int pass = WD_PASS_CAMERA; ok && cards && pass <= WD_PASS_SHADOW; pass++)
        if (!pipelines->card_listed[pass].kept)
            ok = init_card(&pipelines->card_range[pass], gpu, pass, 0) &&
                 init_card(&pipelines->card_listed[pass], gpu, pass, 1);
    return ok;
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

void wd_tree_draw_quads(const struct wd_tree_draw *draw, uint32_t quads)
{
    const uint32_t most = draw->forest->quads_a_draw;
    wd_cmd_bind_indices(draw->cmd, &draw->forest->card_indices);
    for (uint32_t at = 0; at < quads; at += most) {
        uint32_t count = quads - at < most ? quads - at : most;
        draw_indexed(draw, count * 6, 1, 0, (int32_t)(at * 4), 0);
    }
}

static struct wd_binding bind_vertices(const struct wd_forest_device *forest,
                                       const struct wd_mesh_range *range)
{
    uint32_t count = range->vertex_count ? range->vertex_count : 1;
    return (struct wd_binding){
        .buffer = &forest->meshes.vertices,
        .offset = (VkDeviceSize)range->first_vertex * sizeof(struct wd_packed_vertex),
        .size = (VkDeviceSize)count * sizeof(struct wd_packed_vertex),
    };
}

/* The leaves of a model, or something in their place. */
static struct wd_binding bind_leaves(const struct wd_forest_device *forest, uint32_t model)
{
    const struct wd_twig_range *range = &forest->meshes.twigs[model];
    uint32_t count = range->leaf_count ? range->leaf_count : 1;
    return (struct wd_binding){
        .buffer = &forest->meshes.leaves,
        .offset = (VkDeviceSize)range->first_leaf * sizeof(struct wd_tree_leaf),
        .size = (VkDeviceSize)count * sizeof(struct wd_tree_leaf),
    };
}

/* A batch that is being drawn. */
struct meshes {
    const struct wd_tree_draw *draw;
    const struct wd_mesh_batch *batch;
    const struct wd_mesh_range *range;
    const struct wd_instance *trees; /* of the whole selection */
    struct wd_binding instances;     /* the same */
    struct wd_binding listed;        /* leaves in view; or of no use */
    float spray_scale;
};

static void bind_meshes(const struct meshes *meshes, const struct wd_pipeline *pipeline,
                        struct wd_binding corners, const struct wd_mesh_push *push,
                        VkIndexType index_type)
{
    const struct wd_tree_draw *draw = meshes->draw;
    const struct wd_forest_device *forest = draw->forest;
    const struct wd_binding bindings[] = {draw->uniforms,
                                          WD_BIND_BUFFER(&forest->trees),
                                          WD_BIND_BUFFER(&forest->models),
                                          corners,
                                          meshes->instances,
                                          WD_BIND_IMAGE(&forest->looks, forest->look_sampler),
                                          WD_BIND_IMAGE(&forest->look_details,
                                                        forest->look_sampler),
                                          bind_leaves(forest, meshes->batch->model),
                                          meshes->listed};
    wd_cmd_bind(draw->cmd, pipeline, bindings);
    wd_cmd_push(draw->cmd, pipeline, push, sizeof *push);
    wd_cmd_bind_indices_of(draw->cmd, &forest->meshes.indices, index_type);
}

static const struct wd_pipeline *mesh_pipeline(const struct meshes *meshes)
{
    const struct wd_tree_pipelines *pipelines = meshes->draw->pipelines;
    enum wd_tree_pass pass = meshes->draw->pass;
    bool detailed = pass == WD_PASS_CAMERA && meshes->batch->level == WD_LEVEL_MESH;
    return detailed ? &pipelines->mesh_detail : &pipelines->mesh[pass];
}

/* Full meshes have many leaves, of which few are in view or shade what is; those that fall are anywhere. */
static bool lists_leaves(const struct meshes *meshes)
{
    const struct wd_tree_draw *draw = meshes->draw;
    bool hang = draw->forest->host_models[meshes->batch->model].fall_mps <= 0.0f;
    return meshes->batch->level == WD_LEVEL_MESH && (hang || draw->pass == WD_PASS_CAMERA);
}

static const struct wd_pipeline *leaf_pipeline(const struct meshes *meshes)
{
    const struct wd_tree_draw *draw = meshes->draw;
    bool falls = draw->forest->host_models[meshes->batch->model].fall_mps > 0.0f;
    return lists_leaves(meshes) ? &draw->pipelines->leaf_listed[draw->pass][falls]
                                : &draw->pipelines->leaf[draw->pass][falls];
}

/* Triangles: of grown trees their wood, of imported ones all, or with `wood` their wood alone. */
static void draw_triangles(const struct meshes *meshes, bool wood)
{
    const struct wd_tree_draw *draw = meshes->draw;
    const struct wd_mesh_range *range = meshes->range;
    uint32_t count = wood ? range->wood_index_count : range->index_count;
    struct wd_mesh_push push = {.tree = tree_push(draw, meshes->batch->level)};
    push.box.feet = range->box;
    if (!count)
        return;
    bind_meshes(meshes, mesh_pipeline(meshes), bind_vertices(draw->forest, range), &push,
                range->index_type);
    draw_indexed(draw, count, meshes->batch->count, range->first_index, 0, meshes->batch->first);
}

static struct wd_mesh_push leaf_push(const struct meshes *meshes, const struct wd_leaf_draw *set,
                                     bool leaves)
{
    const struct wd_tree_draw *draw = meshes->draw;
    const struct wd_twig_range *twig = &draw->forest->meshes.twigs[meshes->batch->model];
    struct wd_mesh_push push = {
        .tree = tree_push(draw, meshes->batch->level),
        .box = twig->box,
        .own = set->own,
        .arch_least = set->arch_least,
        .arch_range = set->arch_range,
        .first_leaf = set->first_leaf,
        .first_corner = set->first_corner,
        .corner_count = set->corner_count,
        .forms = set->forms,
        .corner_bits = set->corner_bits,
        .first_name = meshes->range->vertex_count,
    };
    push.tree.pixels_per_radian = wd_leaf_pixels(draw->forest, draw->view, draw->pass);
    if (!leaves) { /* flowers are all drawn, and hide the numbers of leaves before them */
        push.first_name += meshes->range->sets[WD_SET_LEAVES].leaf_count *
                           meshes->range->sets[WD_SET_LEAVES].corner_count;
        return push;
    }
    if (meshes->batch->level == WD_LEVEL_MESH)
        push.tree.spray_reach = meshes->spray_scale * twig->reach;
    push.tree.leaf_most = wd_leaf_most(draw->forest, draw->view, draw->pass, meshes->batch->model,
                                       meshes->batch->level);
    push.tree.leaf_m = meshes->range->leaf_m;
    push.tree.leaf_count = meshes->range->leaf_count;
    return push;
}

/* The first `count` leaves of a set or of a list, as many with one draw as 16-bit indices can name. */
static void draw_leaves(const struct meshes *meshes, int kind, uint32_t count)
{
    const struct wd_tree_draw *draw = meshes->draw;
    const struct wd_leaf_draw *set = &meshes->range->sets[kind];
    uint32_t most = WD_LEAF_DRAW_VERTICES >> set->corner_bits;
    const struct wd_mesh_push push = leaf_push(meshes, set, kind == WD_SET_LEAVES);
    bind_meshes(meshes, leaf_pipeline(meshes), WD_BIND_BUFFER(&draw->forest->meshes.corners),
                &push, VK_INDEX_TYPE_UINT16);
    for (uint32_t at = 0; at < count; at += most) {
        uint32_t leaves = count - at < most ? count - at : most;
        draw_indexed(draw, leaves * set->index_count, meshes->batch->count, set->first_index,
                     (int32_t)(at << set->corner_bits), meshes->batch->first);
    }
}

/* Leaves that fall are anywhere. */
static uint32_t list_leaves(const struct meshes *meshes, uint32_t tree,
                            const struct wd_leaf_draw *set, uint32_t count, uint32_t *list)
{
    const struct wd_forest_device *forest = meshes->draw->forest;
    if (forest->host_models[meshes->batch->model].fall_mps <= 0.0f)
        return wd_leaves_in_view(meshes->draw, tree, set, count, list);
    for (uint32_t i = 0; i < count; i++)
        list[i] = i;
    return count;
}

/* Those in view, or that shade what is, tree by tree: most of what stands near by lies beside the picture
 * or above it. */
static void draw_seen_leaves(const struct meshes *meshes, int kind, uint32_t count)
{
    uint32_t *list = wd_alloc_array(count, sizeof *list);
    for (uint32_t i = 0; i < meshes->batch->count; i++) {
        struct wd_mesh_batch batch = *meshes->batch;
        struct meshes one = *meshes;
        batch.first += i;
        batch.count = 1;
        one.batch = &batch;
        uint32_t seen = list_leaves(meshes, meshes->trees[batch.first].tree,
                                    &meshes->range->sets[kind], count, list);
        uint32_t *memory =
            seen ? wd_cmd_upload(meshes->draw->cmd, seen * sizeof *list, &one.listed) : NULL;
        if (!memory)
            continue;
        memcpy(memory, list, seen * sizeof *list);
        draw_leaves(&one, kind, seen);
    }
    free(list);
}

static void draw_set(const struct meshes *meshes, int kind, uint32_t count)
{
    if (count && lists_leaves(meshes))
        draw_seen_leaves(meshes, kind, count);
    else if (count)
        draw_leaves(meshes, kind, count);
}

/* Leaves of a step: at least those that the shader lets stand. */
static uint32_t step_leaves(const struct wd_mesh_range *range, uint32_t step)
{
    uint32_t all = range->sets[WD_SET_LEAVES].leaf_count;
    uint32_t some = (range->leaf_count >> step) + 1;
    return range->leaf_count && step > 0 && some < all ? some : all;
}

static void draw_batch(const struct meshes *meshes, bool wood)
{
    const struct wd_mesh_range *range = meshes->range;
    draw_triangles(meshes, wood);
    if (wood)
        return;
    draw_set(meshes, WD_SET_LEAVES, step_leaves(range, meshes->batch->leaf_step));
    draw_set(meshes, WD_SET_FLOWERS, range->sets[WD_SET_FLOWERS].leaf_count);
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
        struct wd_mesh_batch batch = selection->batches[i];
        const struct meshes meshes = {draw, &batch, &forest->meshes.ranges[batch.model][batch.level],
                                      selection->meshes, instances, instances, spray_scale};
        uint32_t draws = grouping == WD_DRAW_SINGLE ? batch.count : 1;
        draw->stats->trees[batch.level] += batch.count;
        batch.count /= draws;
        for (uint32_t k = 0; k < draws; k++, batch.first++)
            draw_batch(&meshes, grouping == WD_DRAW_WOOD);
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
        WD_BIND_BUFFER(&forest->fades),
        WD_BIND_IMAGE(&forest->card_leaf, forest->point_sampler)};
    wd_cmd_bind(draw->cmd, pipeline, bindings);
    wd_cmd_bind_indices(draw->cmd, &forest->card_indices);
}

static uint32_t card_batch(const struct wd_tree_draw *draw)
{
    return draw->forest->quads_a_draw * 4 / WD_CARD_VERTICES;
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
        draw_card_range(draw, pipeline, &ranges[i], card_batch(draw));
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
        draw_card_range(draw, pipeline, &list,
                        grouping == WD_DRAW_GROUPED ? card_batch(draw) : 1);
    }
}

void wd_tree_draw_wood(const struct wd_tree_draw *draw, struct wd_selection *selection)
{
    wd_selection_sort(selection, draw->forest->model_count);
    draw_meshes(draw, selection, WD_DRAW_WOOD, 0);
}

/* Twigs throw shadows on what is about as near. With those of the next map walks cost 4 % more in place of 2. */
enum { LAST_TWIG_CASCADE = 0 };

void wd_tree_draw_selection(const struct wd_tree_draw *draw, struct wd_selection *selection,
                            enum wd_draw_grouping grouping)
{
    wd_selection_sort(selection, draw->forest->model_count);
    bool sprays = draw->pass == WD_PASS_CAMERA || draw->view->cascade <= LAST_TWIG_CASCADE;
    float spray_scale = sprays ? wd_spray_scale(draw, selection) : 0;
    draw_meshes(draw, selection, grouping, spray_scale);
    if (sprays)
        wd_spray_draw(draw, selection, spray_scale);
    draw_cards(draw, selection, grouping);
}
