#version 460
/* Leaves of a tree, thinned: of the leaves in progressive order those beyond the kept share are
 * left out, the others grow so that the crown's leaf area stays. */
#include "shared/frame.h"
#include "shared/dissolve.h"
#include "shared/hash.h"
#include "shared/sun_ways.h"

layout(constant_id = 0) const uint SHADOW = 0u;

layout(scalar, set = 0, binding = 0) readonly buffer Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 1) readonly buffer Trees { wd_packed_tree trees[]; };
layout(scalar, set = 0, binding = 2) readonly buffer Models { wd_model models[]; };
layout(scalar, set = 0, binding = 3) readonly buffer Vertices { wd_tree_vertex vertices[]; };
layout(scalar, set = 0, binding = 4) readonly buffer Instances { wd_leafy_instance instances[]; };
layout(scalar, set = 0, binding = 7) readonly buffer Places { wd_leaf_place places[]; };
layout(scalar, push_constant) uniform Push { wd_tree_push push; };

#include "lib/trees.glsl"
#include "lib/tree.glsl"
#include "lib/tree_vertex.glsl"
#include "lib/mirror.glsl"
#include "lib/tree_mesh.glsl"

void main()
{
    wd_leafy_instance instance = instances[gl_InstanceIndex];
    wd_tree_vertex v = vertices[gl_VertexIndex];
    wd_leaf_place place = places[gl_VertexIndex];
    if (place.rank >= instance.kept) {
        gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
        return;
    }
    mesh_corner corner;
    corner.position_m = place.center_m + (v.position_m - place.center_m) * instance.scale;
    corner.normal = tree_vertex_normal(v);
    corner.face = corner.normal;
    corner.uv = unpackHalf2x16(v.uv);
    corner.tint = unpackUnorm4x8(v.tint);
    corner.kind = v.kind;
    corner.name = uint(gl_VertexIndex);
    corner.open = ~0u; /* on the whole as much as it sees of the sky */
    corner.lets = corner.tint.a;
    wd_tree tree = tree_at(instance.tree);
    wd_model model = models[WD_TREE_SPECIES(tree) * push.variants
                            + WD_TREE_VARIANT(tree) % push.variants];
    tree_mesh_vertex(wd_instance(instance.tree, instance.show), tree, model, corner);
}
