#version 460
/* Splats with 64-bit atomics. */
#include "lib/mark_once.glsl"
#include "lib/splat_draw.glsl"
