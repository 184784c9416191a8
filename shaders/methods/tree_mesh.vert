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

/* Whether a leaf is drawn as this mesh has it: it may be drawn as a twig, or thinned out. Those that
 * stay grow about their middles. */
bool settle_leaf(inout wd_tree_vertex v, wd_tree tree)
{
    wd_tree_leaf leaf = leaves[(v.kind >> WD_VERTEX_LEAF_SHIFT) - 1u];
    wd_model model = models[WD_TREE_SPECIES(tree) * push.variants
                            + WD_TREE_VARIANT(tree) % push.variants];
    tree_pose pose = tree_pose_of(tree, model);
    float far_m = length(tree_foot_rel(tree) + tree_offset(pose, leaf.position_m));
    if (DETAIL != 0u && push.spray_reach > 0.0
        && wd_hash_unit(wd_hash2(leaf.random, tree.random)) < wd_spray_share(far_m,
                                                                            push.spray_reach))
        return false;
    float share = wd_leaf_share(push.leaf_m * pose.across * push.pixels_per_radian / far_m);
    if (float((v.kind >> WD_VERTEX_LEAF_SHIFT) - 1u) >= share * float(push.leaf_count))
        return false;
    vec3 along = octahedral_decode(unpackSnorm2x16(leaf.axis));
    vec3 middle = leaf.position_m + along * (0.5 * leaf.size_m);
    v.position_m = middle + (v.position_m - middle) * inversesqrt(share);
    return true;
}

void main()
{
    wd_instance instance = instances[gl_InstanceIndex];
    wd_tree_vertex v = vertices[gl_VertexIndex];
    if (push.leaf_count != 0u && v.kind >> WD_VERTEX_LEAF_SHIFT != 0u
        && !settle_leaf(v, trees[instance.tree])) {
        gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
        return;
    }
    tree_mesh_vertex(instance, v);
}
