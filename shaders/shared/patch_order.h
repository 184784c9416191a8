/* patch_order.h: back to front by arithmetic (the foliage sample's analytic sort, row I2).
 *
 * Of a grid of cells the farthest are wanted first, as seen from an eye over one of them (or beside
 * the grid). Along either axis the cells before the eye's come in rising order, then those behind it
 * in falling order, the eye's own last. A ray from the eye never turns back along an axis, so of two
 * cells that it crosses the farther one comes first, whichever way it goes: no sort, no state. */
#ifndef WD_SHARED_PATCH_ORDER_H
#define WD_SHARED_PATCH_ORDER_H

#include "shared/light.h"

#ifdef __STDC_VERSION__
#define WD_PATCH_ORDER struct wd_patch_order
#define WD_LIGHT_PUSH struct wd_light_push
#else
#define WD_PATCH_ORDER wd_patch_order
#define WD_LIGHT_PUSH wd_light_push
#endif

struct wd_patch_order {
    uint32_t columns, rows;
    uint32_t before_column, before_row; /* cells before the eye's: 0..columns, 0..rows */
    uint32_t by_columns;                /* 1: columns change slowest, for eyes that look along x */
};

WD_FUNC uint32_t wd_patch_place(uint32_t index, uint32_t count, uint32_t before)
{
    return index < before ? index : count - 1u - (index - before);
}

/* The cell (row * columns + column) that is number `index` from the back. */
WD_FUNC uint32_t wd_patch_cell(WD_PATCH_ORDER order, uint32_t index)
{
    uint32_t minor_count = order.by_columns != 0u ? order.rows : order.columns;
    uint32_t major = index / minor_count, minor = index - major * minor_count;
    uint32_t column = order.by_columns != 0u ? major : minor;
    uint32_t row = order.by_columns != 0u ? minor : major;
    column = wd_patch_place(column, order.columns, order.before_column);
    row = wd_patch_place(row, order.rows, order.before_row);
    return row * order.columns + column;
}

/* Of a table that holds `first` by line and cell (line * cells + cell: how many trees stand before
 * that cell) and then the trees in that order: the place in it of the tree that is number `index`
 * from the back. Empty cells cost nothing. A line's trees are found by halving, as
 * WD_PATCH_FIRST(cell) tells where they begin; `before_line`, `before_cell` are those before the
 * eye's. Trees of one cell come in their order in the table, or the other way round. */
#ifdef WD_PATCH_FIRST
WD_FUNC uint32_t wd_patch_tree(uint32_t cells, uint32_t before_line, uint32_t before_cell,
                               uint32_t index)
{
    uint32_t ahead = WD_PATCH_FIRST(before_line * cells), count = WD_PATCH_FIRST(cells * cells);
    uint32_t rising = index < ahead ? 1u : 0u;
    uint32_t at = rising != 0u ? index : count - 1u - (index - ahead);
    uint32_t low = rising != 0u ? 0u : before_line, high = rising != 0u ? before_line : cells;
    while (high - low > 1u) { /* the line that holds tree `at` of the table */
        uint32_t middle = (low + high) / 2u;
        if (WD_PATCH_FIRST(middle * cells) <= at)
            low = middle;
        else
            high = middle;
    }
    uint32_t begin = WD_PATCH_FIRST(low * cells), end = WD_PATCH_FIRST((low + 1u) * cells);
    uint32_t in_line = rising != 0u ? at - begin : end - 1u - at;
    uint32_t split = WD_PATCH_FIRST(low * cells + before_cell);
    return in_line < split - begin ? begin + in_line : end - 1u - (in_line - (split - begin));
}
#endif

/* Push constants of billboards in patches. */
struct wd_patch_push {
    WD_LIGHT_PUSH light;
    uint32_t cells;          /* of the patch, along a side; 0: the table lists trees one by one */
    uint32_t before_line, before_cell; /* as wd_patch_tree's */
    uint32_t table;          /* words before `first` */
    uint32_t whole_fades;    /* fades are whole numbers: trees pop (the sample's fault) */
    float pixels_per_radian;
    float near_scale;        /* on the distances where billboards begin */
};

#endif
