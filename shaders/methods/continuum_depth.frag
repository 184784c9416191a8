#version 460
/* Depth of splats or of wood from the visibility buffer, where it is. */
#include "shared/continuum.h"

layout(constant_id = 0) const uint WOOD = 0u;

layout(set = 0, binding = 1) uniform usamplerBuffer pixels;      /* id, depth */
layout(set = 0, binding = 2) uniform usamplerBuffer splat_trees; /* wd_splat_tree */
layout(set = 0, binding = 3) uniform usamplerBuffer items;       /* wd_splat_item */

#include "lib/splat.glsl"
#include "lib/splat_depth.glsl"

layout(location = 0) flat in uvec2 in_row;
layout(location = 1) flat in float in_near_m;

void main()
{
    uvec2 at = uvec2(gl_FragCoord.xy);
    uvec2 pixel = texelFetch(pixels, int(at.y * in_row.x + at.x)).xy;
    bool mine = ((pixel.x & WD_ID_WOOD) != 0u) == (WOOD != 0u);
    float depth = WOOD != 0u ? uintBitsToFloat(pixel.y) : splat_true_depth(uvec2(max(pixel.x, 1u), pixel.y), in_near_m);
    gl_FragDepth = mine ? depth : 0.0;
}
