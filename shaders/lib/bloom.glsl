/* Reading of a level of the pyramid. Expects `bloom`, a buffer of vec4. */
#include "shared/bloom.h"

vec3 bloom_texel(wd_bloom_level level, ivec2 at)
{
    ivec2 inside = clamp(at, ivec2(0), ivec2(level.width, level.height) - 1);
    return bloom[level.first + uint(inside.y) * level.width + uint(inside.x)].rgb;
}

/* `at` in texels, the middle of the first at 0.5. */
vec3 bloom_linear(wd_bloom_level level, vec2 at)
{
    vec2 low = floor(at - 0.5), share = at - 0.5 - low;
    ivec2 cell = ivec2(low);
    vec3 above = mix(bloom_texel(level, cell), bloom_texel(level, cell + ivec2(1, 0)), share.x);
    vec3 below = mix(bloom_texel(level, cell + ivec2(0, 1)), bloom_texel(level, cell + ivec2(1, 1)),
                     share.x);
    return mix(above, below, share.y);
}
