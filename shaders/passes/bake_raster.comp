#version 460
/* Rasterises a tree's triangles with 32-bit atomics, twice. IDENTITY 0 finds the nearest and, where
 * DEPTHS is not 0, the farthest surface and counts leaves; 1 then finds whose the nearest is. */
#include "shared/bake.h"
#include "shared/forest.h"

layout(constant_id = 0) const uint IDENTITY = 0u;
layout(constant_id = 1) const uint LARGE = 0u;
layout(constant_id = 2) const uint DEPTHS = 0u;
layout(constant_id = 3) const uint CUT_OUT = 0u;

layout(scalar, set = 0, binding = 2) buffer Samples { wd_bake_sample samples[]; };
layout(scalar, set = 0, binding = 3) buffer Rays { wd_bake_ray rays[]; };
layout(scalar, push_constant) uniform Push { wd_bake_push push; };

void draw(uint at, float depth, uint seen)
{
    uint bits = floatBitsToUint(depth);
    if (IDENTITY != 0u) {
        if (samples[at].front == bits)
            atomicMax(samples[at].seen, seen);
        return;
    }
    atomicMax(samples[at].front, bits);
    if (DEPTHS == 0u)
        return;
    atomicMax(rays[at].back, ~bits);
    if (WD_BAKE_TRIANGLE(seen) >= push.wood_triangles)
        atomicAdd(rays[at].sheets, 1u);
}

#include "lib/bake_raster.glsl"
