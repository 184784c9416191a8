#version 460
/* A level from the next finer one; the first from the picture. Each texel is the mean of 4 x 4 with
 * weights 1 3 3 1, so that small bright places do not flicker. */
#include "shared/bloom.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint FIRST = 0u;

layout(scalar, set = 0, binding = 0) buffer Bloom { vec4 bloom[]; };
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D radiance_image;
layout(scalar, push_constant) uniform Push { wd_bloom_push push; };

#include "lib/bloom.glsl"

vec3 finer(ivec2 at)
{
    if (FIRST == 0u)
        return bloom_texel(push.from, at);
    vec4 sum = imageLoad(radiance_image,
                         clamp(at, ivec2(0), ivec2(push.from.width, push.from.height) - 1));
    return sum.rgb / max(sum.a, 1.0);
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= int(push.to.width) || at.y >= int(push.to.height))
        return;
    const float weights[4] = {0.125, 0.375, 0.375, 0.125};
    vec3 sum = vec3(0.0);
    for (int y = 0; y < 4; y++) {
        for (int x = 0; x < 4; x++)
            sum += finer(2 * at + ivec2(x, y) - 1) * (weights[x] * weights[y]);
    }
    bloom[push.to.first + uint(at.y) * push.to.width + uint(at.x)] = vec4(sum, 0.0);
}
