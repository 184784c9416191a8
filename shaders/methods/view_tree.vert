#version 460
/* A tree as a quad that faces the eye, onto which its pictures from around that direction go
 * (Sterling and Justin, rows R3, R4, R6; Bruneton and Neyret 2012). DEPTH: the quad holds all that
 * the tree's cylinder shows in perspective; what is seen follows from the pictures' depths. */
#include "shared/frame.h"
#include "shared/canopy_map.h"
#include "shared/view_draw.h"

layout(constant_id = 0) const uint DEPTH = 0u;

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 1) readonly buffer Trees { wd_packed_tree trees[]; };
layout(scalar, set = 0, binding = 2) readonly buffer Models { wd_model models[]; };
layout(scalar, set = 0, binding = 3) readonly buffer Instances { wd_instance instances[]; };
layout(scalar, set = 0, binding = 4) readonly buffer Fades { wd_layer_fade fades[]; };
layout(scalar, set = 0, binding = 5) readonly buffer ViewModels { wd_view_model view_models[]; };
layout(scalar, push_constant) uniform Push { wd_view_push push; };

#include "lib/trees.glsl"
#include "lib/tree.glsl"

layout(location = 0) out vec3 out_model;      /* place on the quad, the model's own metres */
layout(location = 1) out vec2 out_side;       /* -1..1 right and down */
layout(location = 2) flat out vec3 out_eye;   /* in the model's frame */
layout(location = 3) flat out vec4 out_pose;  /* turn; mirrored across; up */
layout(location = 4) flat out vec4 out_foot;  /* rel; lod */
layout(location = 5) flat out vec4 out_tint;  /* a: show */
layout(location = 6) flat out uvec4 out_flat; /* surface, random, model, views (10 bits each) */
layout(location = 7) flat out vec3 out_weights;
layout(location = 8) flat out vec3 out_toward[3]; /* of the views */

vec3 model_place(tree_pose pose, vec3 offset)
{
    vec2 back = vec2(dot(offset.xy, pose.turn), dot(offset.xy, vec2(-pose.turn.y, pose.turn.x)));
    return vec3(back * pose.mirror / pose.across, offset.z / pose.up);
}

/* How much larger the nearest parts of the tree look than its middle. */
float enlarged(wd_view_frame view, float distance_m)
{
    return 1.0 + min(view.half_depth_m / max(distance_m - view.half_depth_m, 1.0), 1.0);
}

void main()
{
    wd_instance instance = instances[gl_VertexIndex / 4];
    wd_tree tree = tree_at(instance.tree);
    uint index = WD_TREE_SPECIES(tree) * push.variants
                 + WD_TREE_VARIANT(tree) % push.variants % push.baked_variants;
    wd_model model = models[index];
    wd_view_model picture = view_models[index];
    tree_pose pose = tree_pose_of(tree, model);
    vec3 foot = tree_foot_rel(tree), eye = model_place(pose, -foot);
    vec3 toward = eye - vec3(0.0, 0.0, 0.5 * (picture.top_m + picture.bottom_m));
    float model_distance_m = length(toward), distance_m = length(foot);
    toward /= model_distance_m;

    wd_direction direction = wd_direction(toward.x, toward.y, toward.z);
    wd_view_frame view = wd_view_frame_of(picture, direction);
    vec2 side = vec2(float(gl_VertexIndex & 1), float((gl_VertexIndex >> 1) & 1)) * 2.0 - 1.0;
    vec2 reach = side * (DEPTH != 0u ? enlarged(view, model_distance_m) : 1.0);
    vec3 right = vec3(view.right.x, view.right.y, view.right.z);
    vec3 up = vec3(view.up.x, view.up.y, view.up.z);
    vec3 place = vec3(0.0, 0.0, view.middle_m) + right * (reach.x * view.half_width_m)
                 - up * (reach.y * view.half_height_m);
    vec3 offset = tree_offset(pose, place);
    offset += tree_sway(tree, model.flexibility, max(offset.z, 0.0), frame.time_s);

    wd_view_blend blend;
    if (push.nearest != 0u) {
        uint nearest = wd_hemisphere_nearest(push.atlas.hemisphere, direction);
        blend.view = uint[3](nearest, nearest, nearest);
        blend.weight = float[3](1.0, 0.0, 0.0);
    } else {
        blend = wd_hemisphere_blend(push.atlas.hemisphere, direction);
    }
    float tall_px = 2.0 * view.half_height_m * pose.up * push.pixels_per_radian / distance_m;
    float wide_px = 2.0 * view.half_width_m * pose.across * push.pixels_per_radian / distance_m;
    float lod = clamp(log2(float(push.atlas.size) / max(sqrt(tall_px * wide_px), 0.1)), -2.0,
                      float(push.atlas.mips - 1u));
    float show = instance.show * wd_layer_show(fades[WD_TREE_LAYER(tree)], distance_m);
    if (push.range_m > 0.0)
        show *= wd_canopy_trees(push.range_m, push.fade, distance_m);
    out_model = place;
    out_side = reach;
    out_eye = eye;
    out_pose = vec4(pose.turn, pose.mirror.x * pose.across, pose.up);
    out_foot = vec4(foot, lod);
    out_tint = vec4(tree_tint(tree, model), show);
    out_flat = uvec4(instance.tree + 1u, wd_tree_random(tree), index,
                     blend.view[0] | blend.view[1] << 10 | blend.view[2] << 20);
    for (uint i = 0u; i < 3u; i++) {
        wd_direction d = wd_hemisphere_direction(push.atlas.hemisphere, blend.view[i]);
        out_toward[i] = vec3(d.x, d.y, d.z);
    }
    out_weights = vec3(blend.weight[0], blend.weight[1], blend.weight[2]);
    gl_Position = show > 0.0 ? frame.clip_from_rel * vec4(foot + offset, 1.0)
                             : vec4(0.0, 0.0, 0.0, 1.0);
}
