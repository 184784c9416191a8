#version 460
/* Leaves or flowers of a tree: each a form of its species in its own place. No branch hangs on the leaf:
 * see lib/tree_mesh.glsl. */
#include "shared/frame.h"
#include "shared/forest.h"
#include "shared/hash.h"
#include "shared/sun_ways.h"
#include "shared/fall.h"

layout(constant_id = 0) const uint SHADOW = 0u;
layout(constant_id = 1) const uint LISTED = 0u; /* 1: of a full mesh, of which some leaves are drawn */
layout(constant_id = 2) const uint FALLS = 0u; /* 1: leaves are on their way down */

layout(scalar, set = 0, binding = 0) readonly buffer Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 1) readonly buffer Trees { wd_packed_tree trees[]; };
layout(scalar, set = 0, binding = 2) readonly buffer Models { wd_model models[]; };
layout(scalar, set = 0, binding = 3) readonly buffer Corners { wd_leaf_vertex corners[]; };
layout(scalar, set = 0, binding = 4) readonly buffer Instances { wd_instance instances[]; };
layout(scalar, set = 0, binding = 7) readonly buffer Leaves { wd_tree_leaf leaves[]; };
layout(scalar, set = 0, binding = 8) readonly buffer Listed { uint listed[]; };
layout(scalar, push_constant) uniform Push { wd_mesh_push mesh; };

#include "lib/trees.glsl"
#include "lib/tree.glsl"
#include "lib/tree_vertex.glsl"
#define push mesh.tree /* the libraries' name for it; lib/tree.glsl has others of its own */
#include "lib/mirror.glsl"
#include "lib/tree_mesh.glsl"

#define GROWTH(table, k)                                                                           \
    wd_side_mix(models[model].table.of[0][k], models[model].table.of[1][k],                        \
                models[model].table.of[2][k], sine)

/* Between the shares that the tables have, seen from elevation asin(sine). */
float leaf_growth(uint model, float share, float sine)
{
    float at = min(log2(1.0 / share), float(WD_LEAF_GROWTHS - 1));
    uint k = min(uint(at), WD_LEAF_GROWTHS - 2u);
    bool full = push.level == WD_LEVEL_MESH;
    float more = full ? GROWTH(full_growth, k) : GROWTH(reduced_growth, k);
    float fewer = full ? GROWTH(full_growth, k + 1u) : GROWTH(reduced_growth, k + 1u);
    return mix(more, fewer, at - float(k));
}

/* Factor on a leaf's size, 0 where it is not drawn: it may be drawn as a twig, or thinned out. The growth that makes up
 * for those left out is of leaves as they hang: falling ones lie in any way. */
float settle_leaf(uint index, vec3 foot_m, wd_tree tree, uint model)
{
    tree_pose pose = tree_pose_of(tree, models[model]);
    vec3 at_m = tree_foot_rel(tree) + tree_offset(pose, foot_m);
    float far_m = length(at_m);
    float sine = SHADOW != 0u ? frame.sun_direction.z : at_m.z / far_m;
    float sprays = wd_spray_share(far_m, max(push.spray_reach, 1e-6));
    bool twig = LISTED != 0u && wd_spray_chance(index, wd_tree_random(tree)) < sprays;
    float share = wd_leaf_stand(push.leaf_m * pose.across * push.pixels_per_radian / far_m,
                                push.leaf_most, pose.across);
    bool thin = float(index) >= share * float(push.leaf_count);
    float grown = inversesqrt(share) * (FALLS != 0u ? 1.0 : leaf_growth(model, share, sine));
    grown = thin ? 0.0 : grown;
    grown = push.leaf_count != 0u ? grown : 1.0; /* fronds do not thin out */
    return twig ? 0.0 : grown;
}

void main()
{
    wd_instance instance = instances[gl_InstanceIndex];
    wd_tree tree = tree_at(instance.tree);
    uint model_index =
        WD_TREE_SPECIES(tree) * push.variants + WD_TREE_VARIANT(tree) % push.variants;
    wd_model model = models[model_index];
    uint index = uint(gl_VertexIndex) >> mesh.corner_bits;
    if (LISTED != 0u)
        index = listed[index];
    uint at = uint(gl_VertexIndex) & ((1u << mesh.corner_bits) - 1u);
    wd_tree_leaf leaf = leaves[mesh.first_leaf + index];
    uint form = mesh.forms > 1u ? WD_LEAF_FORM(leaf) : 0u;
    wd_leaf_vertex v = corners[mesh.first_corner + form * mesh.corner_count + at];
    vec3 foot = wd_leaf_foot(leaf, mesh.box);
    float grown = settle_leaf(index, foot, tree, model_index);
    wd_leaf_axes axes = wd_leaf_axes_of(leaf.turn);
    mat3 turn = mat3(axes.across, axes.along, axes.above);
    vec3 place = v.place;
    place.z *= mesh.arch_least + mesh.arch_range * WD_LEAF_ARCH(leaf);
    place.y += 0.5 / max(grown, 1e-3) - 0.5; /* it grows about its middle */
    mesh_corner corner;
    corner.position_m = foot + turn * place * (grown * wd_leaf_size_m(leaf, mesh.box));
    vec3 shading = wd_leaf_shading(leaf.shading);
    vec3 own = turn * octahedral_decode(unpackSnorm2x16(v.normal));
    corner.normal = normalize(mix(shading, dot(own, shading) < 0.0 ? -own : own, mesh.own));
    corner.face = axes.above;
    corner.uv = unpackHalf2x16(v.uv);
    corner.tint = unpackUnorm4x8(leaf.tint);
    corner.kind = (v.kind & ~0xffu) | min(WD_LEAF_FLEXIBILITY(leaf) + (v.kind & 0xffu), 255u);
    corner.name = mesh.first_name + index * mesh.corner_count + at;
    corner.open = leaf.open;
    corner.lets = 1.0;
    if (FALLS != 0u) {
        wd_leaf_fall fall = wd_leaf_fall_of(foot, model, wd_tree_pose_of(tree, model), tree_wind(),
                                            wd_hash2(index, wd_tree_random(tree)), frame.time_s);
        corner.position_m = fall.foot_m + wd_leaf_fall_turn(fall, corner.position_m - foot);
        corner.normal = wd_leaf_fall_turn(fall, corner.normal);
    }
    tree_mesh_vertex(instance, tree, model, corner);
    gl_Position = grown == 0.0 ? vec4(0.0, 0.0, 0.0, 1.0) : gl_Position;
}
