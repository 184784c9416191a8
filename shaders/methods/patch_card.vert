#version 460
/* Trees of a patch as billboards that face the eye, back to front (shared/patch_order.h). The
 * patch's table holds, for every cell, where its trees begin, then the trees. */
#include "shared/frame.h"
#include "shared/forest.h"
#include "shared/patch_order.h"

layout(scalar, set = 0, binding = 0) readonly buffer Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 1) readonly buffer Trees { wd_tree trees[]; };
layout(scalar, set = 0, binding = 2) readonly buffer Models { wd_model models[]; };
layout(scalar, set = 0, binding = 3) readonly buffer Table { uint table[]; };
layout(scalar, set = 0, binding = 6) readonly buffer Fades { wd_layer_fade fades[]; };
/* by layer: billboards are nothing nearer than x, whole beyond y */
layout(scalar, set = 0, binding = 9) readonly buffer Near { vec2 near_m[]; };
layout(scalar, push_constant) uniform Push { wd_patch_push push; };

#include "lib/tree.glsl"

#include "lib/card_flat.glsl"

/* as tree_card.vert */
layout(location = 0) out vec2 out_uv;
layout(location = 1) flat out uvec4 out_card;
layout(location = 2) flat out uvec3 out_more;

/* The tree at that place in the order, or -1. */
int tree_at(uint place)
{
    if (push.slots == 0u)
        return int(table[place]);
    uint index = place / push.slots, slot = place - index * push.slots;
    uint cell = wd_patch_cell(push.order, index);
    uint first = table[cell], end = table[cell + 1u];
    if (first + slot >= end)
        return -1;
    return int(table[push.order.columns * push.order.rows + 1u + first + slot]);
}

float shown(wd_tree tree, float distance_m)
{
    vec2 near = near_m[WD_TREE_LAYER(tree)];
    float show = wd_layer_show(fades[WD_TREE_LAYER(tree)], distance_m)
                 * wd_ramp(near.x, near.y, distance_m);
    return push.whole_fades != 0u ? floor(show) : show;
}

/* Which of the upright cards was rendered from nearest to that side (unit, the tree's own frame). */
uint nearest_card(vec2 toward)
{
    vec3 facing = abs(vec3(toward.y, 0.86602540378 * toward.x - 0.5 * toward.y,
                           0.86602540378 * toward.x + 0.5 * toward.y));
    return facing.x >= facing.y && facing.x >= facing.z ? 0u : facing.y >= facing.z ? 1u : 2u;
}

void main()
{
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
    int index = tree_at(uint(gl_VertexIndex) / 4u);
    if (index < 0)
        return;
    wd_tree tree = trees[index];
    wd_model model = models[WD_TREE_SPECIES(tree) * push.light.variants
                            + WD_TREE_VARIANT(tree) % push.light.variants];
    vec3 foot = tree_foot_rel(tree);
    float distance_m = length(foot), show = shown(tree, distance_m);
    if (show <= 0.0)
        return;
    tree_pose pose = tree_pose_of(tree, model);
    vec2 side = vec2(float(gl_VertexIndex & 1), float((gl_VertexIndex >> 1) & 1)) * 2.0 - 1.0;
    vec3 toward = -normalize(foot + vec3(0.0, 0.0, 0.5 * WD_TREE_HEIGHT_M(tree)));
    float level = max(length(toward.xy), 1e-3);
    vec2 across = vec2(-toward.y, toward.x) / level;
    vec3 up = vec3(-toward.xy * (toward.z / level), level);

    bool from_above = toward.z > 0.8;
    vec2 own_toward = vec2(dot(toward.xy, pose.turn),
                           dot(toward.xy, vec2(-pose.turn.y, pose.turn.x))) * pose.mirror / level;
    uint card = from_above ? WD_CARD_SIDES : nearest_card(own_toward);
    float angle = 1.0471975512 * float(card);
    vec2 axis = tree_turn(pose, vec2(cos(angle), sin(angle)));
    vec3 normal = from_above ? vec3(0.0, 0.0, 1.0)
                             : vec3(vec2(axis.y, -axis.x) * pose.mirror.x, 0.0);
    float mirror = dot(axis, across) < 0.0 && !from_above ? -1.0 : 1.0;

    /* as tall as stem and crown's depth together look from there */
    float middle_m = 0.5 * (model.top_m + model.bottom_m) * pose.up;
    float tall_m = 0.5 * (model.top_m - model.bottom_m) * pose.up * level
                   + model.half_depth_m * pose.across * abs(toward.z) * 0.8;
    vec3 offset = vec3(across * (side.x * model.half_width_m * pose.across), middle_m)
                  - up * (side.y * tall_m);
    offset += tree_sway(tree, model.flexibility, max(offset.z, 0.0), frame.time_s);

    card_flat constants;
    constants.turn = pose.turn;
    constants.tint = tree_tint(tree);
    constants.show = show;
    constants.normal = normal;
    constants.behind = dot(normal, toward) < 0.0;
    constants.mirror = pose.mirror.x;
    constants.ratio = pose.up / pose.across;
    constants.layer = model.card_layer + card;
    float tall_px = WD_TREE_HEIGHT_M(tree) * push.pixels_per_radian / distance_m;
    constants.lod = clamp(log2(WD_CARD_HEIGHT_TEXELS / max(tall_px, 1.0)), -1.0, 8.0);
    constants.random = tree.random ^ (card * 0x9e3779b9u);
    constants.surface = uint(index) + 1u;
    wd_card_flat packed = card_pack(constants);
    out_uv = vec2(side.x * mirror, side.y) * 0.5 + 0.5;
    out_card = uvec4(packed.turn, packed.tint_show, packed.normal, packed.ratio_flags);
    out_more = uvec3(packed.layer_lod, packed.random, packed.surface);
    gl_Position = frame.clip_from_rel * vec4(foot + offset, 1.0);
}
