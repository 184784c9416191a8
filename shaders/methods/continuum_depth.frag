#version 460
/* Depth of splats or of wood from the visibility buffer. */
#include "shared/continuum.h"

layout(constant_id = 0) const uint WOOD = 0u;

layout(scalar, set = 0, binding = 0) uniform View { wd_splat_view view; };
layout(set = 0, binding = 1) uniform usamplerBuffer pixels; /* id, depth */

void main()
{
    uvec2 at = uvec2(gl_FragCoord.xy);
    uvec2 pixel = texelFetch(pixels, int(at.y * view.width + at.x)).xy;
    bool mine = ((pixel.x & WD_ID_WOOD) != 0u) == (WOOD != 0u);
    gl_FragDepth = mine ? uintBitsToFloat(pixel.y) : 0.0;
}
