#version 460
/* A tree model seen from one side, orthographically: one card of the crossed billboards. */
#include "shared/tree.h"
#include "lib/tree_vertex.glsl"

layout(scalar, set = 0, binding = 0) readonly buffer Vertices { wd_tree_vertex vertices[]; };
layout(scalar, push_constant) uniform Push { mat4 clip_from_model; };

layout(location = 0) out vec3 out_normal;
layout(location = 1) out vec2 out_uv;
layout(location = 2) out vec4 out_tint;
layout(location = 3) flat out uvec2 out_kind; /* layer of the look; 1 for leaves */

void main()
{
    wd_tree_vertex v = vertices[gl_VertexIndex];
    out_normal = tree_vertex_normal(v);
    out_uv = unpackHalf2x16(v.uv);
    out_tint = unpackUnorm4x8(v.tint);
    out_kind = uvec2(wd_vertex_layer(v.kind), (v.kind & WD_VERTEX_LEAF) != 0u ? 1u : 0u);
    gl_Position = clip_from_model * vec4(v.position_m, 1.0);
}
