#include "methods/view_trees.h"

#include <string.h>

static const uint32_t view_tree_vert[] =
#include "view_tree.vert.inc"
    ;
static const uint32_t view_tree_frag[] =
#include "view_tree.frag.inc"
    ;
static const uint32_t zfield_tree_frag[] =
#include "zfield_tree.frag.inc"
    ;

/* Shaders hold a view in ten bits. */
enum { BINDINGS = 9, MAX_VIEWS = 1023, GROUP_TREES = 64 };

bool wd_view_trees_init(struct wd_view_trees *trees, struct wd_gpu *gpu, enum wd_view_shape shape)
{
    const VkDescriptorType buffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    const VkDescriptorType uniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    const VkDescriptorType image = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    const uint32_t constants[] = {shape};
    const struct wd_spirv fragments[] = {WD_SPIRV(view_tree_frag), WD_SPIRV(zfield_tree_frag)};
    const struct wd_graphics_params params = {
        .vertex = WD_SPIRV(view_tree_vert),
        .fragment = fragments[shape],
        .bindings = {BINDINGS,
                     {uniform, buffer, buffer, buffer, buffer, buffer, image, image, image}},
        .push_size = sizeof(struct wd_view_push),
        .constants = {1, constants},
        .color_count = 3,
        .color_formats = {WD_ALBEDO_FORMAT, WD_NORMAL_FORMAT, WD_SURFACE_FORMAT},
        .depth_format = WD_DEPTH_FORMAT,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST,
    };
    trees->shadows = wd_method_borrow(&wd_method_octree, gpu);
    return trees->shadows && wd_pipeline_init_graphics(&trees->pipeline, gpu, &params) &&
           wd_sampler_init(&trees->sampler, gpu, WD_SAMPLER_TRILINEAR_CLAMP);
}

void wd_view_trees_finish(struct wd_view_trees *trees, struct wd_gpu *gpu)
{
    vkDestroySampler(gpu->device, trees->sampler, NULL);
    wd_method_give_back(&wd_method_octree, &trees->shadows, gpu);
}

bool wd_view_trees_use_forest(struct wd_view_trees *trees, struct wd_gpu *gpu,
                              struct wd_forest_device *forest,
                              const struct wd_view_sets_params *params)
{
    if (!forest->world->tree_count)
        return true;
    wd_cells_init(&trees->groups, forest->world, wd_cells_size(forest->world, GROUP_TREES));
    if (!wd_view_sets_init(&trees->sets, gpu, forest, params))
        return false;
    uint32_t views = wd_hemisphere_count(trees->sets.atlas.hemisphere);
    if (views > MAX_VIEWS)
        return wd_error(gpu->log, "%u views of a tree; at most %d are possible", views, MAX_VIEWS);
    return true;
}

void wd_view_trees_drop_forest(struct wd_view_trees *trees, struct wd_gpu *gpu)
{
    wd_view_sets_finish(&trees->sets, gpu);
    wd_cells_finish(&trees->groups);
    wd_cell_list_finish(&trees->seen);
    wd_selection_finish(&trees->selection);
    trees->trees = NULL;
    trees->tree_count = 0;
}

/* --- choosing ---------------------------------------------------------------------------- */

static void select_camera(struct wd_view_trees *trees, const struct wd_tree_draw *draw,
                          float near_m, float range_m)
{
    struct wd_level_rule rule = wd_level_rule_of(draw->forest, draw->view, draw->pass);
    rule.mesh_m = rule.reduced_m = near_m * draw->view->lod_scale;
    rule.plain = true;
    wd_selection_clear(&trees->selection);
    wd_cell_list_fill(&trees->seen, &trees->groups, draw->view);
    for (size_t i = 0; i < trees->seen.count; i++) {
        const struct wd_near_cell *near = &trees->seen.items[i];
        if (range_m > 0.0f && near->distance_m > range_m)
            break;
        for (uint32_t k = trees->groups.first[near->cell]; k < trees->groups.first[near->cell + 1];
             k++)
            wd_selection_add_tree(&trees->selection, draw->forest, draw->view, &rule,
                                  trees->groups.trees[k]);
    }
}

void wd_view_trees_select(struct wd_view_trees *trees, const struct wd_tree_draw *draw,
                          float near_m, float range_m)
{
    if (draw->pass == WD_PASS_SHADOW) {
        wd_method_octree.select(trees->shadows, draw);
        return;
    }
    select_camera(trees, draw, near_m, range_m);
    /* what the selection would draw as cards is drawn by pictures */
    trees->trees = trees->selection.cards;
    trees->tree_count = trees->selection.card_count;
    trees->selection.card_count = 0;
    wd_view_sets_use(&trees->sets, draw->cmd);
}

/* --- drawing ----------------------------------------------------------------------------- */

static void draw_pictures(const struct wd_view_trees *trees, const struct wd_tree_draw *draw,
                          const struct wd_view_push *push)
{
    const struct wd_forest_device *forest = draw->forest;
    struct wd_binding instances;
    size_t bytes = trees->tree_count * sizeof *trees->trees;
    void *memory = trees->tree_count ? wd_cmd_upload(draw->cmd, bytes, &instances) : NULL;
    if (!memory)
        return;
    memcpy(memory, trees->trees, bytes);
    const struct wd_binding bindings[BINDINGS] = {
        draw->uniforms,
        WD_BIND_BUFFER(&forest->trees),
        WD_BIND_BUFFER(&forest->models),
        instances,
        WD_BIND_BUFFER(&forest->fades),
        WD_BIND_BUFFER(&trees->sets.models),
        WD_BIND_IMAGE(&trees->sets.planes[WD_PLANE_ALBEDO], trees->sampler),
        WD_BIND_IMAGE(&trees->sets.planes[WD_PLANE_NORMAL], trees->sampler),
        WD_BIND_IMAGE(&trees->sets.planes[WD_PLANE_DEPTH], trees->sampler)};
    wd_cmd_bind(draw->cmd, &trees->pipeline, bindings);
    wd_cmd_push(draw->cmd, &trees->pipeline, push, sizeof *push);
    wd_tree_draw_quads(draw, (uint32_t)trees->tree_count);
    draw->stats->trees[WD_LEVEL_CARD] += trees->tree_count;
}

void wd_view_trees_draw(struct wd_view_trees *trees, const struct wd_tree_draw *draw,
                        struct wd_view_push push)
{
    if (draw->pass == WD_PASS_SHADOW) {
        wd_method_octree.draw(trees->shadows, draw);
        return;
    }
    push.atlas = trees->sets.atlas;
    push.variants = draw->forest->variants;
    push.baked_variants = trees->sets.variants;
    push.pixels_per_radian = draw->view->pixels_per_radian;
    wd_tree_draw_selection(draw, &trees->selection, WD_DRAW_GROUPED);
    draw_pictures(trees, draw, &push);
}
