#version 460
#define VIEW_DEPTH
#include "lib/view_tree.glsl"
