#version 460
/* Splats without 64-bit atomics. */
#include "lib/mark_twice.glsl"
#include "lib/splat_draw.glsl"
