/* SPLAT(pixel, depth_bits, id) without 64-bit atomics. Of a cascade depth is enough. Of the camera's view two passes
 * over the same work find the greatest depth of each pixel, then, with IDS, the greatest id among those that have it.
 * To be included before a library that expects SPLAT and has ORTHOGRAPHIC. */
#include "shared/types.h"

layout(constant_id = 2) const uint IDS = 0u;

/* a word a texel of a cascade; id and depth of a pixel */
layout(scalar, set = 0, binding = 5) buffer Pixels { uint words[]; };

void mark(bool cascade, uint pixel, uint depth_bits, uint id)
{
    if (cascade)
        atomicMax(words[pixel], depth_bits);
    else if (IDS == 0u)
        atomicMax(words[2u * pixel + 1u], depth_bits);
    else if (words[2u * pixel + 1u] == depth_bits)
        atomicMax(words[2u * pixel], id);
}

#define SPLAT(pixel, depth_bits, id) mark(ORTHOGRAPHIC != 0u, pixel, depth_bits, id)
