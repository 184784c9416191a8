#version 460
/* Farthest depths of squares of pixels. LEVEL 0 makes the two finest levels from pixels, a thread
 * for 4 x 4 of them; the others halve the level before. */
#include "shared/continuum.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint LEVEL = 0u;
layout(constant_id = 1) const uint TREES_ALONE = 0u; /* 1: the ground is not there yet */

layout(scalar, set = 0, binding = 0) uniform View { wd_splat_view view_block; };
layout(scalar, set = 0, binding = 1) readonly buffer Pixels { uvec2 pixels[]; };
layout(set = 0, binding = 2) uniform sampler2D terrain_depth;
layout(scalar, set = 0, binding = 3) buffer Pyramid { float pyramid[]; };

/* Read before any branch: lib/light_pixels.glsl tells why. */
wd_splat_view view = view_block;

#include "lib/pyramid.glsl"

float pixel_depth(uvec2 at)
{
    at = min(at, uvec2(view.width, view.height) - 1u);
    uint bits = pixels[at.y * view.width + at.x].y;
    if (bits != 0u || TREES_ALONE != 0u)
        return uintBitsToFloat(bits);
    return texelFetch(terrain_depth, ivec2(at), 0).x;
}

float square_depth(uvec2 at)
{
    return min(min(pixel_depth(at), pixel_depth(at + uvec2(1u, 0u))),
               min(pixel_depth(at + uvec2(0u, 1u)), pixel_depth(at + uvec2(1u, 1u))));
}

void store(uint level, uvec2 at, float depth)
{
    uvec2 size = pyramid_size(level);
    if (at.x < size.x && at.y < size.y)
        pyramid[view_block.pyramid_first[level] + at.y * size.x + at.x] = depth;
}

void from_pixels(uvec2 at)
{
    float farthest = 1.0;
    for (uint i = 0u; i < 4u; i++) {
        uvec2 fine = at * 2u + uvec2(i & 1u, i >> 1);
        float depth = square_depth(fine * 2u);
        store(0u, fine, depth);
        farthest = min(farthest, depth);
    }
    store(1u, at, farthest);
}

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    if (LEVEL == 0u) {
        if (all(lessThan(at, pyramid_size(1u))))
            from_pixels(at);
        return;
    }
    uvec2 last = pyramid_size(LEVEL - 1u) - 1u;
    float farthest = 1.0;
    for (uint i = 0u; i < 4u; i++) {
        uvec2 fine = min(at * 2u + uvec2(i & 1u, i >> 1), last);
        farthest = min(farthest, pyramid_at(LEVEL - 1u, fine));
    }
    store(LEVEL, at, farthest);
}
