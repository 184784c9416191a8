#include "frame/nearest.h"

#include <math.h>

#include "world/surroundings.h"

struct search {
    const struct wd_forest_device *forest;
    const struct wd_view *view;
    double ray_min[3], ray_max[3]; /* of the view's rays, as long as reaches a metre along its axis */
    float nearest_m;
};

static void find_rays(struct search *search)
{
    const struct wd_view *view = search->view;
    double right[3], forward[3], up[3];
    const struct wd_half_view half = wd_half_view_of(view);
    wd_camera_axes(&view->camera, right, forward, up);
    for (int k = 0; k < 3; k++) {
        double beside = half.width * fabs(right[k]) + half.height * fabs(up[k]);
        search->ray_min[k] = forward[k] - beside;
        search->ray_max[k] = forward[k] + beside;
    }
}

/* Metres along the axis before which no ray of the view comes to a box, whose places are counted from
 * the eye. Through a long lens a box that reaches far to the eye's side is seen far off. */
static double way_to_box(const struct search *search, const float min[3], const float max[3])
{
    double way_m = 0.0;
    for (int k = 0; k < 3; k++) {
        double toward = min[k] > 0.0f ? search->ray_max[k] : -search->ray_min[k];
        double gap_m = fmax(fmax((double)min[k], (double)-max[k]), 0.0);
        if (gap_m > 0.0)
            way_m = fmax(way_m, toward > 0.0 ? gap_m / toward : HUGE_VAL);
    }
    return way_m;
}

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
    float distance = fmaxf(sqrtf(squared), (float)way_to_box(search, min, max));
    if (distance >= search->nearest_m ||
        wd_frustum_box(&search->view->frustum, min, max) == WD_OUTSIDE)
        return INFINITY;
    return distance;
}

static float tree_distance(const struct search *search, const struct wd_tree *tree)
{
    const float height_m = WD_TREE_HEIGHT_M(*tree);
    const double reach_m = (double)WD_TREE_REACH_M(WD_TREE_CROWN_M(*tree), height_m);
    const double foot_m[3] = {0.001 * tree->x_mm, 0.001 * tree->y_mm, 0.001 * tree->z_mm};
    const double min_m[3] = {foot_m[0] - reach_m, foot_m[1] - reach_m, foot_m[2] - (double)WD_TREE_BELOW_M};
    const double max_m[3] = {foot_m[0] + reach_m, foot_m[1] + reach_m, foot_m[2] + (double)WD_TREE_ABOVE_M(height_m)};
    return seen_distance(search, min_m, max_m);
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
    for (uint32_t i = octant->begin; i < octant->own_end; i++)
        search->nearest_m =
            fminf(search->nearest_m, tree_distance(search, &search->forest->world->trees[i]));
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
    struct search search = {.forest = forest, .view = view, .nearest_m = 1e9f};
    find_rays(&search);
    if (forest->ground.level_count)
        search_ground(&search, forest->ground.level_count - 1, 0, 0);
    if (forest->world->octree.count)
        search_trees(&search, 0);
    return search.nearest_m;
}

/* --- the farthest ---------------------------------------------------------------------------- */

/* Rays that fall less than this, metres a metre, are taken to reach the horizon. */
static const double LEAST_FALL = 0.1;
enum { RAYS_A_SIDE = 5, MOST_STEPS = 512 };

/* Metres along `ray` until the ground. */
static double ray_to_ground(const struct wd_terrain *terrain, const double eye_m[3],
                            const double ray[3])
{
    double way_m = 0.0, was_m = 0.0, was_above_m = 0.0;
    for (int i = 0; i < MOST_STEPS; i++) {
        double x_m = eye_m[0] + way_m * ray[0], y_m = eye_m[1] + way_m * ray[1];
        if (!wd_terrain_contains(terrain, x_m, y_m))
            return INFINITY;
        double above_m = eye_m[2] + way_m * ray[2] - (double)wd_terrain_height(terrain, x_m, y_m);
        if (above_m <= 0.0) /* between both places as on a slope */
            return way_m - (way_m - was_m) * above_m / fmin(above_m - was_above_m, -1e-9);
        was_m = way_m;
        was_above_m = above_m;
        way_m += fmax(0.5 * above_m, 0.25 * terrain->cell_m);
    }
    return INFINITY;
}

float wd_farthest_seen(const struct wd_terrain *terrain, const struct wd_view *view)
{
    double right[3], forward[3], up[3], ray[3], farthest_m = 0.0;
    const struct wd_half_view half = wd_half_view_of(view);
    wd_camera_axes(&view->camera, right, forward, up);
    for (int i = 0; i < RAYS_A_SIDE * RAYS_A_SIDE; i++) {
        double x = half.width * (2.0 * (i % RAYS_A_SIDE) / (RAYS_A_SIDE - 1) - 1.0);
        double y = half.height * (1.0 - 2.0 * (i / RAYS_A_SIDE) / (RAYS_A_SIDE - 1));
        for (int k = 0; k < 3; k++)
            ray[k] = forward[k] + x * right[k] + y * up[k];
        if (ray[2] > -LEAST_FALL)
            return INFINITY;
        farthest_m = fmax(farthest_m, ray_to_ground(terrain, view->eye_m, ray));
    }
    return (float)farthest_m;
}
