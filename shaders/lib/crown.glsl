/* Light inside a tree's crown without tracing it: depth along the sun (Guerrero 2006, section 5).
 * The crown is an ellipsoid of leaves; light falls off with the way it has come through it.
 * Expects `frame` and lib/tree.glsl. */
#include "shared/crown.h"

struct wd_crown {
    vec3 center_rel;
    vec3 radii_m;
    float foot_z; /* rel */
    float sward;  /* 1 where the plant is one of low or dense grasses that close over the ground, and have no
                     sides that light could come in by */
    float told;   /* how far its model's tables tell its light (shared/sunlit.h) */
};

wd_crown crown_of(wd_tree tree, wd_lit_leaves model)
{
    float height_m = WD_TREE_HEIGHT_M(tree), radius_m = WD_TREE_CROWN_M(tree) * 0.5;
    float base_m = unpackHalf2x16(model.base_petals).x * height_m;
    vec3 foot_rel = tree_foot_rel(tree);
    wd_crown crown;
    crown.foot_z = foot_rel.z;
    crown.center_rel = foot_rel + vec3(0.0, 0.0, 0.5 * (height_m + base_m));
    crown.radii_m = max(vec3(radius_m, radius_m, 0.5 * (height_m - base_m)), vec3(0.1));
    float roughness = unpackHalf2x16(model.rough_flat).x;
    float closes = roughness <= -1.0 ? 1.0 : 1.0 - smoothstep(0.22, 0.35, crown.radii_m.z);
    crown.sward = roughness < 0.0 ? closes : 0.0;
    crown.told = 0.0;
    return crown;
}

/* 1 of a tree or shrub, 0 of a herb: few of a herb's leaves lie behind others. */
float is_tree(wd_crown crown)
{
    return smoothstep(0.5, 1.0, crown.radii_m.z);
}

/* Metres of leaves over a place in a sward. */
float sward_depth_m(wd_crown crown, vec3 rel)
{
    return clamp(crown.center_rel.z + crown.radii_m.z - rel.z, 0.0, 2.0 * crown.radii_m.z);
}

/* Of a crown an eye outside sees leaves that lie open to it, so to the sky behind it, too. One among the leaves sees any
 * that are near: how far what it sees lies open, by what the crown leaves of the way on past the eye. */
float eye_outside(wd_crown crown, vec3 eye)
{
    float past_eye_m = wd_crown_path_m(-crown.center_rel, crown.radii_m, eye);
    return exp(-wd_crown_per_m(crown.radii_m) * past_eye_m);
}

/* Where a crown is between a place and the sun. */
wd_crown_way crown_way(wd_crown crown, vec3 rel)
{
    wd_crown_way way = wd_crown_way_of(rel - crown.center_rel, crown.radii_m, frame.sun_direction);
    float level_m = sward_depth_m(crown, rel) / max(frame.sun_direction.z, 0.05);
    way.begins_m *= 1.0 - crown.sward;
    way.ends_m = mix(way.ends_m, level_m, crown.sward);
    return way;
}

/* Metres from a place toward the sun until the card is left behind that stands for the tree in coarse shadow
 * maps: across the sun's rays, through the middle of its height. */
float crown_card_m(wd_crown crown, vec3 rel)
{
    vec3 middle = crown.center_rel;
    middle.z = 0.5 * (middle.z + crown.radii_m.z + crown.foot_z);
    return dot(middle - rel, frame.sun_direction);
}

/* The same for a sward, whose leaves the eye meets by a, the sun by b a metre of depth: of those seen
 * a / (a + b) are lit. Where that share of the sun is left: */
float sward_card_height_m(wd_crown crown, vec3 direction)
{
    float sun = max(frame.sun_direction.z, 0.05);
    float depth_m = sun / wd_crown_per_m(crown.radii_m) * log(1.0 + abs(direction.z) / (1.5 * sun));
    return crown.center_rel.z + crown.radii_m.z - depth_m;
}

/* Where what a card shows is lit. */
vec3 crown_card_place(wd_crown crown, vec3 direction)
{
    vec3 within = wd_crown_card_place(crown.center_rel, crown.radii_m, direction);
    within.z = mix(within.z, sward_card_height_m(crown, direction), crown.sward);
    return within;
}

/* The crown's outward direction at a place: the smooth normal of its ellipsoid. */
vec3 crown_normal(wd_crown crown, vec3 rel)
{
    vec3 q = (rel - crown.center_rel) / (crown.radii_m * crown.radii_m);
    return normalize(q + vec3(0.0, 0.0, 1e-4));
}
