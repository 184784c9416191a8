#version 460
/* Tiles with water. No uniform block: llvmpipe bakes values of those that branches read into shaders, and
 * would make this long one anew for each view of water. */
#define FRAME_BLOCK readonly buffer
#define WET
#include "lib/light_pixels.glsl"
