#include "methods/selection.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Quality distances are meant for a tree of this height. */
static const float REFERENCE_HEIGHT_M = 20.0f;
/* Cascades from these on take reduced meshes at most, then cards only. With reduced ones in the second, too, trees
 * at noon are 4 % brighter in green from within. */
enum { REDUCED_CASCADE = 2, CARD_CASCADE = 3 };

struct wd_level_rule wd_level_rule_of(const struct wd_forest_device *forest,
                                      const struct wd_view *view, enum wd_tree_pass pass)
{
    const struct wd_scene *scene = forest->scene;
    struct wd_level_rule rule = {
        .mesh_m = (float)scene->quality.mesh_distance_m * view->lod_scale,
        .reduced_m = (float)scene->quality.reduced_distance_m * view->lod_scale,
        .blend = (float)scene->quality.blend,
        .finest = WD_LEVEL_MESH,
        .pass = pass,
    };
    bool specimens = scene->individuals != NULL; /* few: whole shadows at any distance */
    if (pass == WD_PASS_CAMERA || view->cascade < REDUCED_CASCADE || specimens) {
        for (size_t i = 0; i < scene->layer_count; i++)
            rule.farthest_m =
                fmaxf(rule.farthest_m, (float)scene->layers[i].mesh_distance_m * view->lod_scale);
        return rule;
    }
    rule.finest = view->cascade < CARD_CASCADE ? WD_LEVEL_REDUCED : WD_LEVEL_CARD;
    rule.reduced_m = rule.finest == WD_LEVEL_CARD ? 0.0f : rule.mesh_m;
    rule.mesh_m = 0.0f;
    return rule;
}

float wd_leaf_pixels(const struct wd_forest_device *forest, const struct wd_view *view,
                     enum wd_tree_pass pass)
{
    float samples = (float)(view->samples ? view->samples : 1);
    float least_px = fmaxf((float)forest->scene->quality.leaf_px / sqrtf(samples), 1e-6f);
    return (pass == WD_PASS_SHADOW ? 0.55f : 1) * view->pixels_per_radian *
           (WD_LEAF_WHOLE_PX / least_px);
}

/* Of leaves in a shadow map: with 8 an understory's FLIP is 0.003 less, with 1 0.003 more. */
static const float TRIANGLES_A_TEXEL = 2.0f;

float wd_leaf_most(const struct wd_forest_device *forest, const struct wd_view *view,
                   enum wd_tree_pass pass, uint32_t model, uint32_t level)
{
    const struct wd_mesh_range *range = &forest->meshes.ranges[model][level];
    const struct wd_leaf_draw *leaves = &range->sets[WD_SET_LEAVES];
    const float *seen_m2 = forest->host_models[model].seen_m2;
    float triangles = (float)leaves->leaf_count * (float)leaves->index_count / 3.0f;
    if (pass == WD_PASS_CAMERA || view->box.radius <= 0.0 || triangles <= 0.0f)
        return INFINITY;
    float texel_m = 2.0f * (float)view->box.radius / (float)view->width;
    float covered_m2 =
        wd_seen_m2(seen_m2[0], seen_m2[1], seen_m2[2], fmaxf((float)view->box.toward[2], 0.0f));
    return TRIANGLES_A_TEXEL * covered_m2 / (texel_m * texel_m * triangles);
}

/* Shares of a nearer and a farther level about the distance where they change. */
static void blend_levels(const struct wd_level_rule *rule, float from_m, float distance_m,
                         float *nearer, float *farther)
{
    float t = wd_ramp(from_m, from_m * (1.0f + rule->blend), distance_m);
    if (rule->parallel) {
        *farther = t;
        *nearer = 1.0f - t;
        return;
    }
    *farther = fminf(2.0f * t, 1.0f);
    *nearer = fminf(2.0f - 2.0f * t, 1.0f);
}

struct wd_levels wd_levels_at(const struct wd_level_rule *rule, float height_m, float distance_m)
{
    struct wd_levels levels;
    float scale = rule->plain ? 1.0f : height_m / REFERENCE_HEIGHT_M, not_mesh, meshes;
    blend_levels(rule, rule->mesh_m * scale, distance_m, &levels.show[WD_LEVEL_MESH], &not_mesh);
    blend_levels(rule, fmaxf(rule->reduced_m, rule->mesh_m) * scale, distance_m, &meshes,
                 &levels.show[WD_LEVEL_CARD]);
    levels.show[WD_LEVEL_REDUCED] = fminf(not_mesh, meshes);
    if (rule->finest > WD_LEVEL_MESH)
        levels.show[WD_LEVEL_MESH] = 0.0f;
    if (rule->finest > WD_LEVEL_REDUCED)
        levels = (struct wd_levels){{0.0f, 0.0f, 1.0f}};
    return levels;
}

float wd_level_card_distance(const struct wd_level_rule *rule, float height_m)
{
    if (rule->finest == WD_LEVEL_CARD)
        return 0.0f;
    float meshes_m = fmaxf(rule->reduced_m, rule->mesh_m);
    if (rule->plain)
        return meshes_m * (1.0f + rule->blend);
    meshes_m *= height_m / REFERENCE_HEIGHT_M;
    return fmaxf(meshes_m, rule->farthest_m) * (1.0f + rule->blend);
}

void wd_selection_clear(struct wd_selection *selection)
{
    selection->range_count = selection->card_count = 0;
    selection->mesh_count = selection->batch_count = 0;
}

void wd_selection_finish(struct wd_selection *selection)
{
    free(selection->ranges);
    free(selection->cards);
    free(selection->meshes);
    free(selection->mesh_keys);
    free(selection->batches);
    *selection = (struct wd_selection){0};
}

void wd_selection_add_range(struct wd_selection *selection, const struct wd_range *range)
{
    if (range->begin == range->end)
        return;
    struct wd_range *last =
        selection->range_count ? &selection->ranges[selection->range_count - 1] : NULL;
    if (last && last->end == range->begin && last->card_vertices == range->card_vertices)
        last->end = range->end;
    else
        *wd_push(selection->ranges, selection->range_count, selection->range_capacity) = *range;
}

void wd_selection_add_mesh(struct wd_selection *selection, const struct wd_mesh_choice *choice,
                           uint32_t tree, float show)
{
    selection->mesh_keys = wd_grow(selection->mesh_keys, selection->mesh_count,
                                   &selection->key_capacity, sizeof *selection->mesh_keys);
    selection->mesh_keys[selection->mesh_count] =
        (choice->model * 2 + choice->level) * WD_LEAF_STEPS + choice->leaf_step;
    *wd_push(selection->meshes, selection->mesh_count, selection->mesh_capacity) =
        (struct wd_instance){tree, show};
}

struct tree_box {
    float min[3], max[3];
};

static struct tree_box box_of(const struct wd_tree *tree, const float foot[3])
{
    float height = WD_TREE_HEIGHT_M(*tree), reach = WD_TREE_REACH_M(WD_TREE_CROWN_M(*tree), height);
    return (struct tree_box){
        {foot[0] - reach, foot[1] - reach, foot[2] - WD_TREE_BELOW_M},
        {foot[0] + reach, foot[1] + reach, foot[2] + WD_TREE_ABOVE_M(height)},
    };
}

static enum wd_side tree_side(const struct wd_view *view, const struct wd_tree *tree,
                              const float foot[3])
{
    struct tree_box box = box_of(tree, foot);
    return wd_frustum_box(&view->frustum, box.min, box.max);
}

/* How far the leaves of a tree's mesh thin out, seen from the place of its box that is nearest. */
static uint32_t leaf_step(const struct wd_forest_device *forest, const struct wd_view *view,
                          enum wd_tree_pass pass, const struct wd_mesh_choice *choice,
                          uint32_t index, const float foot[3])
{
    const struct wd_tree *tree = &forest->world->trees[index];
    const struct wd_mesh_range *range = &forest->meshes.ranges[choice->model][choice->level];
    const struct wd_model *model = &forest->host_models[choice->model];
    struct tree_box box = box_of(tree, foot);
    float squared = 0;
    for (int k = 0; k < 3; k++) {
        float outside = fmaxf(fmaxf(box.min[k], -box.max[k]), 0);
        squared += outside * outside;
    }
    float across = WD_TREE_CROWN_M(*tree) / model->crown_m, far_m = fmaxf(sqrtf(squared), 0.01f);
    float share =
        wd_leaf_stand(range->leaf_m * across * wd_leaf_pixels(forest, view, pass) / far_m,
                      wd_leaf_most(forest, view, pass, choice->model, choice->level), across);
    uint32_t step = 0;
    for (; range->leaf_count && step < WD_LEAF_STEPS - 1 && share <= 0.5f; step++)
        share *= 2;
    return step;
}

static void foot_of(const struct wd_view *view, const struct wd_tree *tree, float foot[3])
{
    const int32_t place_mm[3] = {tree->x_mm, tree->y_mm, tree->z_mm};
    for (int k = 0; k < 3; k++)
        foot[k] = (float)(place_mm[k] * 0.001 - view->eye_m[k]);
}

bool wd_tree_in_view(const struct wd_view *view, const struct wd_tree *tree)
{
    float foot[3];
    foot_of(view, tree, foot);
    return tree_side(view, tree, foot) != WD_OUTSIDE;
}

void wd_selection_add_tree(struct wd_selection *selection, const struct wd_forest_device *forest,
                           const struct wd_view *view, const struct wd_level_rule *rule,
                           uint32_t index)
{
    const struct wd_tree *tree = &forest->world->trees[index];
    float foot[3], distance_squared = 0.0f;
    foot_of(view, tree, foot);
    for (int k = 0; k < 3; k++)
        distance_squared += foot[k] * foot[k];
    if (tree_side(view, tree, foot) == WD_OUTSIDE)
        return;
    float distance_m = sqrtf(distance_squared), height_m = WD_TREE_HEIGHT_M(*tree);
    uint32_t layer = wd_forest_fade_of(forest, index);
    float fade = wd_layer_show(forest->host_fades[layer], distance_m);
    struct wd_level_rule own = *rule;
    if (layer && forest->scene->layers[layer - 1].mesh_distance_m > 0.0 &&
        rule->finest == WD_LEVEL_MESH && !rule->plain)
        own.mesh_m = (float)forest->scene->layers[layer - 1].mesh_distance_m * view->lod_scale *
                     REFERENCE_HEIGHT_M / fmaxf(height_m, 0.01f);
    struct wd_levels levels = wd_levels_at(&own, height_m, distance_m);
    uint32_t model = wd_forest_model_of(forest, tree);
    for (uint32_t level = WD_LEVEL_MESH; level <= WD_LEVEL_REDUCED; level++) {
        if (levels.show[level] * fade > 0.0f) {
            struct wd_mesh_choice choice = {model, level, 0};
            choice.leaf_step = leaf_step(forest, view, rule->pass, &choice, index, foot);
            wd_selection_add_mesh(selection, &choice, index, levels.show[level] * fade);
        }
    }
    /* the card's shader applies the fade itself: ranges need it too */
    if (levels.show[WD_LEVEL_CARD] * fade > 0.0f)
        *wd_push(selection->cards, selection->card_count, selection->card_capacity) =
            (struct wd_instance){index, levels.show[WD_LEVEL_CARD]};
}

void wd_selection_sort(struct wd_selection *selection, uint32_t model_count)
{
    size_t keys = (size_t)model_count * 2 * WD_LEAF_STEPS, count = selection->mesh_count;
    if (count == 0)
        return;
    uint32_t *first = wd_alloc_array(keys + 1, sizeof *first);
    struct wd_instance *sorted = wd_alloc_array(count, sizeof *sorted);
    for (size_t i = 0; i < count; i++)
        first[selection->mesh_keys[i] + 1]++;
    for (size_t key = 0; key < keys; key++) {
        if (first[key + 1])
            *wd_push(selection->batches, selection->batch_count, selection->batch_capacity) =
                (struct wd_mesh_batch){(uint32_t)key / WD_LEAF_STEPS / 2, key / WD_LEAF_STEPS % 2,
                                       key % WD_LEAF_STEPS, first[key], first[key + 1]};
        first[key + 1] += first[key];
    }
    for (size_t i = 0; i < count; i++)
        sorted[first[selection->mesh_keys[i]]++] = selection->meshes[i];
    memcpy(selection->meshes, sorted, count * sizeof *sorted);
    free(first);
    free(sorted);
}
