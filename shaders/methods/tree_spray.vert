#version 460
/* The twig that a drawn leaf stands for, close to the camera. */
#include "shared/frame.h"
#include "shared/forest.h"
#include "shared/hash.h"
#include "shared/sun_ways.h"

layout(constant_id = 0) const uint SHADOW = 0u;

layout(scalar, set = 0, binding = 0) readonly buffer Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 1) readonly buffer Trees { wd_packed_tree trees[]; };
layout(scalar, set = 0, binding = 2) readonly buffer Models { wd_model models[]; };
layout(scalar, set = 0, binding = 3) readonly buffer Vertices { wd_packed_vertex vertices[]; };
layout(scalar, set = 0, binding = 4) readonly buffer Instances { wd_spray_instance instances[]; };
layout(scalar, set = 0, binding = 7) readonly buffer Leaves { wd_tree_leaf leaves[]; };
layout(scalar, push_constant) uniform Push { wd_spray_push spray; };

#include "lib/trees.glsl"
#include "lib/tree.glsl"
#include "lib/tree_vertex.glsl"
#define push spray.tree /* the libraries' name for it; lib/tree.glsl has others of its own */
#include "lib/mirror.glsl"

layout(location = 0) out vec3 out_normal;
layout(location = 1) out vec3 out_uv;
layout(location = 2) out vec4 out_tint;
layout(location = 3) flat out uvec3 out_flat;
layout(location = 4) flat out vec4 out_sun_show;
layout(location = 5) out vec4 out_place;

void main()
{
    wd_spray_instance instance = instances[gl_InstanceIndex];
    wd_tree tree = tree_at(instance.tree);
    wd_model model = models[WD_TREE_SPECIES(tree) * push.variants
                            + WD_TREE_VARIANT(tree) % push.variants];
    wd_tree_leaf leaf = leaves[instance.leaf];
    wd_packed_vertex v = vertices[gl_VertexIndex];
    uint kind = WD_PACKED_KIND(v);
    vec3 place = wd_box_place(spray.twig, v.xy, v.z_kind);
    bool blade = (kind & WD_VERTEX_LEAF) != 0u;
    wd_leaf_axes axes = wd_leaf_axes_of(leaf.turn);
    mat3 turn = mat3(axes.across, axes.along, axes.above);
    vec3 shading = wd_leaf_shading(leaf.shading);
    vec3 own = turn * packed_vertex_normal(v);
    own = dot(own, shading) < 0.0 ? -own : own;

    tree_pose pose = tree_pose_of(tree, model);
    vec3 at = tree_offset(pose, wd_leaf_foot(leaf, spray.leaves)
                                    + turn * place * wd_leaf_size_m(leaf, spray.leaves));
    vec3 normal = tree_normal(pose, mix(shading, own, 0.5));
    at += tree_bend(tree_wind(), tree, model.flexibility, at.z, frame.time_s);
    float phase = fract(wd_hash_unit(wd_hash1(instance.leaf)) + 0.31 * dot(place, vec3(1.0)));
    float bend = min(float(WD_LEAF_FLEXIBILITY(leaf) + (kind & 0xffu)) * (1.0 / 255.0), 1.0);
    at += normal * wd_wind_flutter(tree_wind(), bend, phase, frame.time_s);
    vec4 tint = packed_vertex_tint(v), leaf_tint = unpackUnorm4x8(leaf.tint);
    vec3 direction = normalize(tree_foot_rel(tree) + at);
    float beyond = mirrors_beyond(leaf.open, pose, direction, dot(normal, direction) > 0.0 ? -normal : normal,
                                  tree_normal(pose, own));
    out_normal = normal;
    out_uv = vec3(unpackHalf2x16(v.uv), float(model.look_layer + wd_vertex_layer(kind)));
    out_tint = vec4(blade ? tint.rgb * leaf_tint.rgb * tree_tint(tree, model) : tint.rgb,
                    leaf_tint.a);
    out_flat = uvec3(instance.tree + 1u, (blade ? WD_MATERIAL_LEAF : WD_MATERIAL_WOOD)
                                             | (pose.mirror.x < 0.0 ? 4u : 0u)
                                             | (frame.view_mode == WD_MODE_LOD ? 8u : 0u)
                                             | pack_mirrors(beyond), 0u);
    out_sun_show = vec4(frame.sun_direction, 1.0);
    out_place = vec4(tree_foot_rel(tree) + at, 0.0);
    gl_Position = SHADOW != 0u ? shadow_clip(push.cascade, out_place.xyz)
                               : frame.clip_from_rel * vec4(out_place.xyz, 1.0);
}
