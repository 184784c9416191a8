#version 460
/* A tree's wood as triangles, full or reduced; of imported trees their leaves, too. */
#include "shared/frame.h"
#include "shared/forest.h"
#include "shared/hash.h"
#include "shared/sun_ways.h"

layout(constant_id = 0) const uint SHADOW = 0u;

layout(scalar, set = 0, binding = 0) readonly buffer Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 1) readonly buffer Trees { wd_packed_tree trees[]; };
layout(scalar, set = 0, binding = 2) readonly buffer Models { wd_model models[]; };
layout(scalar, set = 0, binding = 3) readonly buffer Vertices { wd_packed_vertex vertices[]; };
layout(scalar, set = 0, binding = 4) readonly buffer Instances { wd_instance instances[]; };
layout(scalar, push_constant) uniform Push { wd_mesh_push mesh; };

#include "lib/trees.glsl"
#include "lib/tree.glsl"
#include "lib/tree_vertex.glsl"
#define push mesh.tree /* the libraries' name for it; lib/tree.glsl has others of its own */
#include "lib/mirror.glsl"
#include "lib/tree_mesh.glsl"

void main()
{
    wd_instance instance = instances[gl_InstanceIndex];
    wd_tree tree = tree_at(instance.tree);
    wd_model model = models[WD_TREE_SPECIES(tree) * push.variants
                            + WD_TREE_VARIANT(tree) % push.variants];
    wd_packed_vertex v = vertices[gl_VertexIndex];
    mesh_corner corner;
    corner.position_m = wd_box_place(mesh.box.feet, v.xy, v.z_kind);
    corner.normal = packed_vertex_normal(v);
    corner.face = corner.normal;
    corner.uv = unpackHalf2x16(v.uv);
    corner.tint = packed_vertex_tint(v);
    corner.kind = WD_PACKED_KIND(v);
    corner.name = uint(gl_VertexIndex);
    corner.open = ~0u; /* on the whole as much as it sees of the sky */
    corner.lets = corner.tint.a;
    tree_mesh_vertex(instance, tree, model, corner);
}
