/* Billboards that face the eye, with the pictures of a model's cards. Expects `frame` and
 * lib/tree.glsl. */
#include "lib/card_flat.glsl"

struct wd_billboard {
    vec3 offset; /* of the corner from the tree's foot, at rest */
    vec2 uv;
    uint card;   /* of the model's own */
    vec3 normal; /* unit, toward the side that the picture was taken from */
    bool behind; /* the tree is seen from the other side */
};

/* Which of the upright cards was rendered from nearest to that side (unit, the tree's own frame). */
uint nearest_card(vec2 toward)
{
    vec3 facing = abs(vec3(toward.y, 0.86602540378 * toward.x - 0.5 * toward.y,
                           0.86602540378 * toward.x + 0.5 * toward.y));
    return facing.x >= facing.y && facing.x >= facing.z ? 0u : facing.y >= facing.z ? 1u : 2u;
}

/* Factor on width and height with which a billboard `tall_m` high, from its middle, covers what the tree
 * does. */
float billboard_growth(wd_model model, tree_pose pose, float tall_m, float sine, bool from_above)
{
    float half_m = 0.5 * (model.top_m - model.bottom_m) * pose.up;
    float drawn_m2 = from_above ? pose.across * model.seen_m2.z * model.half_width_m * tall_m
                                      / (model.half_depth_m * model.half_depth_m)
                                : pose.across * pose.up * model.seen_m2.x * tall_m / half_m;
    float wanted_m2 = wd_tree_seen_m2(model, pose.across, pose.up, sine);
    return sqrt(clamp(wanted_m2 / max(drawn_m2, 1e-9), 0.25, 4.0));
}

/* Corner `side` (-1..1 right, -1..1 down) of the billboard seen from `toward` (unit). It is as tall
 * as stem and crown's depth together look from there. `one_view`: the first card's picture whatever
 * the side. */
wd_billboard billboard_corner(wd_model model, tree_pose pose, vec3 toward, vec2 side, bool one_view)
{
    float level = max(length(toward.xy), 1e-3);
    vec2 across = vec2(-toward.y, toward.x) / level;
    vec3 up = vec3(-toward.xy * (toward.z / level), level);
    bool from_above = toward.z > 0.8 && !one_view;
    vec2 own_toward = vec2(dot(toward.xy, pose.turn),
                           dot(toward.xy, vec2(-pose.turn.y, pose.turn.x))) * pose.mirror / level;
    wd_billboard board;
    board.card = from_above ? WD_CARD_SIDES : one_view ? 0u : nearest_card(own_toward);
    float angle = 1.0471975512 * float(board.card);
    vec2 axis = tree_turn(pose, vec2(cos(angle), sin(angle)));
    board.normal = from_above ? vec3(0.0, 0.0, 1.0)
                              : vec3(vec2(axis.y, -axis.x) * pose.mirror.x, 0.0);
    board.behind = dot(board.normal, toward) < 0.0;
    float mirror = dot(axis, across) < 0.0 && !from_above && !one_view ? -1.0 : 1.0;
    float middle_m = 0.5 * (model.top_m + model.bottom_m) * pose.up;
    float tall_m = 0.5 * (model.top_m - model.bottom_m) * pose.up * level
                   + model.half_depth_m * pose.across * abs(toward.z) * 0.8;
    float growth = billboard_growth(model, pose, tall_m, abs(toward.z), from_above);
    middle_m += (growth - 1.0) * tall_m * level; /* the foot keeps its place */
    board.offset = vec3(across * (side.x * growth * model.half_width_m * pose.across), middle_m)
                   - up * (side.y * growth * tall_m);
    board.uv = card_picture_uv(vec2(side.x * mirror, side.y) * 0.5 + 0.5, card_lies(model));
    return board;
}

/* What its fragments need, as those of cards; `tall_px`: the tree's height on screen; `sine`: of the eye's elevation. */
wd_card_flat billboard_flat(wd_billboard board, wd_model model, tree_pose pose, wd_tree tree,
                            float show, float tall_px, float sine, uint surface)
{
    card_flat constants;
    constants.turn = pose.turn;
    constants.tint = tree_tint(tree, model);
    constants.show = show;
    constants.normal = board.normal;
    constants.behind = board.behind;
    constants.mirror = pose.mirror.x;
    constants.ratio = pose.up / pose.across;
    constants.layer = model.card_layer + board.card;
    constants.lies = card_lies(model);
    constants.lod = card_lod_of(model, constants.ratio, tall_px);
    constants.random = wd_tree_random(tree) ^ (board.card * 0x9e3779b9u);
    constants.surface = surface;
    constants.mixed = model.mixed;
    bool from_above = board.card == WD_CARD_SIDES;
    constants.to_leaf = wood_to_leaf(model, sine, from_above);
    constants.base = crown_begins(model, from_above);
    constants.hides = crown_hides(model, sine, constants.base);
    return card_pack(constants);
}
