#version 460
/* Depth of a cascade from the visibility buffer. */
#include "shared/continuum.h"

layout(scalar, set = 0, binding = 0) readonly buffer View { wd_splat_view view; };
layout(scalar, set = 0, binding = 1) readonly buffer Pixels { uvec2 pixels[]; };

void main()
{
    uvec2 at = uvec2(gl_FragCoord.xy);
    uvec2 seen = pixels[at.y * view.width + at.x];
    if (seen.x == 0u)
        discard;
    gl_FragDepth = uintBitsToFloat(seen.y);
}
