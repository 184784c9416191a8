#version 460
/* Depth of a cascade from a visibility buffer, whose texels may be larger, and from what was drawn there. */
#include "shared/continuum.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, set = 0, binding = 0) uniform View { wd_splat_view view; };
layout(set = 0, binding = 1) uniform usamplerBuffer pixels; /* of two words */
layout(set = 0, binding = 2) uniform sampler2DArray drawn;
layout(set = 0, binding = 3, r32f) uniform writeonly image2DArray maps;
layout(scalar, push_constant) uniform Push { wd_cascade_push push; };

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy, from = at / view.texels;
    if (from.x >= view.width || from.y >= view.height)
        return;
    uint word = from.y * view.width + from.x;
    uvec2 pair = texelFetch(pixels, int(word >> 1)).xy;
    float depth = uintBitsToFloat((word & 1u) != 0u ? pair.y : pair.x);
    ivec3 texel = ivec3(at, push.layer);
    if (push.has_drawn != 0u)
        depth = max(depth, texelFetch(drawn, texel, 0).x);
    imageStore(maps, texel, vec4(depth));
}
