/* page.h: the trees of a layer in pages, alike on CPU and GPU.
 *
 * A block of level l holds 2^l x 2^l cells of the layer's grid; one of its cells stands for it: one
 * of its four children of level l - 1 is chosen by hash, and so on down to a cell. So the cells that
 * stand for blocks of level l + 1 are among those of level l, and any of these sets is a fair
 * sample of the layer: each tree of it stands for 4^l.
 *
 * A page of level l holds the trees of 32 x 32 such blocks, in clusters of 8 x 8. In a cluster come
 * those first that stand for blocks of the coarsest levels (in the order of reversed bits: see
 * wd_page_cell_of), so that a prefix of a cluster's trees is what a coarser page holds of it: going
 * from a page to the coarser one changes nothing where a quarter of its trees are drawn.
 *
 * A shader that includes this defines WD_LAYER(member) before. */
#ifndef WD_SHARED_PAGE_H
#define WD_SHARED_PAGE_H

#include "shared/placement.h"

#define WD_PAGE_SIDE 32u      /* blocks */
#define WD_PAGE_TREES 1024u
#define WD_PAGE_CLUSTERS 16u
#define WD_PAGE_CLUSTER 64u   /* trees; 8 x 8 blocks */

struct wd_page {
    uint32_t layer;       /* index among those that are planted on demand */
    uint32_t level;
    uint32_t column, row; /* in pages of that level */
};

struct wd_page_cell {
    uint32_t column, row;
};

/* Which child stands for a block: column in bit 0, row in bit 1. */
WD_FUNC uint32_t wd_block_choice(WD_PLACE_IN uint32_t level, WD_STRUCT wd_page_cell block)
{
    return wd_hash4(WD_LAYER(key) ^ 0x9e3779b9u, level, block.column, block.row) >> 30;
}

/* The child that comes `turn` after the one that stands for the block. */
WD_FUNC WD_STRUCT wd_page_cell wd_block_child(WD_PLACE_IN uint32_t level,
                                              WD_STRUCT wd_page_cell block, uint32_t turn)
{
    uint32_t child = (wd_block_choice(WD_PLACE_PASS level, block) + turn) & 3u;
    WD_STRUCT wd_page_cell at;
    at.column = block.column * 2u + (child & 1u);
    at.row = block.row * 2u + (child >> 1);
    return at;
}

/* The cell of tree `index` of a page. Bits 0..5 of the index, reversed, are the rank in its cluster:
 * ranks below 16 are those that stand for blocks one level up, below 4 two, 0 three. */
WD_FUNC WD_STRUCT wd_page_cell wd_page_cell_of(WD_PLACE_IN WD_STRUCT wd_page page, uint32_t index)
{
    uint32_t cluster = index >> 6, i = index & 63u;
    WD_STRUCT wd_page_cell at;
    at.column = page.column * 4u + (cluster & 3u);
    at.row = page.row * 4u + (cluster >> 2);
    /* two bits of the rank a level, those of the coarsest lowest */
    for (uint32_t up = 3u; up > 0u; up--) {
        uint32_t pair = (i >> (2u * up - 2u)) & 3u;
        at = wd_block_child(WD_PLACE_PASS page.level + up, at, (pair >> 1) | ((pair & 1u) << 1));
    }
    for (uint32_t level = page.level; level > 0u; level--)
        at = wd_block_child(WD_PLACE_PASS level, at, 0u);
    return at;
}

/* Ids count the cells of all layers, by rows; worlds of more than 2^32 cells repeat them, 2^32 cells
 * apart. 0 means no tree, so that one cell has the id of the one before it. */
WD_FUNC uint32_t wd_page_id(WD_PLACE_IN uint32_t first_id, WD_STRUCT wd_page_cell cell)
{
    uint32_t id = first_id + cell.row * WD_LAYER(columns) + cell.column;
    return id == 0u ? 0xffffffffu : id;
}

/* The tree of a cell, or size 0. Layers of pages have at most one tree a cell. */
WD_FUNC WD_STRUCT wd_tree wd_page_tree(WD_PLACE_IN uint32_t first_id,
                                       WD_STRUCT wd_page_cell at)
{
    WD_STRUCT wd_tree tree;
    tree.x_mm = 0;
    tree.y_mm = 0;
    tree.z_mm = 0;
    tree.kind = 0u;
    tree.size = 0u;
    tree.look = 0u;
    tree.id = 0u;
    if (at.column >= WD_LAYER(columns) || at.row >= WD_LAYER(rows))
        return tree;
    WD_STRUCT wd_place_cell cell = wd_place_open_cell(WD_PLACE_PASS at.column, at.row);
    if (cell.count == 0u)
        return tree;
    tree = wd_place_candidate(WD_PLACE_PASS cell, 0u, 0u);
    tree.id = wd_page_id(WD_PLACE_PASS first_id, at);
    return tree;
}

#endif
