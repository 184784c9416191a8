#version 460
/* Wood with 64-bit atomics. */
#include "lib/mark_once.glsl"
#include "lib/wood_draw.glsl"
