#version 460
/* Wood without 64-bit atomics. Of a cascade depth is enough. Of the camera's view two passes over the
 * same work find the greatest depth of each pixel, then the greatest id among those that have it. */
#include "shared/types.h"

layout(constant_id = 2) const uint IDS = 0u;

/* a word a texel of a cascade; id and depth of a pixel */
layout(scalar, set = 0, binding = 5) buffer Pixels { uint words[]; };

void mark(uint pixel, uint depth_bits, uint id);
#define SPLAT(pixel, depth_bits, id) mark(pixel, depth_bits, id)
#include "lib/wood_draw.glsl"

void mark(uint pixel, uint depth_bits, uint id)
{
    if (ORTHOGRAPHIC != 0u)
        atomicMax(words[pixel], depth_bits);
    else if (IDS == 0u)
        atomicMax(words[2u * pixel + 1u], depth_bits);
    else if (words[2u * pixel + 1u] == depth_bits)
        atomicMax(words[2u * pixel], id);
}
