/* Static geometry in octree order (Guerrero 2006, section 3; row G5): the cards of all trees lie in
 * one soup ordered depth-first, so that any octant is one range and neighbours merge. The soup is
 * not stored: compute makes the cards of the ranges that a view shows (card_soup.h).
 *
 * Octants are visited from near to far, and none with more than `sorted_trees` is drawn as one range:
 * what is hidden then fails the depth test before it is shaded. */
#include "methods/card_soup.h"
#include "methods/method.h"

#include <math.h>

enum { MAX_CHILDREN = 8 };

struct traversal {
    const struct wd_tree_draw *draw;
    struct wd_selection *selection;
    struct wd_level_rule rule;
    float card_distance_m;
    uint32_t max_cull_depth, sorted_trees;
};

static void add_single(const struct traversal *t, uint32_t begin, uint32_t end)
{
    for (uint32_t i = begin; i < end; i++)
        wd_selection_add_tree(t->selection, t->draw->forest, t->draw->view, &t->rule, i);
}

static void visit(const struct traversal *t, uint32_t index);

static void relative_box(const struct traversal *t, const struct wd_octant *octant, float min[3],
                         float max[3])
{
    for (int k = 0; k < 3; k++) {
        min[k] = (float)((double)octant->min_m[k] - t->draw->view->eye_m[k]);
        max[k] = (float)((double)octant->max_m[k] - t->draw->view->eye_m[k]);
    }
}

/* Less is drawn sooner: distance from the eye, or from the sun for a cascade. */
static float sort_key(const struct traversal *t, const float min[3], const float max[3])
{
    if (t->draw->pass == WD_PASS_CAMERA)
        return wd_box_distance(min, max);
    float depth = 0.0f; /* reversed: greatest nearest the sun */
    for (int k = 0; k < 3; k++) {
        float rise = t->draw->view->clip_from_rel[k][2];
        depth += rise * (rise > 0.0f ? max[k] : min[k]);
    }
    return -depth;
}

/* Nearest first, by insertion: there are at most eight. */
static void visit_children(const struct traversal *t, const struct wd_octant *octant)
{
    const struct wd_octant *octants = t->draw->forest->world->octree.octants;
    uint32_t order[MAX_CHILDREN], child = octant->first_child;
    float keys[MAX_CHILDREN];
    for (uint32_t i = 0; i < octant->child_count; i++) {
        float min[3], max[3];
        relative_box(t, &octants[child], min, max);
        float own = sort_key(t, min, max);
        uint32_t at = i;
        for (; at > 0 && keys[at - 1] > own; at--) {
            order[at] = order[at - 1];
            keys[at] = keys[at - 1];
        }
        order[at] = child;
        keys[at] = own;
        child = octants[child].next_sibling;
    }
    for (uint32_t i = 0; i < octant->child_count; i++)
        visit(t, order[i]);
}

/* Whether every tree in the box is seen so level that its level card shows nothing. */
static uint32_t card_vertices(const float min[3], const float max[3])
{
    float squared = 0.0f, height = fmaxf(fabsf(min[2]), fabsf(max[2]));
    for (int k = 0; k < 2; k++) {
        float outside = fmaxf(fmaxf(min[k], -max[k]), 0.0f);
        squared += outside * outside;
    }
    return height < (float)WD_LEVEL_CARD_SINE * sqrtf(squared) ? WD_UPRIGHT_VERTICES
                                                               : WD_CARD_VERTICES;
}

static void visit(const struct traversal *t, uint32_t index)
{
    const struct wd_octant *octant = &t->draw->forest->world->octree.octants[index];
    const struct wd_view *view = t->draw->view;
    float min[3], max[3];
    relative_box(t, octant, min, max);
    enum wd_side side = wd_frustum_box(&view->frustum, min, max);
    if (side == WD_OUTSIDE)
        return;
    if (wd_box_distance(min, max) < t->card_distance_m) {
        add_single(t, octant->begin, octant->own_end);
        visit_children(t, octant);
    } else if (octant->child_count && ((side == WD_PARTLY && octant->depth < t->max_cull_depth) ||
                                       octant->end - octant->begin > t->sorted_trees)) {
        wd_selection_add_range(t->selection, &(struct wd_range){octant->begin, octant->own_end,
                                                                card_vertices(min, max)});
        visit_children(t, octant);
    } else {
        wd_selection_add_range(
            t->selection, &(struct wd_range){octant->begin, octant->end, card_vertices(min, max)});
    }
}

struct octree_state {
    struct wd_selection selection;
    struct wd_card_soup soup;
};

static bool octree_init(void *state, struct wd_gpu *gpu)
{
    struct octree_state *octree = state;
    return wd_card_soup_init(&octree->soup, gpu);
}

static void octree_finish(void *state, struct wd_gpu *gpu)
{
    struct octree_state *octree = state;
    wd_selection_finish(&octree->selection);
    wd_card_soup_finish(&octree->soup, gpu);
}

static void octree_select(void *state, const struct wd_tree_draw *draw)
{
    struct octree_state *octree = state;
    const struct wd_forest_device *forest = draw->forest;
    const struct wd_octree_options *options = &forest->scene->methods.octree;
    struct traversal traversal = {
        .draw = draw,
        .selection = &octree->selection,
        .rule = wd_level_rule_of(forest, draw->view, draw->pass),
        .max_cull_depth = (uint32_t)options->max_cull_depth,
        .sorted_trees = options->sorted_trees ? (uint32_t)options->sorted_trees : UINT32_MAX,
    };
    traversal.rule.parallel = options->faithful;
    traversal.card_distance_m = wd_level_card_distance(&traversal.rule, forest->max_tree_height_m);
    wd_selection_clear(&octree->selection);
    if (forest->world->octree.count)
        visit(&traversal, 0);
    wd_card_soup_make(&octree->soup, draw, &octree->selection);
}

static void octree_draw(void *state, const struct wd_tree_draw *draw)
{
    struct octree_state *octree = state;
    wd_card_soup_draw(&octree->soup, draw);
    wd_tree_draw_selection(draw, &octree->selection, WD_DRAW_GROUPED);
}

const struct wd_method wd_method_octree = {
    .name = "octree",
    .cards = true,
    .ground = WD_GROUND_LAST,
    .state_size = sizeof(struct octree_state),
    .init = octree_init,
    .finish = octree_finish,
    .select = octree_select,
    .draw = octree_draw,
};
