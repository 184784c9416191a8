#include "world/placement.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/jobs.h"
#include "base/memory.h"

void wd_tree_list_add(struct wd_tree_list *list, const struct wd_tree *tree)
{
    if (list->count == list->capacity) {
        list->capacity = list->capacity ? 2 * list->capacity : 1024;
        list->trees = wd_realloc(list->trees, list->capacity * sizeof *list->trees);
    }
    struct wd_tree *added = &list->trees[list->count++];
    *added = *tree;
    added->id = (uint32_t)list->count;
}

static void join(struct wd_tree_list *list, const struct wd_tree_list *part)
{
    size_t count = list->count + part->count;
    if (count > list->capacity) {
        list->capacity = count > 2 * list->capacity ? count : 2 * list->capacity;
        list->trees = wd_realloc(list->trees, list->capacity * sizeof *list->trees);
    }
    for (size_t i = 0; i < part->count; i++) {
        list->trees[list->count] = part->trees[i];
        list->trees[list->count].id = (uint32_t)(list->count + 1);
        list->count++;
    }
}

void wd_tree_list_finish(struct wd_tree_list *list)
{
    free(list->trees);
    *list = (struct wd_tree_list){0};
}

struct wd_axis wd_axis_of(double cell_mm)
{
    int exponent;
    double mantissa = frexp(cell_mm, &exponent); /* [0.5, 1) */
    double inverse = ceil(2147483648.0 / mantissa);
    struct wd_axis axis = {.shift = (uint32_t)(exponent - 1)};
    if (inverse >= 4294967296.0) {
        axis.shift--;
        inverse = 2147483648.0;
    }
    axis.inverse = (uint32_t)inverse;
    return axis;
}

bool wd_ground_input_init(struct wd_ground_input *input, const struct wd_placement_params *params)
{
    const struct wd_terrain *terrain = params->terrain;
    const char *scene = params->scene->path ? params->scene->path : "scene";
    double x_mm = wd_terrain_extent_x_m(terrain) * 1000.0;
    double y_mm = wd_terrain_extent_y_m(terrain) * 1000.0;
    *input = (struct wd_ground_input){0};
    if (!(x_mm < 2e9 && y_mm < 2e9))
        return wd_error(params->log, "%s: terrain: is %.0f x %.0f km; at most 2000 x 2000 km can be planted "
                        "(see size_m and window_m, or what it is fitted to)", scene, x_mm * 1e-6, y_mm * 1e-6);
    if (!(terrain->cell_m >= 0.002))
        return wd_error(params->log, "%s: terrain: has samples %g m apart; at least 0.002 m are needed (see "
                        "cell_m, crs and unit)", scene, terrain->cell_m);
    input->ground = (struct wd_place_ground){
        .extent_mm = {(int32_t)x_mm, (int32_t)y_mm},
        .width = terrain->width,
        .height = terrain->height,
        .axis = wd_axis_of(terrain->cell_m * 1000.0),
        .half_per_m = (float)(0.5 / terrain->cell_m),
        .has_holes = terrain->hole != NULL,
    };
    input->height_m = terrain->height_m;
    input->hole = terrain->hole;
    return true;
}

bool wd_too_many_trees(const struct wd_placement_params *params, const char *what)
{
    return wd_error(params->log,
                    "%s: more than %" PRIu64 " trees in the world; plant fewer (wider spacing, "
                    "lower density, narrower rules) or raise the limit",
                    what, params->max_trees);
}

/* Cells are planted by tiles; trees are joined in the order of tiles, so that order is the same
 * for any number of threads. */
enum { TILES_A_BATCH = 64 };
struct fill {
    const struct wd_place_input *input;
    uint32_t tile_cells; /* along a side */
    uint64_t tile_columns, tile_rows;
    uint64_t first_tile;
    struct wd_tree_list tiles[TILES_A_BATCH];
};

static void plant_cell(const struct wd_place_input *input, uint32_t column, uint32_t row,
                       struct wd_tree_list *list)
{
    struct wd_place_cell cell = wd_place_open_cell(input, column, row);
    uint32_t sub_cell = 0;
    for (uint32_t i = 0; i < cell.count; i++) {
        sub_cell = wd_place_sub_cell(cell, sub_cell, i);
        struct wd_tree tree = wd_place_candidate(input, cell, sub_cell, i);
        if (tree.size != 0)
            wd_tree_list_add(list, &tree);
        sub_cell++;
    }
}

static void plant_tile(void *user, size_t index)
{
    struct fill *fill = user;
    const struct wd_place_layer *layer = &fill->input->layer;
    uint64_t tile = fill->first_tile + index;
    uint32_t column = (uint32_t)(tile % fill->tile_columns) * fill->tile_cells;
    uint32_t row = (uint32_t)(tile / fill->tile_columns) * fill->tile_cells;
    fill->tiles[index].count = 0;
    for (uint32_t j = row; j < row + fill->tile_cells && j < layer->rows; j++)
        for (uint32_t i = column; i < column + fill->tile_cells && i < layer->columns; i++)
            plant_cell(fill->input, i, j, &fill->tiles[index]);
}

static bool fill_batch(struct fill *fill, size_t count, const struct wd_placement *placement,
                       const struct wd_placement_params *params, struct wd_tree_list *list)
{
    wd_jobs_run(params->threads, count, plant_tile, fill);
    for (size_t i = 0; i < count; i++) {
        if (list->count + fill->tiles[i].count > params->max_trees)
            return wd_too_many_trees(params, placement->name);
        join(list, &fill->tiles[i]);
    }
    return true;
}

static bool fill_cells(const struct wd_placement *placement,
                       const struct wd_placement_params *params, struct wd_tree_list *list)
{
    const struct wd_place_layer *layer = &placement->input.layer;
    uint32_t side = layer->count_size > 1 ? 16 : 64;
    struct fill *fill = wd_alloc(sizeof *fill);
    fill->input = &placement->input;
    fill->tile_cells = side;
    fill->tile_columns = ((uint64_t)layer->columns + side - 1) / side;
    fill->tile_rows = ((uint64_t)layer->rows + side - 1) / side;
    uint64_t total = fill->tile_columns * fill->tile_rows;
    bool ok = true;
    while (ok && fill->first_tile < total) {
        uint64_t left = total - fill->first_tile;
        size_t count = left < TILES_A_BATCH ? (size_t)left : TILES_A_BATCH;
        ok = fill_batch(fill, count, placement, params, list);
        fill->first_tile += count;
        ok = ok && wd_progress_report(params->progress, "planting tiles", fill->first_tile, total);
    }
    for (size_t i = 0; i < TILES_A_BATCH; i++)
        wd_tree_list_finish(&fill->tiles[i]);
    free(fill);
    return ok;
}

bool wd_placement_fill(const struct wd_placement *placement,
                       const struct wd_placement_params *params, struct wd_tree_list *list)
{
    if (placement->layer->placement == WD_PLACE_CANOPY)
        return wd_canopy_fill(placement, params, list);
    return fill_cells(placement, params, list);
}
