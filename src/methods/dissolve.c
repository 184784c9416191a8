/* Instanced trees whose leaves and branches thin out with distance, and billboards of one view each
 * that they dissolve into (3DWorld, "Trees and forests"; rows W4-W7).
 *
 * Near trees are wood and leaves drawn apart: wood full or reduced, of the leaves in progressive
 * order ever fewer, down to a quarter, and those larger, so that leaf area is kept. Levels go by
 * horizontal distance: trees below a flying eye stay geometry, since a billboard's picture is from
 * the side. Far trees are pictures of branches and leaves apart, lit in the light pass. */
#include "methods/method.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "forest/model_bakes.h"
#include "methods/cells.h"
#include "methods/leaf_order.h"

static const uint32_t dissolve_leaf_vert[] =
#include "dissolve_leaf.vert.inc"
    ;
static const uint32_t dissolve_card_vert[] =
#include "dissolve_card.vert.inc"
    ;
static const uint32_t dissolve_card_frag[] =
#include "dissolve_card.frag.inc"
    ;
static const uint32_t tree_mesh_frag[] =
#include "tree_mesh.frag.inc"
    ;

/* Leaves are drawn as prefixes of their lists in steps of 1 / LEAF_STEPS; the shader cuts them to the
 * exact share. */
enum { LEAF_STEPS = 8, GROUP_TREES = 64, LEAF_BINDINGS = 8, CARD_BINDINGS = 10,
       PART_PLANES = 2 /* of leaves and of wood: albedo and normal */ };

/* Trees of one model whose leaves have the same prefix. */
struct leafy {
    uint32_t key; /* model * (LEAF_STEPS + 1) + step */
    struct wd_leafy_instance instance;
};

struct dissolve {
    struct wd_pipeline leaves[2]; /* [detail] */
    struct wd_pipeline cards;
    struct wd_cells groups;
    struct wd_leaf_order order;
    struct wd_image leaf_planes[PART_PLANES], wood_planes[PART_PLANES];
    struct wd_cell_list seen;
    struct wd_selection selection; /* wood, and billboards as its cards */
    struct leafy *leafy;
    size_t leafy_count, leafy_capacity;
    void *shadows; /* state of `octree`, which draws them */
};

/* --- pipelines --------------------------------------------------------------------------- */

static void set_gbuffer(struct wd_graphics_params *params)
{
    params->color_count = 3;
    params->color_formats[0] = WD_ALBEDO_FORMAT;
    params->color_formats[1] = WD_NORMAL_FORMAT;
    params->color_formats[2] = WD_SURFACE_FORMAT;
    params->depth_format = WD_DEPTH_FORMAT;
    params->topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
}

static bool init_leaves(struct wd_pipeline *pipeline, struct wd_gpu *gpu, uint32_t detail)
{
    const VkDescriptorType buffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    const VkDescriptorType image = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    const uint32_t constants[] = {0, detail};
    struct wd_graphics_params params = {
        .vertex = WD_SPIRV(dissolve_leaf_vert),
        .fragment = WD_SPIRV(tree_mesh_frag),
        .bindings = {LEAF_BINDINGS, {buffer, buffer, buffer, buffer, buffer, image, image, buffer}},
        .push_size = sizeof(struct wd_tree_push),
        .constants = {2, constants},
    };
    set_gbuffer(&params);
    return wd_pipeline_init_graphics(pipeline, gpu, &params);
}

static bool dissolve_init(void *state, struct wd_gpu *gpu)
{
    struct dissolve *dissolve = state;
    const VkDescriptorType buffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    const VkDescriptorType uniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    const VkDescriptorType image = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    struct wd_graphics_params cards = {
        .vertex = WD_SPIRV(dissolve_card_vert),
        .fragment = WD_SPIRV(dissolve_card_frag),
        .bindings = {CARD_BINDINGS,
                     {uniform, buffer, buffer, buffer, image, image, image, image, image, image}},
        .push_size = sizeof(struct wd_one_view_push),
    };
    set_gbuffer(&cards);
    dissolve->shadows = wd_method_borrow(&wd_method_octree, gpu);
    return dissolve->shadows && init_leaves(&dissolve->leaves[0], gpu, 0) && init_leaves(&dissolve->leaves[1], gpu, 1) &&
           wd_pipeline_init_graphics(&dissolve->cards, gpu, &cards);
}

static void dissolve_finish(void *state, struct wd_gpu *gpu)
{
    struct dissolve *dissolve = state;
    wd_method_give_back(&wd_method_octree, &dissolve->shadows, gpu);
}

/* --- the forest -------------------------------------------------------------------------- */

static bool bake(struct wd_image planes[PART_PLANES], struct wd_gpu *gpu,
                 struct wd_forest_device *forest, enum wd_bake_parts parts)
{
    struct wd_image *images[WD_PLANES] = {&planes[WD_PLANE_ALBEDO], &planes[WD_PLANE_NORMAL]};
    return wd_forest_bake_cards(forest, gpu, parts, images, WD_CARD_DEPTH_ALL);
}

static bool dissolve_use_forest(void *state, struct wd_gpu *gpu, struct wd_forest_device *forest)
{
    struct dissolve *dissolve = state;
    if (!forest->world->tree_count)
        return true;
    wd_cells_init(&dissolve->groups, forest->world, wd_cells_size(forest->world, GROUP_TREES));
    return wd_leaf_order_init(&dissolve->order, gpu, forest) &&
           bake(dissolve->leaf_planes, gpu, forest, WD_BAKE_LEAVES) &&
           bake(dissolve->wood_planes, gpu, forest, WD_BAKE_WOOD);
}

static void dissolve_drop_forest(void *state, struct wd_gpu *gpu)
{
    struct dissolve *dissolve = state;
    for (int plane = 0; plane < PART_PLANES; plane++) {
        wd_image_finish(&dissolve->leaf_planes[plane], gpu);
        wd_image_finish(&dissolve->wood_planes[plane], gpu);
    }
    wd_leaf_order_finish(&dissolve->order, gpu);
    wd_cells_finish(&dissolve->groups);
    wd_cell_list_finish(&dissolve->seen);
    wd_selection_finish(&dissolve->selection);
    free(dissolve->leafy);
    dissolve->leafy = NULL;
    dissolve->leafy_count = dissolve->leafy_capacity = 0;
}

/* --- choosing ---------------------------------------------------------------------------- */

/* Shares of geometry and billboard at a distance of the reference picture. The billboard comes in
 * whole before the geometry goes; `faithful`: both at once. */
static void blend(const struct wd_dissolve_options *options, float distance_m, float *geometry,
                  float *billboard)
{
    float from_m = (float)options->billboard_m;
    float t = wd_ramp(from_m, from_m + (float)options->overlap_m, distance_m);
    *billboard = options->faithful ? t : fminf(2.0f * t, 1.0f);
    *geometry = options->faithful ? 1.0f - t : fminf(2.0f - 2.0f * t, 1.0f);
}

static void add_leaves(struct dissolve *dissolve, const struct wd_dissolve_options *options,
                       uint32_t model, struct wd_leafy_instance instance, float distance_m)
{
    float thin = wd_ramp((float)options->leaves_begin_m, (float)options->leaves_end_m, distance_m);
    float kept = 1.0f - thin * (1.0f - (float)options->least_leaves);
    uint32_t step = (uint32_t)ceilf(kept * LEAF_STEPS);
    instance.kept = kept;
    instance.scale = options->keep_area && !options->faithful ? 1.0f / sqrtf(kept) : 1.0f;
    *wd_push(dissolve->leafy, dissolve->leafy_count, dissolve->leafy_capacity) =
        (struct leafy){model * (LEAF_STEPS + 1) + step, instance};
}

static void add_tree(struct dissolve *dissolve, const struct wd_tree_draw *draw, uint32_t index)
{
    const struct wd_forest_device *forest = draw->forest;
    const struct wd_dissolve_options *options = &forest->scene->methods.dissolve;
    const struct wd_tree *tree = &forest->world->trees[index];
    const double *eye_m = draw->view->eye_m;
    if (!wd_tree_in_view(draw->view, tree))
        return;
    float x = (float)(tree->x_mm * 0.001 - eye_m[0]), y = (float)(tree->y_mm * 0.001 - eye_m[1]);
    float z = (float)(tree->z_mm * 0.001 - eye_m[2]), level_m = sqrtf(x * x + y * y);
    float whole_m = sqrtf(x * x + y * y + z * z), geometry, billboard;
    float fade = wd_layer_show(forest->host_fades[wd_forest_fade_of(forest, index)], whole_m);
    float scale = options->faithful ? 1.0f : draw->view->lod_scale;
    whole_m /= scale;
    level_m /= scale;
    blend(options, options->faithful ? whole_m : level_m, &geometry, &billboard);
    geometry *= fade;
    billboard *= fade;
    uint32_t model = wd_forest_model_of(forest, tree);
    if (geometry > 0.0f) {
        uint32_t level = whole_m < options->branches_m ? WD_LEVEL_MESH : WD_LEVEL_REDUCED;
        wd_selection_add_mesh(&dissolve->selection, &(struct wd_mesh_choice){model, level, 0},
                              index, geometry);
        add_leaves(dissolve, options, model, (struct wd_leafy_instance){index, geometry, 0, 0},
                   whole_m);
    }
    if (billboard > 0.0f)
        *wd_push(dissolve->selection.cards, dissolve->selection.card_count,
                 dissolve->selection.card_capacity) = (struct wd_instance){index, billboard};
}

static int by_key(const void *a, const void *b)
{
    const struct leafy *one = a, *other = b;
    if (one->key != other->key)
        return one->key < other->key ? -1 : 1;
    return one->instance.tree < other->instance.tree ? -1 : 1;
}

static void use_images(struct dissolve *dissolve, struct wd_cmd *cmd)
{
    for (int plane = 0; plane < PART_PLANES; plane++) {
        wd_cmd_use_image(cmd, &dissolve->leaf_planes[plane], WD_USE_SHADER_READ);
        wd_cmd_use_image(cmd, &dissolve->wood_planes[plane], WD_USE_SHADER_READ);
    }
    wd_cmd_use_buffer(cmd, &dissolve->order.vertices, WD_USE_SHADER_READ);
    wd_cmd_use_buffer(cmd, &dissolve->order.places, WD_USE_SHADER_READ);
    wd_cmd_use_buffer(cmd, &dissolve->order.indices, WD_USE_INDEX);
}

static void dissolve_select(void *state, const struct wd_tree_draw *draw)
{
    struct dissolve *dissolve = state;
    if (draw->pass == WD_PASS_SHADOW) {
        wd_method_octree.select(dissolve->shadows, draw);
        return;
    }
    wd_selection_clear(&dissolve->selection);
    dissolve->leafy_count = 0;
    wd_cell_list_fill(&dissolve->seen, &dissolve->groups, draw->view);
    for (size_t i = 0; i < dissolve->seen.count; i++) {
        uint32_t group = dissolve->seen.items[i].cell;
        for (uint32_t k = dissolve->groups.first[group]; k < dissolve->groups.first[group + 1]; k++)
            add_tree(dissolve, draw, dissolve->groups.trees[k]);
    }
    qsort(dissolve->leafy, dissolve->leafy_count, sizeof *dissolve->leafy, by_key);
    use_images(dissolve, draw->cmd);
}

/* --- drawing ----------------------------------------------------------------------------- */

/* Of a prefix of so many steps, whole triangles. A leaf at its end must not be cut, as the leaf's rank decides whether it
 * stands: there are so many indices more. */
enum { ONE_LEAF_MORE = 93 };

static uint32_t prefix_indices(const struct wd_leaf_range *leaves, uint32_t step)
{
    uint32_t indices = (leaves->index_count / LEAF_STEPS * step + ONE_LEAF_MORE + 2) / 3 * 3;
    return step == LEAF_STEPS || indices > leaves->index_count ? leaves->index_count : indices;
}

static void bind_leaves(const struct dissolve *dissolve, const struct wd_tree_draw *draw,
                        const struct wd_leaf_range *leaves, struct wd_binding instances, bool whole)
{
    const struct wd_forest_device *forest = draw->forest;
    const struct wd_pipeline *pipeline = &dissolve->leaves[whole];
    VkDeviceSize first_vertex = leaves->first_vertex, vertex_count = leaves->vertex_count;
    const struct wd_binding vertices = {
        .buffer = &dissolve->order.vertices,
        .offset = first_vertex * sizeof(struct wd_tree_vertex),
        .size = vertex_count * sizeof(struct wd_tree_vertex),
    };
    const struct wd_binding places = {
        .buffer = &dissolve->order.places,
        .offset = first_vertex * sizeof(struct wd_leaf_place),
        .size = vertex_count * sizeof(struct wd_leaf_place),
    };
    const struct wd_binding bindings[LEAF_BINDINGS] = {
        draw->uniforms,
        WD_BIND_BUFFER(&forest->trees),
        WD_BIND_BUFFER(&forest->models),
        vertices,
        instances,
        WD_BIND_IMAGE(&forest->looks, forest->look_sampler),
        WD_BIND_IMAGE(&forest->look_details, forest->look_sampler),
        places,
    };
    const struct wd_tree_push push = {.variants = forest->variants,
                                      .level = whole ? WD_LEVEL_MESH : WD_LEVEL_REDUCED,
                                      .show = 1.0f,
                                      .pixels_per_radian = draw->view->pixels_per_radian};
    wd_cmd_bind(draw->cmd, pipeline, bindings);
    wd_cmd_push(draw->cmd, pipeline, &push, sizeof push);
    wd_cmd_bind_indices(draw->cmd, &dissolve->order.indices);
}

static void draw_batch(const struct dissolve *dissolve, const struct wd_tree_draw *draw,
                       struct wd_binding instances, size_t first, size_t count)
{
    uint32_t model = dissolve->leafy[first].key / (LEAF_STEPS + 1);
    uint32_t step = dissolve->leafy[first].key % (LEAF_STEPS + 1);
    const struct wd_leaf_range *leaves = &dissolve->order.ranges[model];
    uint32_t indices = prefix_indices(leaves, step);
    if (!indices)
        return;
    bind_leaves(dissolve, draw, leaves, instances, step == LEAF_STEPS);
    wd_cmd_draw_indexed(draw->cmd,
                        &(VkDrawIndexedIndirectCommand){indices, (uint32_t)count,
                                                        leaves->first_index, 0, (uint32_t)first});
    draw->stats->draw_calls++;
    draw->stats->triangles += (uint64_t)indices / 3 * count;
}

static void draw_leaves(const struct dissolve *dissolve, const struct wd_tree_draw *draw)
{
    struct wd_binding instances;
    size_t count = dissolve->leafy_count;
    if (!count)
        return;
    struct wd_leafy_instance *memory = wd_cmd_upload(draw->cmd, count * sizeof *memory, &instances);
    if (!memory)
        return;
    for (size_t i = 0; i < count; i++)
        memory[i] = dissolve->leafy[i].instance;
    for (size_t first = 0, end; first < count; first = end) {
        for (end = first + 1; end < count && dissolve->leafy[end].key == dissolve->leafy[first].key;)
            end++;
        draw_batch(dissolve, draw, instances, first, end - first);
    }
}

static void draw_billboards(const struct dissolve *dissolve, const struct wd_tree_draw *draw)
{
    const struct wd_forest_device *forest = draw->forest;
    size_t count = dissolve->selection.card_count;
    struct wd_binding instances;
    if (!count)
        return;
    void *memory = wd_cmd_upload(draw->cmd, count * sizeof(struct wd_instance), &instances);
    if (!memory)
        return;
    memcpy(memory, dissolve->selection.cards, count * sizeof(struct wd_instance));
    struct wd_binding bindings[CARD_BINDINGS] = {draw->uniforms, WD_BIND_BUFFER(&forest->trees),
                                                 WD_BIND_BUFFER(&forest->models), instances};
    for (int plane = 0; plane < PART_PLANES; plane++) {
        VkSampler sampler =
            plane == WD_PLANE_ALBEDO ? forest->card_sampler : forest->point_sampler;
        bindings[4 + plane] = WD_BIND_IMAGE(&dissolve->leaf_planes[plane], sampler);
        bindings[6 + plane] = WD_BIND_IMAGE(&dissolve->wood_planes[plane], sampler);
    }
    bindings[8] = WD_BIND_IMAGE(&forest->card_albedo, forest->card_sampler);
    bindings[9] = WD_BIND_IMAGE(&forest->card_leaf, forest->point_sampler);
    const struct wd_one_view_push push = {
        .variants = forest->variants,
        .pixels_per_radian = draw->view->pixels_per_radian,
        .one_view = forest->scene->methods.dissolve.faithful,
    };
    wd_cmd_bind(draw->cmd, &dissolve->cards, bindings);
    wd_cmd_push(draw->cmd, &dissolve->cards, &push, sizeof push);
    wd_tree_draw_quads(draw, (uint32_t)count);
    draw->stats->trees[WD_LEVEL_CARD] += count;
}

static void dissolve_draw(void *state, const struct wd_tree_draw *draw)
{
    struct dissolve *dissolve = state;
    if (draw->pass == WD_PASS_SHADOW) {
        wd_method_octree.draw(dissolve->shadows, draw);
        return;
    }
    wd_tree_draw_wood(draw, &dissolve->selection);
    draw_leaves(dissolve, draw);
    draw_billboards(dissolve, draw);
}

const struct wd_method wd_method_dissolve = {
    .name = "dissolve",
    .cards = true,
    .state_size = sizeof(struct dissolve),
    .init = dissolve_init,
    .finish = dissolve_finish,
    .use_forest = dissolve_use_forest,
    .drop_forest = dissolve_drop_forest,
    .select = dissolve_select,
    .draw = dissolve_draw,
};
