#version 460
/* Depth of a cascade, a word a texel, from a visibility buffer of larger texels. */
#include "shared/continuum.h"

layout(local_size_x = 64) in;

layout(scalar, set = 0, binding = 0) uniform View { wd_splat_view view; };
layout(set = 0, binding = 1) uniform usamplerBuffer pixels; /* of two words */
layout(scalar, set = 0, binding = 2) writeonly buffer Depths { uint depths[]; };

void main()
{
    uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    uint index = group * gl_WorkGroupSize.x + gl_LocalInvocationID.x, width = view.width * view.texels;
    if (index >= width * view.height * view.texels)
        return;
    uvec2 at = uvec2(index % width, index / width) / view.texels;
    uint word = at.y * view.width + at.x;
    uvec2 pair = texelFetch(pixels, int(word >> 1)).xy;
    depths[index] = (word & 1u) != 0u ? pair.y : pair.x;
}
