#version 460
/* Rasterises a tree's triangles with 64-bit atomics: the nearest surface and whose it is at once;
 * where DEPTHS is not 0, the farthest surface and the number of leaves. */
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#include "shared/bake.h"
#include "shared/forest.h"

layout(constant_id = 1) const uint LARGE = 0u;
layout(constant_id = 2) const uint DEPTHS = 0u;
layout(constant_id = 3) const uint CUT_OUT = 0u;
const uint IDENTITY = 0u;

layout(scalar, set = 0, binding = 2) buffer Samples { uint64_t samples[]; }; /* wd_bake_sample */
layout(scalar, set = 0, binding = 3) buffer Rays { wd_bake_ray rays[]; };
layout(scalar, push_constant) uniform Push { wd_bake_push push; };

void draw(uint at, float depth, uint seen)
{
    uint bits = floatBitsToUint(depth);
    atomicMax(samples[at], uint64_t(bits) << 32 | uint64_t(seen));
    if (DEPTHS == 0u)
        return;
    atomicMax(rays[at].back, ~bits);
    if (WD_BAKE_TRIANGLE(seen) >= push.wood_triangles)
        atomicAdd(rays[at].sheets, 1u);
}

#include "lib/bake_raster.glsl"
