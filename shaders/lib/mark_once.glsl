/* SPLAT(pixel, depth_bits, id) with 64-bit atomics: one operation a pixel. To be included before a library that
 * expects SPLAT. */
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#include "shared/types.h"

layout(scalar, set = 0, binding = 5) buffer Pixels { uint64_t pixels[]; };

#define SPLAT(pixel, depth_bits, id) \
    atomicMax(pixels[pixel], uint64_t(depth_bits) << 32 | uint64_t(id))
