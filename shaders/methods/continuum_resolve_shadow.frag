#version 460
/* Depth of a cascade from the visibility buffer. */
#include "shared/continuum.h"

layout(scalar, set = 0, binding = 0) uniform View { wd_splat_view view; };
layout(scalar, set = 0, binding = 1) readonly buffer Pixels { uint depth_bits[]; };

void main()
{
    uvec2 at = uvec2(gl_FragCoord.xy) / view.texels;
    gl_FragDepth = uintBitsToFloat(depth_bits[at.y * view.width + at.x]);
}
