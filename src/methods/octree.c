/* Static geometry in octree order (Guerrero 2006, section 3; row G5): the cards of all trees lie in
 * one soup ordered depth-first, so that any octant is one range and neighbours merge. The soup is
 * not stored: the vertex shader makes vertex i of tree i / 16. */
#include "methods/method.h"

#include <math.h>

struct traversal {
    const struct wd_tree_draw *draw;
    struct wd_selection *selection;
    struct wd_level_rule rule;
    float card_distance_m;
    uint32_t max_cull_depth;
};

static float box_distance(const float min[3], const float max[3])
{
    float squared = 0.0f;
    for (int k = 0; k < 3; k++) {
        float outside = fmaxf(fmaxf(min[k], -max[k]), 0.0f);
        squared += outside * outside;
    }
    return sqrtf(squared);
}

static void add_single(const struct traversal *t, uint32_t begin, uint32_t end)
{
    for (uint32_t i = begin; i < end; i++)
        wd_selection_add_tree(t->selection, t->draw->forest, t->draw->view, &t->rule, i);
}

static void visit(const struct traversal *t, uint32_t index);

static void visit_children(const struct traversal *t, const struct wd_octant *octant)
{
    uint32_t child = octant->first_child;
    for (uint32_t i = 0; i < octant->child_count; i++) {
        visit(t, child);
        child = t->draw->forest->world->octree.octants[child].next_sibling;
    }
}

static void visit(const struct traversal *t, uint32_t index)
{
    const struct wd_octant *octant = &t->draw->forest->world->octree.octants[index];
    const struct wd_view *view = t->draw->view;
    float min[3], max[3];
    for (int k = 0; k < 3; k++) {
        min[k] = (float)((double)octant->min_m[k] - view->eye_m[k]);
        max[k] = (float)((double)octant->max_m[k] - view->eye_m[k]);
    }
    enum wd_side side = wd_frustum_box(&view->frustum, min, max);
    if (side == WD_OUTSIDE)
        return;
    if (box_distance(min, max) < t->card_distance_m) {
        add_single(t, octant->begin, octant->own_end);
        visit_children(t, octant);
    } else if (side == WD_PARTLY && octant->depth < t->max_cull_depth && octant->child_count) {
        wd_selection_add_range(t->selection, octant->begin, octant->own_end);
        visit_children(t, octant);
    } else {
        wd_selection_add_range(t->selection, octant->begin, octant->end);
    }
}

static void octree_record(const struct wd_tree_draw *draw, struct wd_selection *selection)
{
    const struct wd_forest_device *forest = draw->forest;
    struct traversal traversal = {
        .draw = draw,
        .selection = selection,
        .rule = wd_level_rule_of(forest, draw->view, draw->pass),
        .max_cull_depth = (uint32_t)forest->scene->quality.max_cull_depth,
    };
    traversal.card_distance_m = wd_level_card_distance(&traversal.rule, forest->max_tree_height_m);
    wd_selection_clear(selection);
    if (forest->world->octree.count)
        visit(&traversal, 0);
    wd_tree_draw_selection(draw, selection, WD_DRAW_GROUPED);
}

const struct wd_method wd_method_octree = {"octree", octree_record};
