#version 460
/* Adds a coarser level to the next finer one. */
#include "shared/bloom.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, set = 0, binding = 0) buffer Bloom { vec4 bloom[]; };
layout(scalar, push_constant) uniform Push { wd_bloom_push push; };

#include "lib/bloom.glsl"

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= int(push.to.width) || at.y >= int(push.to.height))
        return;
    vec3 coarse = bloom_linear(push.from, (vec2(at) + 0.5) * 0.5);
    bloom[push.to.first + uint(at.y) * push.to.width + uint(at.x)].rgb += coarse;
}
