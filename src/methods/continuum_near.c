#include "methods/continuum_near.h"

#include <math.h>

#include "shared/continuum.h"
#include "shared/hash.h"

struct search {
    struct wd_selection *found;
    const struct wd_tree_draw *draw;
    struct wd_near_rule rule;
};

static void add_tree(const struct search *search, uint32_t index)
{
    const struct wd_forest_device *forest = search->draw->forest;
    const struct wd_view *view = search->draw->view;
    const struct wd_tree *tree = &forest->world->trees[index];
    uint32_t model = wd_forest_model_of(forest, tree);
    struct wd_vec3 foot = {(float)(tree->x_mm * 0.001 - view->eye_m[0]),
                           (float)(tree->y_mm * 0.001 - view->eye_m[1]),
                           (float)(tree->z_mm * 0.001 - view->eye_m[2])};
    float distance_m = wd_near_distance_m(*tree, forest->host_models[model].crown_base_m /
                                                     forest->host_models[model].height_m, foot);
    const struct wd_near_rule *rule = &search->rule;
    float near_m = wd_near_reach_m(*tree, rule->grains[model], rule->leaves_m, rule->reach);
    float show = near_m > 0.0f ? wd_near_mesh(distance_m, near_m) : 0.0f;
    if (show <= 0.0f)
        return;
    const struct wd_layer_fade fade = forest->host_fades[wd_forest_fade_of(forest, index)];
    float foot_m = sqrtf(foot.x * foot.x + foot.y * foot.y + foot.z * foot.z);
    if (wd_hash_unit(wd_tree_random(*tree)) < wd_layer_show(fade, foot_m) &&
        wd_tree_in_view(view, tree))
        wd_selection_add_mesh(search->found, &(struct wd_mesh_choice){model, WD_LEVEL_MESH, 0},
                              index, show);
}

static void visit(const struct search *search, uint32_t index)
{
    const struct wd_octant *octants = search->draw->forest->world->octree.octants;
    const struct wd_octant *octant = &octants[index];
    float min[3], max[3];
    for (int k = 0; k < 3; k++) {
        min[k] = (float)((double)octant->min_m[k] - search->draw->view->eye_m[k]);
        max[k] = (float)((double)octant->max_m[k] - search->draw->view->eye_m[k]);
    }
    if (wd_box_distance(min, max) > search->rule.farthest_m * WD_NEAR_REACH)
        return;
    for (uint32_t i = octant->begin; i < octant->own_end; i++)
        add_tree(search, i);
    uint32_t child = octant->first_child;
    for (uint32_t i = 0; i < octant->child_count; i++, child = octants[child].next_sibling)
        visit(search, child);
}

void wd_near_trees_select(struct wd_selection *near, const struct wd_tree_draw *draw,
                          const struct wd_near_rule *rule)
{
    const struct search search = {near, draw, *rule};
    wd_selection_clear(near);
    if (rule->farthest_m > 0.0f && draw->forest->world->octree.count)
        visit(&search, 0);
}
