#version 460
/* Wood without 64-bit atomics. */
#include "lib/mark_twice.glsl"
#include "lib/wood_draw.glsl"
