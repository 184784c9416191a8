/* cells.h: the world's trees by cells of a flat grid. */
#ifndef WD_METHODS_CELLS_H
#define WD_METHODS_CELLS_H

#include "frame/view.h"
#include "world/world.h"

struct wd_cell_box {
    float min_m[3], max_m[3]; /* of the trees that stand in it */
};

/* Cell (column, row) covers [column, column + 1) x [row, row + 1) cells from min_m. Every tree
 * belongs to the cell that its foot stands in. */
struct wd_cells {
    double min_m[2], cell_m;
    uint32_t columns, rows;
    uint32_t *first; /* [columns * rows + 1]: the cell's trees are trees[first[i] .. first[i + 1]) */
    uint32_t *trees; /* indices in octree order, ascending in each cell */
    struct wd_cell_box *boxes; /* of cells without trees: inside out */
};

/* Grid of `cell_m` over all trees of a world that has some. */
void wd_cells_init(struct wd_cells *cells, const struct wd_world *world, double cell_m);
void wd_cells_finish(struct wd_cells *cells);

/* Length of the side of a cell that holds `trees` trees in the mean. */
double wd_cells_size(const struct wd_world *world, double trees);

/* Cells with trees that a view may see, nearest first. */
struct wd_cell_list {
    struct wd_near_cell {
        float distance_m; /* of its trees' box from the eye */
        uint32_t cell;
    } *items;
    size_t count, capacity;
};
void wd_cell_list_fill(struct wd_cell_list *list, const struct wd_cells *cells,
                       const struct wd_view *view);
void wd_cell_list_finish(struct wd_cell_list *list);

#endif
