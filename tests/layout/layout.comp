#version 460
/* Every struct that C and GLSL share, so that the compiled module tells its offsets. */
#include "shared/forest.h"
#include "shared/frame.h"

layout(scalar, binding = 0) buffer Trees { wd_tree tree; };
layout(scalar, binding = 1) buffer Vertices { wd_tree_vertex vertex; };
layout(scalar, binding = 2) buffer Models { wd_model model; };
layout(scalar, binding = 3) buffer Fades { wd_layer_fade fade; };
layout(scalar, binding = 4) buffer Instances { wd_instance instance; };
layout(scalar, binding = 5) buffer Pushes { wd_tree_push push; };
layout(scalar, binding = 6) buffer Frames { wd_frame_uniforms frame; };
layout(scalar, binding = 7) buffer Points { wd_tree_point point; };

void main()
{
    tree.id = vertex.uv + point.kind + model.card_layer + uint(fade.near_begin_m) + instance.tree + push.level
              + frame.width;
}
