#version 460
/* Depth of splats or of wood from the visibility buffer, where it is: discs that nothing of their tree
 * hides were only sorted as if they were nearer. */
#include "shared/continuum.h"

layout(constant_id = 0) const uint WOOD = 0u;

layout(set = 0, binding = 1) uniform usamplerBuffer pixels;      /* id, depth */
layout(set = 0, binding = 2) uniform usamplerBuffer splat_trees; /* wd_splat_tree */
layout(set = 0, binding = 3) uniform usamplerBuffer items;       /* wd_splat_item */

#include "lib/splat.glsl"

layout(location = 0) flat in uvec2 in_row;
layout(location = 1) flat in float in_near_m;

/* Of a splat; its depth's last bit says whether it was brought nearer. */
float true_depth(uvec2 pixel)
{
    uint tree = splat_item_at(items, (pixel.x - 1u) / WD_ITEM_SPLATS).tree;
    float nearer_m = splat_tree_nearer_m(splat_trees, tree) * float(pixel.y & 1u);
    float depth = uintBitsToFloat(pixel.y);
    return depth / (1.0 + nearer_m * depth / in_near_m);
}

void main()
{
    uvec2 at = uvec2(gl_FragCoord.xy);
    uvec2 pixel = texelFetch(pixels, int(at.y * in_row.x + at.x)).xy;
    bool mine = ((pixel.x & WD_ID_WOOD) != 0u) == (WOOD != 0u);
    float depth = WOOD != 0u ? uintBitsToFloat(pixel.y) : true_depth(uvec2(max(pixel.x, 1u), pixel.y));
    gl_FragDepth = mine ? depth : 0.0;
}
