#version 460
#include "lib/view_tree.glsl"
