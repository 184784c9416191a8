/* packed_tree.h: trees as the device keeps them, alike on CPU and GPU.
 *
 * Trees lie in blocks of 1024, those of one place together (octree order; a page): a head, that tells
 * a corner and steps along the axes, then 16 bytes a tree. Steps are a millimetre where the block's
 * trees stand within 2 km of each other and their feet within 262 m of height, and no more than that
 * needs elsewhere: 24 mm where a block's trees are 50 km apart. */
#ifndef WD_SHARED_PACKED_TREE_H
#define WD_SHARED_PACKED_TREE_H

#include "shared/tree.h"

#define WD_BLOCK_TREES 1024u
/* Of a tree's number among all trees, those of its own record and of its block's. */
#define WD_PACKED_AT(index) ((index) + ((index) >> 10) + 1u)
#define WD_PACKED_HEAD(index) (((index) >> 10) * (WD_BLOCK_TREES + 1u))

#define WD_ACROSS_MOST 0x1fffffu /* steps */
#define WD_UP_MOST 0x3ffffu
#define WD_MODEL_BITS 11u /* of species and variant */

/* 16 bytes. */
struct wd_packed_tree {
    uint32_t x_kind;     /* bits 0..20: steps east of the block's corner; 21..31: species, then as
                            many bits as the block says of variant */
    uint32_t y_look;     /* 0..20: steps north; 21..31: the upper bits of the look */
    uint32_t z_height;   /* 0..17: steps up; 18..31: height in cm, 0: no tree stands here */
    uint32_t crown_look; /* 0..12: crown diameter in cm; 13..31: the lower bits of the look */
};
WD_STATIC_ASSERT_SIZE(wd_packed_tree, 16);

/* A block's head. */
struct wd_tree_block {
    int32_t x_mm, y_mm, z_mm; /* its least corner */
    uint32_t steps;           /* bits 0..11: mm east and north; 12..27: mm up; 28..31: bits of the
                                 variants */
};
WD_STATIC_ASSERT_SIZE(wd_tree_block, 16);

#define WD_BLOCK_ACROSS_MM(block) ((block).steps & 0xfffu)
#define WD_BLOCK_UP_MM(block) (((block).steps >> 12) & 0xffffu)
#define WD_BLOCK_VARIANT_BITS(block) ((block).steps >> 28)

/* Nearest step. Differences are modulo 2^32: the world is wider than an int32_t's positive half. */
WD_FUNC uint32_t wd_tree_steps(int32_t from_mm, int32_t to_mm, uint32_t step_mm, uint32_t most)
{
    uint32_t way_mm = WD_UINT(to_mm) - WD_UINT(from_mm), steps = way_mm / step_mm;
    if (way_mm - steps * step_mm > step_mm / 2u)
        steps++;
    return steps < most ? steps : most;
}

WD_FUNC WD_STRUCT wd_packed_tree wd_tree_pack(WD_STRUCT wd_tree tree,
                                              WD_STRUCT wd_tree_block block)
{
    WD_STRUCT wd_packed_tree packed;
    uint32_t across_mm = WD_BLOCK_ACROSS_MM(block), up_mm = WD_BLOCK_UP_MM(block);
    uint32_t x = wd_tree_steps(block.x_mm, tree.x_mm, across_mm, WD_ACROSS_MOST);
    uint32_t y = wd_tree_steps(block.y_mm, tree.y_mm, across_mm, WD_ACROSS_MOST);
    uint32_t z = wd_tree_steps(block.z_mm, tree.z_mm, up_mm, WD_UP_MOST);
    uint32_t kind = (WD_TREE_SPECIES(tree) << WD_BLOCK_VARIANT_BITS(block)) | WD_TREE_VARIANT(tree);
    packed.x_kind = x | (kind << 21);
    packed.y_look = y | ((tree.look >> 19) << 21);
    packed.z_height = z | (tree.size << 18);
    packed.crown_look = WD_TREE_CROWN_CM(tree) | (tree.look << 13);
    return packed;
}

WD_FUNC WD_STRUCT wd_tree wd_tree_unpack(WD_STRUCT wd_packed_tree packed,
                                         WD_STRUCT wd_tree_block block)
{
    WD_STRUCT wd_tree tree;
    uint32_t across_mm = WD_BLOCK_ACROSS_MM(block), kind = packed.x_kind >> 21;
    uint32_t variant_bits = WD_BLOCK_VARIANT_BITS(block);
    tree.x_mm = WD_INT(WD_UINT(block.x_mm) + (packed.x_kind & WD_ACROSS_MOST) * across_mm);
    tree.y_mm = WD_INT(WD_UINT(block.y_mm) + (packed.y_look & WD_ACROSS_MOST) * across_mm);
    tree.z_mm = WD_INT(WD_UINT(block.z_mm) + (packed.z_height & WD_UP_MOST) * WD_BLOCK_UP_MM(block));
    tree.id = 0u;
    tree.kind = (kind >> variant_bits) | ((kind & ((1u << variant_bits) - 1u)) << 16);
    tree.size = (packed.z_height >> 18) | ((packed.crown_look & 0x1fffu) << 16);
    tree.look = ((packed.y_look >> 21) << 19) | (packed.crown_look >> 13);
    return tree;
}

/* A block's head lies among the records. */
WD_FUNC WD_STRUCT wd_packed_tree wd_tree_block_record(WD_STRUCT wd_tree_block block)
{
    WD_STRUCT wd_packed_tree head;
    head.x_kind = WD_UINT(block.x_mm);
    head.y_look = WD_UINT(block.y_mm);
    head.z_height = WD_UINT(block.z_mm);
    head.crown_look = block.steps;
    return head;
}

WD_FUNC WD_STRUCT wd_tree_block wd_tree_block_of(WD_STRUCT wd_packed_tree head)
{
    WD_STRUCT wd_tree_block block;
    block.x_mm = WD_INT(head.x_kind);
    block.y_mm = WD_INT(head.y_look);
    block.z_mm = WD_INT(head.z_height);
    block.steps = head.crown_look;
    return block;
}

#endif
