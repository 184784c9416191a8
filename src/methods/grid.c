/* A fixed grid of tree groups: the other baseline of Guerrero 2006 (section 3; row G9). Billboards
 * of a cell are one draw; cells that meshes reach are drawn tree by tree, those out of sight not at
 * all. Whatever the size of a cell, it is too large near the eye and too small far off. */
#include "methods/method.h"

#include <stdlib.h>

#include "base/memory.h"
#include "methods/cells.h"

struct grid {
    struct wd_cells cells;
    struct wd_buffer list; /* struct wd_instance of every tree, by cells */
    struct wd_selection selection; /* trees by themselves */
    struct wd_range *ranges;       /* of the list, one a cell */
    size_t range_count, range_capacity;
    struct wd_cell_list seen;
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
    wd_cell_list_finish(&grid->seen);
    free(grid->ranges);
    *grid = (struct grid){0};
}

static void grid_select(void *state, const struct wd_tree_draw *draw)
{
    struct grid *grid = state;
    const struct wd_level_rule rule = wd_level_rule_of(draw->forest, draw->view, draw->pass);
    float cards_m = wd_level_card_distance(&rule, draw->forest->max_tree_height_m);
    wd_cmd_use_buffer(draw->cmd, &grid->list, WD_USE_SHADER_READ);
    wd_selection_clear(&grid->selection);
    grid->range_count = 0;
    wd_cell_list_fill(&grid->seen, &grid->cells, draw->view);
    for (size_t i = 0; i < grid->seen.count; i++) {
        uint32_t cell = grid->seen.items[i].cell;
        struct wd_range range = {grid->cells.first[cell], grid->cells.first[cell + 1],
                                 WD_CARD_VERTICES};
        if (grid->seen.items[i].distance_m >= cards_m) {
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
    .cards = true,
    .state_size = sizeof(struct grid),
    .use_forest = grid_use_forest,
    .drop_forest = grid_drop_forest,
    .select = grid_select,
    .draw = grid_draw,
};
