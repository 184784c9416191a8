#version 460
/* A tree as triangles, full or reduced. */
#include "shared/frame.h"
#include "shared/forest.h"
#include "shared/hash.h"

layout(constant_id = 0) const uint SHADOW = 0u;
layout(constant_id = 1) const uint DETAIL = 0u;

layout(scalar, set = 0, binding = 0) readonly buffer Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 1) readonly buffer Trees { wd_tree trees[]; };
layout(scalar, set = 0, binding = 2) readonly buffer Models { wd_model models[]; };
layout(scalar, set = 0, binding = 3) readonly buffer Vertices { wd_tree_vertex vertices[]; };
layout(scalar, set = 0, binding = 4) readonly buffer Instances { wd_instance instances[]; };
layout(scalar, set = 0, binding = 7) readonly buffer Leaves { wd_tree_leaf leaves[]; };
layout(scalar, push_constant) uniform Push { wd_tree_push push; };

#include "lib/tree.glsl"
#include "lib/tree_vertex.glsl"
#include "lib/tree_mesh.glsl"

/* Whether this vertex' leaf is drawn as a twig. */
bool is_spray(wd_tree_vertex v, wd_tree tree)
{
    uint name = v.kind >> WD_VERTEX_LEAF_SHIFT;
    if (DETAIL == 0u || push.spray_reach == 0.0 || name == 0u)
        return false;
    wd_model model = models[WD_TREE_SPECIES(tree) * push.variants
                            + WD_TREE_VARIANT(tree) % push.variants];
    vec3 at = tree_foot_rel(tree)
              + tree_offset(tree_pose_of(tree, model), leaves[name - 1u].position_m);
    return wd_hash_unit(wd_hash2(leaves[name - 1u].random, tree.random))
           < wd_spray_share(length(at), push.spray_reach);
}

void main()
{
    wd_instance instance = instances[gl_InstanceIndex];
    wd_tree_vertex v = vertices[gl_VertexIndex];
    if (is_spray(v, trees[instance.tree]))
        instance.show = 0.0;
    tree_mesh_vertex(instance, v);
}
