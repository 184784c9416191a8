#version 460
/* A tree as crossed billboards. LISTED 0: vertex index / 16 is the tree, so that any range in octree
 * order is one draw; LISTED 1: it is an index into the instances. SHADOW: two cards, one turned to
 * the sun. */
#include "shared/frame.h"
#include "shared/forest.h"

layout(constant_id = 0) const uint SHADOW = 0u;
layout(constant_id = 1) const uint LISTED = 0u;

layout(scalar, set = 0, binding = 0) readonly buffer Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 1) readonly buffer Trees { wd_tree trees[]; };
layout(scalar, set = 0, binding = 2) readonly buffer Models { wd_model models[]; };
layout(scalar, set = 0, binding = 3) readonly buffer Instances { wd_instance instances[]; };
layout(scalar, set = 0, binding = 6) readonly buffer Fades { wd_layer_fade fades[]; };
layout(scalar, push_constant) uniform Push { wd_tree_push push; };

#include "lib/tree.glsl"

layout(location = 0) out vec3 out_uv; /* z: layer */
layout(location = 1) flat out vec4 out_pose; /* turn; mirror in x; vertical over horizontal scale */
layout(location = 2) flat out vec4 out_tint; /* a: show */
layout(location = 3) flat out uvec2 out_flat; /* surface, random */
layout(location = 4) flat out vec3 out_flip; /* unit normal of a card seen from behind, else 0 */

const uint PER_TREE = SHADOW != 0u ? WD_SHADOW_CARD_VERTICES : WD_CARD_VERTICES;

/* Direction of an upright card's width. */
vec2 card_axis(uint card)
{
    return card == 0u   ? vec2(1.0, 0.0)
           : card == 1u ? vec2(0.5, 0.86602540378)
                        : vec2(-0.5, 0.86602540378);
}

void main()
{
    uint slot = uint(gl_VertexIndex) / PER_TREE, corner = uint(gl_VertexIndex) % PER_TREE;
    uint index = slot;
    float show = push.show;
    if (LISTED != 0u) {
        index = instances[slot].tree;
        show = instances[slot].show;
    }
    wd_tree tree = trees[index];
    wd_model model = models[WD_TREE_SPECIES(tree) * push.variants
                            + WD_TREE_VARIANT(tree) % push.variants];
    tree_pose pose = tree_pose_of(tree, model);
    vec3 foot = tree_foot_rel(tree);
    vec3 eye = SHADOW != 0u ? frame.sun_direction : -(foot + vec3(0, 0, 0.5 * WD_TREE_HEIGHT_M(tree)));
    vec3 toward = normalize(eye);
    uint card = corner / 4u;
    vec2 side = vec2(float(corner & 1u), float((corner >> 1) & 1u)) * 2.0 - 1.0;
    bool level = SHADOW != 0u ? card == 1u : card == WD_CARD_SIDES;
    uint layer = model.card_layer;
    vec3 offset;
    vec2 axis;
    vec3 normal; /* toward the side that the card was rendered from */
    vec2 uv = side * 0.5 + 0.5;
    if (level) {
        layer += WD_CARD_SIDES;
        axis = tree_turn(pose, vec2(1.0, 0.0));
        offset = tree_offset(pose, vec3(side.x * model.half_depth_m, -side.y * model.half_depth_m,
                                        model.height_m * WD_CARD_TOP));
        normal = vec3(0.0, 0.0, 1.0);
    } else {
        vec2 own = card_axis(card);
        if (SHADOW != 0u) {
            vec2 sun = frame.sun_direction.xy;
            axis = dot(sun, sun) > 1e-6 ? normalize(vec2(-sun.y, sun.x)) : vec2(1.0, 0.0);
        } else {
            layer += card;
            axis = tree_turn(pose, own);
        }
        float z = side.y < 0.0 ? model.top_m : model.bottom_m;
        offset = vec3(axis * side.x * model.half_width_m * pose.across, z * pose.up);
        normal = vec3(vec2(axis.y, -axis.x) * pose.mirror.x, 0.0);
    }
    offset += tree_sway(tree, model.flexibility, offset.z, frame.time_s);
    /* Cards seen edge on would streak: they go before that, and the others stand for them. */
    float facing = dot(normal, toward);
    float share = level ? smoothstep(0.25, 0.6, abs(facing)) : smoothstep(0.10, 0.45, abs(facing));
    if (SHADOW != 0u)
        share = 1.0;
    show *= wd_layer_show(fades[WD_TREE_LAYER(tree)], length(foot));
    out_uv = vec3(uv, float(layer));
    out_pose = vec4(pose.turn, pose.mirror.x, pose.up / pose.across);
    out_flip = facing < 0.0 ? normal : vec3(0.0);
    out_tint = vec4(tree_tint(tree), show * share);
    out_flat = uvec2(index + 1u, tree.random ^ (card * 0x9e3779b9u));
    vec4 at = SHADOW != 0u ? shadow_clip(push.cascade, foot + offset)
                           : frame.clip_from_rel * vec4(foot + offset, 1.0);
    gl_Position = out_tint.a > 0.0 ? at : vec4(0.0, 0.0, 0.0, 1.0);
}
