#version 460
/* Wood without 64-bit atomics, in two passes over the same work: the greatest depth of each
 * pixel, then the greatest id among those that have it. */
#include "shared/types.h"

layout(constant_id = 2) const uint IDS = 0u;

struct wd_seen {
    uint id, depth_bits;
};
layout(scalar, set = 0, binding = 5) buffer Pixels { wd_seen pixels[]; };

void splat(uint pixel, uint depth_bits, uint id)
{
    if (IDS == 0u)
        atomicMax(pixels[pixel].depth_bits, depth_bits);
    else if (pixels[pixel].depth_bits == depth_bits)
        atomicMax(pixels[pixel].id, id);
}
#define SPLAT(pixel, depth_bits, id) splat(pixel, depth_bits, id)
#include "lib/wood_draw.glsl"
