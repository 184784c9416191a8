#version 460
/* A tree as crossed billboards. LISTED 0: vertex index / 12 (or 8) is the tree, so that any range in octree
 * order is one draw; LISTED 1: it is an index into the instances. SHADOW: one card that faces
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
layout(location = 5) flat out float out_lod;

/* Which upright card comes first (slot 0) and second among those that face the viewer most. */
uint facing_card(uint slot, vec2 toward)
{
    vec3 facing = abs(vec3(toward.y, 0.86602540378 * toward.x - 0.5 * toward.y,
                           0.86602540378 * toward.x + 0.5 * toward.y));
    uint least = facing.x <= facing.y && facing.x <= facing.z ? 0u : facing.y <= facing.z ? 1u : 2u;
    return (least + 1u + slot) % 3u;
}

/* Direction of an upright card's width. */
vec2 card_axis(uint card)
{
    return card == 0u   ? vec2(1.0, 0.0)
           : card == 1u ? vec2(0.5, 0.86602540378)
                        : vec2(-0.5, 0.86602540378);
}

struct card_corner {
    vec3 offset; /* from the foot */
    uint layer;  /* of the model's own */
    uint card;
    float share; /* of the card that shows at this angle */
    vec3 normal; /* toward the side that the card was rendered from */
};

/* As the sun sees the tree: as wide as the crown, as tall as stem and crown's depth together; the
 * silhouette is that from the side, or from above when the sun stands high. */
card_corner sun_corner(wd_model model, tree_pose pose, vec2 side)
{
    vec3 sun = frame.sun_direction;
    float level = length(sun.xy);
    vec2 across = level > 1e-3 ? vec2(-sun.y, sun.x) / level : vec2(1.0, 0.0);
    vec3 up = vec3(-across.y * sun.z, across.x * sun.z, level);
    float middle = 0.5 * (model.top_m + model.bottom_m) * pose.up;
    float tall = 0.5 * (model.top_m - model.bottom_m) * pose.up * level
                 + model.half_depth_m * pose.across * sun.z * 0.8;
    card_corner corner;
    corner.offset = vec3(0.0, 0.0, middle)
                    + vec3(across * (side.x * model.half_width_m * pose.across), 0.0)
                    - up * (side.y * tall);
    corner.layer = sun.z > 0.8 ? WD_CARD_SIDES : 0u;
    corner.card = 0u;
    corner.share = 1.0;
    corner.normal = sun;
    return corner;
}

card_corner level_corner(wd_model model, tree_pose pose, vec2 side, vec3 toward)
{
    card_corner corner;
    corner.offset = tree_offset(pose, vec3(side.x * model.half_depth_m, -side.y * model.half_depth_m,
                                           model.height_m * WD_CARD_TOP));
    corner.layer = corner.card = WD_CARD_SIDES;
    corner.normal = vec3(0.0, 0.0, 1.0);
    corner.share = smoothstep(WD_LEVEL_CARD_SINE, 0.6, abs(toward.z));
    return corner;
}

/* Cards seen edge on would streak: they go before that, and the others stand for them. */
card_corner upright_corner(wd_model model, tree_pose pose, uint slot, vec2 side, vec3 toward)
{
    vec2 own_toward = vec2(dot(toward.xy, pose.turn),
                           dot(toward.xy, vec2(-pose.turn.y, pose.turn.x))) * pose.mirror;
    card_corner corner;
    corner.card = corner.layer = facing_card(slot, own_toward);
    vec2 axis = tree_turn(pose, card_axis(corner.card));
    float z = side.y < 0.0 ? model.top_m : model.bottom_m;
    corner.offset = vec3(axis * (side.x * model.half_width_m * pose.across), z * pose.up);
    corner.normal = vec3(vec2(axis.y, -axis.x) * pose.mirror.x, 0.0);
    float facing = abs(dot(corner.normal.xy, toward.xy)) / max(length(toward.xy), 0.1);
    corner.share = smoothstep(0.5, 0.75, facing);
    return corner;
}

void main()
{
    uint per_tree = SHADOW != 0u ? WD_SHADOW_CARD_VERTICES : push.card_vertices;
    uint slot = uint(gl_VertexIndex) / per_tree, vertex = uint(gl_VertexIndex) - slot * per_tree;
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
    float distance_m = length(foot);
    vec3 toward = -normalize(foot + vec3(0.0, 0.0, 0.5 * WD_TREE_HEIGHT_M(tree)));
    vec2 side = vec2(float(vertex & 1u), float((vertex >> 1) & 1u)) * 2.0 - 1.0;
    card_corner corner;
    if (SHADOW != 0u)
        corner = sun_corner(model, pose, side);
    else if (vertex >= WD_UPRIGHT_VERTICES)
        corner = level_corner(model, pose, side, toward);
    else
        corner = upright_corner(model, pose, vertex / 4u, side, toward);
    corner.offset += tree_sway(tree, model.flexibility, corner.offset.z, frame.time_s);

    float tall_px = WD_TREE_HEIGHT_M(tree)
                    * (SHADOW != 0u ? 1.0 / frame.cascade_texel_m[push.cascade]
                                    : push.pixels_per_radian / distance_m);
    show *= wd_layer_show(fades[WD_TREE_LAYER(tree)], distance_m) * corner.share;
    out_uv = vec3(side * 0.5 + 0.5, float(model.card_layer + corner.layer));
    out_pose = vec4(pose.turn, pose.mirror.x, pose.up / pose.across);
    out_flip = dot(corner.normal, toward) < 0.0 ? corner.normal : vec3(0.0);
    out_tint = vec4(tree_tint(tree), show);
    out_lod = clamp(log2(WD_CARD_HEIGHT_TEXELS / max(tall_px, 1.0)), -1.0, 8.0);
    out_flat = uvec2(index + 1u, tree.random ^ (corner.card * 0x9e3779b9u));
    vec3 rel = foot + corner.offset;
    vec4 at = SHADOW != 0u ? shadow_clip(push.cascade, rel) : frame.clip_from_rel * vec4(rel, 1.0);
    gl_Position = show > 0.0 ? at : vec4(0.0, 0.0, 0.0, 1.0);
}
