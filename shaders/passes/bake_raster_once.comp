#version 460
/* Rasterises a tree's triangles with 64-bit atomics: the nearest surface and whose it is at once;
 * where DEPTHS is not 0, the farthest surface and the number of leaves. */
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#include "shared/bake.h"
#include "shared/forest.h"

layout(constant_id = 1) const uint LARGE = 0u;
layout(constant_id = 2) const uint DEPTHS = 0u;
const uint IDENTITY = 0u;

/* A wd_bake_sample. */
struct wide_sample {
    uint64_t nearest;
    uint back, sheets;
};
layout(scalar, set = 0, binding = 3) buffer Samples { wide_sample samples[]; };
layout(scalar, push_constant) uniform Push { wd_bake_push push; };

void draw(uint at, float depth, uint triangle)
{
    uint bits = floatBitsToUint(depth);
    atomicMax(samples[at].nearest, uint64_t(bits) << 32 | uint64_t(triangle + 1u));
    if (DEPTHS == 0u)
        return;
    atomicMax(samples[at].back, ~bits);
    if (triangle >= push.wood_triangles)
        atomicAdd(samples[at].sheets, 1u);
}

#include "lib/bake_raster.glsl"
