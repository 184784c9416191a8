#include "frame/nearest.h"

#include <math.h>

struct search {
    const struct wd_forest_device *forest;
    const struct wd_view *view;
    float nearest_m;
};

/* Distance to a box of the local frame if the view may see it, else more than any found so far. */
static float seen_distance(const struct search *search, const double min_m[3], const double max_m[3])
{
    float min[3], max[3], squared = 0.0f;
    for (int k = 0; k < 3; k++) {
        min[k] = (float)(min_m[k] - search->view->eye_m[k]);
        max[k] = (float)(max_m[k] - search->view->eye_m[k]);
        float outside = fmaxf(fmaxf(min[k], -max[k]), 0.0f);
        squared += outside * outside;
    }
    float distance = sqrtf(squared);
    if (distance >= search->nearest_m ||
        wd_frustum_box(&search->view->frustum, min, max) == WD_OUTSIDE)
        return INFINITY;
    return distance;
}

static void search_trees(struct search *search, uint32_t index)
{
    const struct wd_octant *octants = search->forest->world->octree.octants;
    const struct wd_octant *octant = &octants[index];
    double min_m[3], max_m[3];
    for (int k = 0; k < 3; k++) {
        min_m[k] = octant->min_m[k];
        max_m[k] = octant->max_m[k];
    }
    float distance = seen_distance(search, min_m, max_m);
    if (distance >= search->nearest_m)
        return;
    if (octant->own_end > octant->begin || octant->child_count == 0)
        search->nearest_m = distance;
    uint32_t child = octant->first_child;
    for (uint32_t i = 0; i < octant->child_count; i++) {
        search_trees(search, child);
        child = octants[child].next_sibling;
    }
}

static void search_ground(struct search *search, uint32_t level, uint32_t column, uint32_t row)
{
    const struct wd_ground *ground = &search->forest->ground;
    const struct wd_ground_level *patches = &ground->levels[level];
    if (column >= patches->columns || row >= patches->rows)
        return;
    const struct wd_height_range *range = &patches->ranges[(size_t)row * patches->columns + column];
    double side = (double)(WD_PATCH_CELLS << level) * ground->terrain->cell_m;
    const double min_m[3] = {column * side, row * side, range->min_m};
    double top_m = (double)range->max_m +
                   (search->forest->world->demand.count ? search->forest->max_tree_height_m : 0.0f);
    const double max_m[3] = {min_m[0] + side, min_m[1] + side, top_m};
    float distance = seen_distance(search, min_m, max_m);
    if (distance >= search->nearest_m)
        return;
    if (level == 0) {
        search->nearest_m = distance;
        return;
    }
    for (uint32_t i = 0; i < 4; i++)
        search_ground(search, level - 1, 2 * column + (i & 1), 2 * row + (i >> 1));
}

float wd_nearest_seen(const struct wd_forest_device *forest, const struct wd_view *view)
{
    struct search search = {forest, view, 1e9f};
    if (forest->ground.level_count)
        search_ground(&search, forest->ground.level_count - 1, 0, 0);
    if (forest->world->octree.count)
        search_trees(&search, 0);
    return search.nearest_m;
}
