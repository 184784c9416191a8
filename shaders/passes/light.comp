#version 460
/* Tiles without water. llvmpipe reads a uniform block once for all lanes. */
#define FRAME_BLOCK uniform
#include "lib/light_pixels.glsl"
