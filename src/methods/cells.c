#include "methods/cells.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

enum { MAX_CELLS = 1 << 24 };

struct extent {
    double min_m[2], max_m[2];
};

static struct extent extent_of(const struct wd_world *world)
{
    struct extent extent = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
    for (size_t i = 0; i < world->tree_count; i++) {
        const double at_m[2] = {world->trees[i].x_mm * 0.001, world->trees[i].y_mm * 0.001};
        for (int k = 0; k < 2; k++) {
            extent.min_m[k] = fmin(extent.min_m[k], at_m[k]);
            extent.max_m[k] = fmax(extent.max_m[k], at_m[k]);
        }
    }
    return extent;
}

double wd_cells_size(const struct wd_world *world, double trees)
{
    struct extent extent = extent_of(world);
    double width = fmax(extent.max_m[0] - extent.min_m[0], 1.0);
    double height = fmax(extent.max_m[1] - extent.min_m[1], 1.0);
    return sqrt(width * height * trees / (double)world->tree_count);
}

static size_t cell_of(const struct wd_cells *cells, const struct wd_tree *tree)
{
    double column = (tree->x_mm * 0.001 - cells->min_m[0]) / cells->cell_m;
    double row = (tree->y_mm * 0.001 - cells->min_m[1]) / cells->cell_m;
    return (size_t)row * cells->columns + (size_t)column;
}

static void grow_box(struct wd_cell_box *box, const struct wd_tree *tree)
{
    struct wd_cell_box own;
    wd_tree_bounds(tree, own.min_m, own.max_m);
    for (int k = 0; k < 3; k++) {
        box->min_m[k] = fminf(box->min_m[k], own.min_m[k]);
        box->max_m[k] = fmaxf(box->max_m[k], own.max_m[k]);
    }
}

void wd_cells_init(struct wd_cells *cells, const struct wd_world *world, double cell_m)
{
    struct extent extent = extent_of(world);
    double width = extent.max_m[0] - extent.min_m[0], height = extent.max_m[1] - extent.min_m[1];
    /* memory is bounded by larger cells */
    while ((width / cell_m + 1.0) * (height / cell_m + 1.0) > MAX_CELLS)
        cell_m *= 2.0;
    *cells = (struct wd_cells){.min_m = {extent.min_m[0], extent.min_m[1]},
                               .cell_m = cell_m,
                               .columns = (uint32_t)(width / cell_m) + 1,
                               .rows = (uint32_t)(height / cell_m) + 1};
    size_t count = (size_t)cells->columns * cells->rows;
    cells->first = wd_alloc_array(count + 2, sizeof *cells->first);
    cells->trees = wd_alloc_array(world->tree_count, sizeof *cells->trees);
    cells->boxes = wd_alloc_array(count, sizeof *cells->boxes);
    for (size_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            cells->boxes[i].min_m[k] = INFINITY;
            cells->boxes[i].max_m[k] = -INFINITY;
        }
    }
    uint32_t *next = cells->first + 1; /* becomes first[i + 1] once all are placed */
    for (size_t i = 0; i < world->tree_count; i++)
        next[cell_of(cells, &world->trees[i]) + 1]++;
    for (size_t i = 1; i <= count; i++)
        next[i] += next[i - 1];
    for (size_t i = 0; i < world->tree_count; i++) {
        size_t cell = cell_of(cells, &world->trees[i]);
        grow_box(&cells->boxes[cell], &world->trees[i]);
        cells->trees[next[cell]++] = (uint32_t)i;
    }
}

void wd_cells_finish(struct wd_cells *cells)
{
    free(cells->first);
    free(cells->trees);
    free(cells->boxes);
    *cells = (struct wd_cells){0};
}

/* --- what a view sees -------------------------------------------------------------------- */

static int nearer_first(const void *a, const void *b)
{
    const struct wd_near_cell *one = a, *other = b;
    if (one->distance_m != other->distance_m)
        return one->distance_m < other->distance_m ? -1 : 1;
    return one->cell < other->cell ? -1 : 1;
}

void wd_cell_list_fill(struct wd_cell_list *list, const struct wd_cells *cells,
                       const struct wd_view *view)
{
    size_t count = (size_t)cells->columns * cells->rows;
    list->count = 0;
    for (size_t i = 0; i < count; i++) {
        const struct wd_cell_box *box = &cells->boxes[i];
        if (cells->first[i] == cells->first[i + 1])
            continue;
        float min[3], max[3], squared = 0.0f;
        for (int k = 0; k < 3; k++) {
            min[k] = (float)((double)box->min_m[k] - view->eye_m[k]);
            max[k] = (float)((double)box->max_m[k] - view->eye_m[k]);
            float outside = fmaxf(fmaxf(min[k], -max[k]), 0.0f);
            squared += outside * outside;
        }
        if (wd_frustum_box(&view->frustum, min, max) != WD_OUTSIDE)
            *wd_push(list->items, list->count, list->capacity) =
                (struct wd_near_cell){sqrtf(squared), (uint32_t)i};
    }
    qsort(list->items, list->count, sizeof *list->items, nearer_first);
}

void wd_cell_list_finish(struct wd_cell_list *list)
{
    free(list->items);
    *list = (struct wd_cell_list){0};
}
