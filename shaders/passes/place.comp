#version 460
#extension GL_GOOGLE_include_directive : require
/* Plants cells of a layer: one thread a cell, `slots` trees a cell in the result. A tree that is
 * refused keeps its place but has size 0; a slot without a tree is all zero. */
#include "shared/place_layer.h"
#include "shared/tree.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
    uint first_cell, cell_count; /* by rows from the south-west */
    uint slots;                  /* count_size of the layer */
};
layout(set = 0, binding = 0, scalar) readonly buffer Layer {
    wd_place_layer place_layer;
    wd_place_ground place_ground;
};
layout(set = 0, binding = 1, scalar) readonly buffer Heights { float heights_m[]; };
layout(set = 0, binding = 2, scalar) readonly buffer Holes { uint holes[]; }; /* a byte a sample */
layout(set = 0, binding = 3, scalar) readonly buffer Map { float probabilities[]; };
layout(set = 0, binding = 4, scalar) readonly buffer Table { uint table[]; };
layout(set = 0, binding = 5, scalar) writeonly buffer Trees { wd_tree trees[]; };

#define WD_GROUND(member) place_ground.member
#define WD_LAYER(member) place_layer.member
#define WD_HEIGHT_AT(index) heights_m[index]
#define WD_HOLE_AT(index) (holes[(index) >> 2] >> (((index) & 3u) * 8u) & 0xffu)
#define WD_MAP_AT(index) probabilities[index]
#define WD_TABLE_AT(index) table[index]
#include "shared/placement.h"

void main()
{
    uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    uint index = group * 64u + gl_LocalInvocationID.x;
    if (index >= cell_count)
        return;
    uint at = first_cell + index;
    wd_place_cell cell = wd_place_open_cell(at % place_layer.columns, at / place_layer.columns);
    uint sub_cell = 0u;
    for (uint i = 0u; i < cell.count; i++) {
        sub_cell = wd_place_sub_cell(cell, sub_cell, i);
        trees[index * slots + i] = wd_place_candidate(cell, sub_cell, i);
        sub_cell++;
    }
    for (uint i = cell.count; i < slots; i++)
        trees[index * slots + i] = wd_tree(0, 0, 0, 0u, 0u, 0u, 0u);
}
