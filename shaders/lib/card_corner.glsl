/* Geometry of a tree's crossed billboards. Expects `frame`, `push` (with cascade and
 * pixels_per_radian), SHADOW, tree.glsl and `fades`. */
#include "lib/card_flat.glsl"

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

/* One tree as its cards see it. */
struct card_tree {
    wd_tree tree;
    wd_model model;
    tree_pose pose;
    vec3 foot;   /* rel */
    vec3 toward; /* unit, from its middle to the eye */
    float show;  /* of its layer at this distance */
    float lod;
    float level; /* share of the level card: the upright ones have the rest */
};

/* The crown as an ellipsoid: its middle's height over the foot, half its width and half its height.
 * Seen from the elevation e its outline is sqrt(h^2 cos^2 e + w^2 sin^2 e) high. */
vec3 card_crown(card_tree t)
{
    float half_m = 0.5 * (t.model.height_m - t.model.crown_base_m) * t.pose.up;
    return vec3(t.model.height_m * t.pose.up - half_m, 0.5 * t.model.crown_m * t.pose.across, half_m);
}

float outline_half_m(vec3 crown, float sine)
{
    return sqrt(mix(crown.z * crown.z, crown.y * crown.y, sine * sine));
}

/* Factor on width and height of a picture that would cover `drawn_m2` of the tree. */
float card_growth(card_tree t, float sine, float drawn_m2)
{
    float wanted_m2 = wd_tree_seen_m2(t.model, t.pose.across, t.pose.up, sine);
    return sqrt(clamp(wanted_m2 / max(drawn_m2, 1e-9), 0.25, 4.0));
}

/* The more of what is seen of the crown is its top. */
float level_share(vec3 crown, float sine)
{
    float top = crown.y * sine / outline_half_m(crown, sine);
    return top * top * smoothstep(WD_LEVEL_CARD_SINE, 2.0 * WD_LEVEL_CARD_SINE, sine);
}

card_tree card_tree_of(wd_tree tree, wd_model model)
{
    card_tree t;
    t.tree = tree;
    t.model = model;
    t.pose = tree_pose_of(tree, model);
    t.foot = tree_foot_rel(tree);
    float height_m = WD_TREE_HEIGHT_M(tree), distance_m = length(t.foot);
    t.toward = -normalize(t.foot + vec3(0.0, 0.0, 0.5 * height_m));
    t.show = wd_layer_show(fades[WD_TREE_LAYER(tree)], distance_m);
    float tall_px = height_m * (SHADOW != 0u ? 1.0 / frame.cascades[push.cascade][WD_CASCADE_TEXEL_M]
                                             : push.pixels_per_radian / distance_m);
    t.lod = card_lod_of(model, t.pose.up / t.pose.across, tall_px);
    t.level = level_share(card_crown(t), abs(t.toward.z));
    return t;
}

/* A card as seen: its middle and half its width and height as offsets from the foot. */
struct card_frame {
    vec3 middle, across, down;
    vec3 normal; /* toward the side that the card was rendered from */
    uint layer;  /* of the model's own */
    float begin, share; /* of the tree's noise: the card's interval at this angle */
};

/* As the sun sees the tree: as wide as the crown, as tall as stem and crown's depth together; the
 * silhouette is that from the side, or from above when the sun stands high. */
card_frame sun_card(card_tree t)
{
    vec3 sun = frame.sun_direction;
    float level = length(sun.xy);
    vec2 across = level > 1e-3 ? vec2(-sun.y, sun.x) / level : vec2(1.0, 0.0);
    vec3 up = vec3(-across.y * sun.z, across.x * sun.z, level);
    float tall = 0.5 * (t.model.top_m - t.model.bottom_m) * t.pose.up * level
                 + t.model.half_depth_m * t.pose.across * sun.z * 0.8;
    card_frame card;
    card.middle = vec3(0.0, 0.0, 0.5 * (t.model.top_m + t.model.bottom_m) * t.pose.up);
    card.across = vec3(across * (t.model.half_width_m * t.pose.across), 0.0);
    card.down = up * -tall;
    card.layer = sun.z > 0.8 ? WD_CARD_SIDES : 0u;
    card.begin = 0.0;
    card.share = 1.0;
    card.normal = sun;
    return card;
}

/* Leans so that it faces the viewer, and as high as the crown's outline is. */
vec3 leaned(vec3 level, vec3 toward, float scale)
{
    float cosine = max(length(toward.xy), 1e-4);
    float along = dot(level.xy, toward.xy) / cosine;
    vec3 ahead = vec3(toward.xy / cosine, 0.0);
    vec3 down = ahead * abs(toward.z) - vec3(0.0, 0.0, cosine * sign(toward.z));
    return level + along * (scale * down - ahead);
}

card_frame level_card(card_tree t)
{
    float half_m = t.model.half_depth_m;
    vec3 crown = card_crown(t);
    float scale = outline_half_m(crown, t.toward.z) / crown.y;
    half_m *= card_growth(t, t.toward.z,
                          t.pose.across * t.pose.across * t.model.seen_m2.z * scale);
    card_frame card;
    card.middle = vec3(0.0, 0.0, crown.x);
    card.across = leaned(tree_offset(t.pose, vec3(half_m, 0.0, 0.0)), t.toward, scale);
    card.down = leaned(tree_offset(t.pose, vec3(0.0, -half_m, 0.0)), t.toward, scale);
    card.layer = WD_CARD_SIDES;
    card.normal = vec3(0.0, 0.0, 1.0);
    card.share = t.level;
    card.begin = 1.0 - t.level;
    return card;
}

/* How far a card faces the viewer, seen level. */
float card_facing(card_tree t, vec2 axis)
{
    return abs(axis.y * t.toward.x - axis.x * t.toward.y) / max(length(t.toward.xy), 0.1);
}

float facing_weight(float facing)
{
    return smoothstep(0.5, 0.75, facing);
}

/* Cards seen edge on would streak: they go before that, and the others stand for them. At a slant
 * they are drawn wider, and from above higher, by what the view takes away. */
card_frame upright_card(card_tree t, uint slot)
{
    vec2 own_toward = vec2(dot(t.toward.xy, t.pose.turn),
                           dot(t.toward.xy, vec2(-t.pose.turn.y, t.pose.turn.x))) * t.pose.mirror;
    card_frame card;
    card.layer = facing_card(slot, own_toward);
    vec2 axis = tree_turn(t.pose, card_axis(card.layer));
    vec2 other = tree_turn(t.pose, card_axis(facing_card(1u - slot, own_toward)));
    float facing = card_facing(t, axis), weight = facing_weight(facing);
    float weights = max(weight + facing_weight(card_facing(t, other)), 1e-4);
    card.share = (1.0 - t.level) * weight / weights;
    card.begin = slot == 0u ? 0.0 : 1.0 - t.level - card.share;

    vec3 crown = card_crown(t);
    float sine = min(abs(t.toward.z), 0.95);
    float drawn_m2 = t.pose.across * t.pose.up * t.model.seen_m2.x
                     * outline_half_m(crown, sine) / crown.z;
    float growth = card_growth(t, sine, drawn_m2);
    float higher = growth * outline_half_m(crown, sine) / (crown.z * sqrt(1.0 - sine * sine));
    float middle_m = 0.5 * (t.model.top_m + t.model.bottom_m) * t.pose.up;
    /* a long stem keeps its foot, a wide crown its middle */
    float fixed_m = crown.x * crown.y * crown.y / (crown.y * crown.y + crown.z * crown.z);
    card.middle = vec3(0.0, 0.0, fixed_m + (middle_m - fixed_m) * higher);
    card.across =
        vec3(axis * (growth * t.model.half_width_m * t.pose.across / max(facing, 0.6)), 0.0);
    card.down = vec3(0.0, 0.0, -0.5 * (t.model.top_m - t.model.bottom_m) * t.pose.up * higher);
    card.normal = vec3(vec2(axis.y, -axis.x) * t.pose.mirror.x, 0.0);
    return card;
}

/* Slot 0 and 1: the upright ones; 2: the level one. */
card_frame card_at(card_tree t, uint slot)
{
    if (SHADOW != 0u)
        return sun_card(t);
    if (slot >= WD_UPRIGHT_VERTICES / 4u)
        return level_card(t);
    return upright_card(t, slot);
}

/* Corner `side` (x right, y down, -1..1) in clip space. */
vec4 card_clip(card_tree t, card_frame card, vec2 side)
{
    vec3 offset = card.middle + card.across * side.x + card.down * side.y;
    offset += tree_bend(tree_wind(), t.tree, t.model.flexibility, offset.z, frame.time_s);
    vec3 rel = t.foot + offset;
    return SHADOW != 0u ? shadow_clip(push.cascade, rel)
                        : frame.clip_from_rel * vec4(card_over_ground(rel, t.foot), 1.0);
}

/* `show` is that of the level of detail. */
wd_card_flat card_constants(card_tree t, card_frame card, uint index, float show)
{
    card_flat result;
    result.turn = t.pose.turn;
    result.tint = tree_tint(t.tree, t.model);
    result.show = show * t.show * card.share;
    result.normal = card.normal;
    result.behind = dot(card.normal, t.toward) < 0.0;
    result.mirror = t.pose.mirror.x;
    result.ratio = t.pose.up / t.pose.across;
    result.layer = t.model.card_layer + card.layer;
    result.lies = card_lies(t.model);
    result.lod = t.lod;
    result.random = SHADOW != 0u ? wd_tree_random(t.tree) ^ (card.layer * 0x9e3779b9u)
                                 : card_noise_shift(t.tree, t.foot) | uint(card.begin * 255.0 + 0.5) << 8;
    result.surface = index + 1u;
    result.mixed = t.model.mixed;
    bool from_above = card.layer == WD_CARD_SIDES;
    result.to_leaf = wood_to_leaf(t.model, t.toward.z, from_above);
    result.base = crown_begins(t.model, from_above);
    result.hides = crown_hides(t.model, t.toward.z, result.base);
    return card_pack(result);
}
