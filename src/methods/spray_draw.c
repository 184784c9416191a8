#include "methods/spray_draw.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "frame/uniforms.h"
#include "methods/leaf_view.h"
#include "shared/hash.h"

static const uint32_t tree_spray_vert[] =
#include "tree_spray.vert.inc"
    ;
static const uint32_t tree_spray_frag[] =
#include "tree_mesh.frag.inc"
    ;
static const uint32_t tree_spray_shadow_frag[] =
#include "tree_mesh_shadow.frag.inc"
    ;

bool wd_spray_pipeline_init(struct wd_pipeline *pipeline, struct wd_gpu *gpu, enum wd_tree_pass pass)
{
    const uint32_t constants[] = {pass == WD_PASS_SHADOW, 1};
    struct wd_graphics_params params = {
        .vertex = WD_SPIRV(tree_spray_vert),
        .fragment = WD_SPIRV(tree_spray_frag),
        .bindings = {8,
                     {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                      VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                      VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                      VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                      VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                      VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}},
        .constants = {2, constants},
        .push_size = sizeof(struct wd_spray_push),
        .color_count = 3,
        .color_formats = {WD_ALBEDO_FORMAT, WD_NORMAL_FORMAT, WD_SURFACE_FORMAT},
        .depth_format = WD_DEPTH_FORMAT,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST,
    };
    if (pass == WD_PASS_SHADOW) {
        params.fragment = (struct wd_spirv)WD_SPIRV(tree_spray_shadow_frag);
        params.color_count = 0;
        params.depth_bias_slope = WD_SHADOW_SLOPE;
    }
    return wd_pipeline_init_graphics(pipeline, gpu, &params);
}

/* A twig in full, or as shadow maps show it, for the camera where leaves are some pixels wide and less. */
enum { FULL, PLAIN, DETAILS };
static const float PLAIN_PX = 1.5f;

static const struct wd_mesh_range *twig_mesh(const struct wd_twig_range *range, int detail)
{
    return detail == PLAIN ? &range->shade : &range->mesh;
}

/* What it takes to show a leaf in view as a twig. */
struct candidate {
    float distance_m, reach, chance; /* shown where the share at this distance is over `chance` */
    uint32_t triangles;
};

/* Twigs of one model, gathered before they are uploaded, or all that could be. */
struct gather {
    float scale;
    struct twigs {
        struct wd_spray_instance *items;
        size_t count, capacity;
    } twigs[DETAILS];
    struct candidate *candidates; /* gathered instead, with `weigh` */
    size_t candidate_count, candidate_capacity;
    bool weigh;
};

/* A tree whose twigs are gathered. */
struct bearer {
    uint32_t index;
    const struct wd_twig_range *range;
    float reach;
    struct wd_stand stand;
};

/* Each leaf changes at a distance of its own. */
static int detail_of(const struct wd_tree_draw *draw, const struct bearer *bearer, float size_m, float distance_m,
                     float chance)
{
    float grain_px = bearer->range->shade_grain * size_m / distance_m * draw->view->pixels_per_radian;
    float own = 7 * chance - floorf(7 * chance);
    return draw->pass == WD_PASS_SHADOW || grain_px < PLAIN_PX * (0.8f + 0.4f * own) ? PLAIN : FULL;
}

static void gather_leaf(struct gather *gather, const struct wd_tree_draw *draw,
                        const struct bearer *bearer, const struct wd_tree_leaf *leaf, uint32_t index)
{
    const struct wd_tree_pose *pose = &bearer->stand.pose;
    const struct wd_tree *tree = &draw->forest->world->trees[bearer->index];
    const struct wd_leaf_box box = bearer->range->box;
    float at[3];
    wd_stand_place(&bearer->stand, wd_leaf_foot(*leaf, box), at);
    float square = at[0] * at[0] + at[1] * at[1] + at[2] * at[2];
    if (square > WD_SPRAY_NONE_M * WD_SPRAY_NONE_M * bearer->reach * bearer->reach)
        return;
    float distance_m = sqrtf(square), chance = wd_spray_chance(index, wd_tree_random(*tree));
    if (chance >= wd_spray_share(distance_m, bearer->reach))
        return;
    float size_m = wd_leaf_size_m(*leaf, box), reach = 2 * size_m * fmaxf(pose->across, pose->up), min[3], max[3];
    for (int k = 0; k < 3; k++) {
        min[k] = at[k] - reach;
        max[k] = at[k] + reach;
    }
    if (wd_frustum_box(&draw->view->frustum, min, max) == WD_OUTSIDE)
        return;
    int detail = detail_of(draw, bearer, size_m * pose->across, distance_m, chance);
    struct twigs *twigs = &gather->twigs[detail];
    if (gather->weigh)
        *wd_push(gather->candidates, gather->candidate_count, gather->candidate_capacity) =
            (struct candidate){distance_m, bearer->reach, chance,
                               twig_mesh(bearer->range, detail)->index_count / bearer->range->forms / 3};
    else
        *wd_push(twigs->items, twigs->count, twigs->capacity) = (struct wd_spray_instance){bearer->index, index};
}

static void gather_tree(struct gather *gather, const struct wd_tree_draw *draw, uint32_t model,
                        uint32_t tree_index)
{
    const struct wd_forest_device *forest = draw->forest;
    const struct wd_tree *tree = &forest->world->trees[tree_index];
    const struct wd_twig_range *range = &forest->meshes.twigs[model];
    const struct bearer bearer = {.index = tree_index,
                                  .range = range,
                                  .reach = gather->scale * range->reach,
                                  .stand = wd_stand_of(draw, tree_index)};
    const float *foot = bearer.stand.foot;
    float reach = WD_TREE_CROWN_M(*tree) + WD_SPRAY_NONE_M * bearer.reach;
    if (foot[0] * foot[0] + foot[1] * foot[1] > reach * reach)
        return;
    uint32_t leaves = forest->meshes.ranges[model][WD_LEVEL_MESH].sets[WD_SET_LEAVES].leaf_count;
    for (uint32_t i = 0; i < leaves; i++)
        gather_leaf(gather, draw, &bearer, &forest->meshes.host_leaves[range->first_leaf + i], i);
}

/* Puts the gathered in order of their forms, of which `counts` get how many there are. */
static void deal_forms(struct wd_spray_instance *to, uint32_t counts[WD_LEAF_FORMS], const struct wd_tree_draw *draw,
                       const struct wd_twig_range *range, const struct twigs *twigs)
{
    const struct wd_tree_leaf *leaves = draw->forest->meshes.host_leaves + range->first_leaf;
    for (uint32_t form = 0; form < range->forms; form++) {
        counts[form] = 0;
        for (size_t i = 0; i < twigs->count; i++)
            if (WD_LEAF_FORM(leaves[twigs->items[i].leaf]) % range->forms == form) {
                *to++ = twigs->items[i];
                counts[form]++;
            }
    }
}

static void draw_twigs(const struct wd_tree_draw *draw, const struct wd_twig_range *range,
                       const struct wd_mesh_range *mesh, const struct twigs *twigs)
{
    const struct wd_forest_device *forest = draw->forest;
    struct wd_binding instances;
    void *memory = wd_cmd_upload(draw->cmd, twigs->count * sizeof *twigs->items, &instances);
    if (!memory)
        return;
    uint32_t counts[WD_LEAF_FORMS];
    deal_forms(memory, counts, draw, range, twigs);
    const struct wd_binding bindings[] = {
        draw->uniforms,
        WD_BIND_BUFFER(&forest->trees),
        WD_BIND_BUFFER(&forest->models),
        {.buffer = &forest->meshes.vertices,
         .offset = (VkDeviceSize)mesh->first_vertex * sizeof(struct wd_packed_vertex),
         .size = (VkDeviceSize)mesh->vertex_count * sizeof(struct wd_packed_vertex)},
        instances,
        WD_BIND_IMAGE(&forest->looks, forest->look_sampler),
        WD_BIND_IMAGE(&forest->look_details, forest->look_sampler),
        {.buffer = &forest->meshes.leaves,
         .offset = (VkDeviceSize)range->first_leaf * sizeof(struct wd_tree_leaf),
         .size = (VkDeviceSize)range->leaf_count * sizeof(struct wd_tree_leaf)}};
    const struct wd_spray_push push = {
        .tree = {.variants = forest->variants, .cascade = draw->view->cascade, .level = WD_LEVEL_MESH},
        .leaves = range->box,
        .twig = mesh->box,
    };
    const struct wd_pipeline *pipeline = &draw->pipelines->spray[draw->pass];
    wd_cmd_bind(draw->cmd, pipeline, bindings);
    wd_cmd_push(draw->cmd, pipeline, &push, sizeof push);
    wd_cmd_bind_indices_of(draw->cmd, &forest->meshes.indices, mesh->index_type);
    uint32_t indices = mesh->index_count / range->forms;
    for (uint32_t form = 0, first = 0; form < range->forms; first += counts[form++]) {
        if (!counts[form])
            continue;
        wd_cmd_draw_indexed(draw->cmd, &(VkDrawIndexedIndirectCommand){indices, counts[form],
                                                                       mesh->first_index + form * indices, 0, first});
        draw->stats->draw_calls++;
    }
    draw->stats->triangles += (uint64_t)indices / 3 * twigs->count;
}

static bool has_sprays(const struct wd_tree_draw *draw, const struct wd_mesh_batch *batch)
{
    return batch->level == WD_LEVEL_MESH && batch->leaf_step == 0 &&
           draw->forest->meshes.twigs[batch->model].mesh.index_count > 0;
}

static void gather_batch(struct gather *gather, const struct wd_tree_draw *draw,
                         const struct wd_selection *selection, const struct wd_mesh_batch *batch)
{
    for (int detail = 0; detail < DETAILS; detail++)
        gather->twigs[detail].count = 0;
    for (uint32_t k = 0; k < batch->count && has_sprays(draw, batch); k++)
        gather_tree(gather, draw, batch->model, selection->meshes[batch->first + k].tree);
}

static uint64_t triangles_at(const struct gather *gather, float scale)
{
    uint64_t sum = 0;
    for (size_t i = 0; i < gather->candidate_count; i++) {
        const struct candidate *leaf = &gather->candidates[i];
        if (leaf->chance < wd_spray_share(leaf->distance_m, scale * leaf->reach))
            sum += leaf->triangles;
    }
    return sum;
}

/* Of pictures of fewer than WD_FINE_SAMPLES: a stroll past a spruce would take 1.14 times as long with all. */
static const float ROUGH_REACH = 0.58f;

float wd_spray_scale(const struct wd_tree_draw *draw, const struct wd_selection *selection)
{
    float most = draw->view->samples < WD_FINE_SAMPLES ? ROUGH_REACH : 1, scale = 1;
    struct gather gather = {.scale = most, .weigh = true};
    for (size_t i = 0; i < selection->batch_count; i++)
        gather_batch(&gather, draw, selection, &selection->batches[i]);
    if (triangles_at(&gather, 1) > WD_SPRAY_BUDGET) {
        scale = 0;
        for (float step = 0.5f; step > 1e-4f; step *= 0.5f)
            if (triangles_at(&gather, scale + step) <= WD_SPRAY_BUDGET)
                scale += step;
    }
    free(gather.candidates);
    return most * scale;
}

void wd_spray_draw(const struct wd_tree_draw *draw, const struct wd_selection *selection,
                   float scale)
{
    struct gather gather = {.scale = scale};
    for (size_t i = 0; i < selection->batch_count; i++) {
        const struct wd_mesh_batch *batch = &selection->batches[i];
        gather_batch(&gather, draw, selection, batch);
        const struct wd_twig_range *range = &draw->forest->meshes.twigs[batch->model];
        for (int detail = 0; detail < DETAILS; detail++)
            if (gather.twigs[detail].count)
                draw_twigs(draw, range, twig_mesh(range, detail), &gather.twigs[detail]);
    }
    for (int detail = 0; detail < DETAILS; detail++)
        free(gather.twigs[detail].items);
}
