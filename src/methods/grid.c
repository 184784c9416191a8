/* A fixed grid of tree groups: the other baseline of Guerrero 2006 (section 3; row G9). Billboards
 * of a cell are one draw; cells that meshes reach are drawn tree by tree, those out of sight not at
 * all. Whatever the size of a cell, it is too large near the eye and too small far off. */
#include "methods/method.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "methods/cells.h"

struct grid {
    struct wd_cells cells;
    struct wd_buffer list; /* struct wd_instance of every tree, by cells */
    struct wd_selection selection; /* trees by themselves */
    struct wd_range *ranges;       /* of the list, one a cell */
    size_t range_count, range_capacity;
    struct near_cell {
        float distance_m;
        uint32_t cell;
    } *seen;
    size_t seen_count, seen_capacity;
};

static bool grid_use_forest(void *state, struct wd_gpu *gpu, struct wd_forest_device *forest)
{
    struct grid *grid = state;
    const struct wd_world *world = forest->world;
    double trees = (double)forest->scene->methods.grid.trees_per_cell;
    if (!world->tree_count)
        return true;
    wd_cells_init(&grid->cells, world, wd_cells_size(world, trees));
    const struct wd_buffer_params params = {"grid cells",
                                            world->tree_count * sizeof(struct wd_instance),
                                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, WD_MEMORY_DEVICE};
    struct wd_instance *list = wd_alloc_array(world->tree_count, sizeof *list);
    for (size_t i = 0; i < world->tree_count; i++)
        list[i] = (struct wd_instance){grid->cells.trees[i], 1.0f};
    bool ok = wd_buffer_init(&grid->list, gpu, &params) &&
              wd_buffer_upload(gpu, &grid->list, 0, list, params.size);
    free(list);
    return ok;
}

static void grid_drop_forest(void *state, struct wd_gpu *gpu)
{
    struct grid *grid = state;
    wd_cells_finish(&grid->cells);
    wd_buffer_finish(&grid->list, gpu);
    wd_selection_finish(&grid->selection);
    free(grid->seen);
    free(grid->ranges);
    *grid = (struct grid){0};
}

static int nearer_first(const void *a, const void *b)
{
    const struct near_cell *one = a, *other = b;
    if (one->distance_m != other->distance_m)
        return one->distance_m < other->distance_m ? -1 : 1;
    return one->cell < other->cell ? -1 : 1;
}

/* Cells in view, nearest first. */
static void find_cells(struct grid *grid, const struct wd_view *view)
{
    size_t count = (size_t)grid->cells.columns * grid->cells.rows;
    grid->seen_count = 0;
    for (size_t i = 0; i < count; i++) {
        const struct wd_cell_box *box = &grid->cells.boxes[i];
        if (grid->cells.first[i] == grid->cells.first[i + 1])
            continue;
        float min[3], max[3], squared = 0.0f;
        for (int k = 0; k < 3; k++) {
            min[k] = (float)((double)box->min_m[k] - view->eye_m[k]);
            max[k] = (float)((double)box->max_m[k] - view->eye_m[k]);
            float outside = fmaxf(fmaxf(min[k], -max[k]), 0.0f);
            squared += outside * outside;
        }
        if (wd_frustum_box(&view->frustum, min, max) != WD_OUTSIDE)
            *wd_push(grid->seen, grid->seen_count, grid->seen_capacity) =
                (struct near_cell){sqrtf(squared), (uint32_t)i};
    }
    qsort(grid->seen, grid->seen_count, sizeof *grid->seen, nearer_first);
}

static void grid_select(void *state, const struct wd_tree_draw *draw)
{
    struct grid *grid = state;
    const struct wd_level_rule rule = wd_level_rule_of(draw->forest, draw->view, draw->pass);
    float cards_m = wd_level_card_distance(&rule, draw->forest->max_tree_height_m);
    wd_selection_clear(&grid->selection);
    grid->range_count = 0;
    find_cells(grid, draw->view);
    for (size_t i = 0; i < grid->seen_count; i++) {
        uint32_t cell = grid->seen[i].cell;
        struct wd_range range = {grid->cells.first[cell], grid->cells.first[cell + 1],
                                 WD_CARD_VERTICES};
        if (grid->seen[i].distance_m >= cards_m) {
            *wd_push(grid->ranges, grid->range_count, grid->range_capacity) = range;
            continue;
        }
        for (uint32_t k = range.begin; k < range.end; k++)
            wd_selection_add_tree(&grid->selection, draw->forest, draw->view, &rule,
                                  grid->cells.trees[k]);
    }
}

static void grid_draw(void *state, const struct wd_tree_draw *draw)
{
    struct grid *grid = state;
    wd_tree_draw_selection(draw, &grid->selection, WD_DRAW_GROUPED);
    wd_tree_draw_card_ranges(draw, grid->ranges, grid->range_count, &grid->list);
}

const struct wd_method wd_method_grid = {
    .name = "grid",
    .state_size = sizeof(struct grid),
    .use_forest = grid_use_forest,
    .drop_forest = grid_drop_forest,
    .select = grid_select,
    .draw = grid_draw,
};
