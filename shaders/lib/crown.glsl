/* Light inside a tree's crown without tracing it: depth along the sun (Guerrero 2006, section 5).
 * The crown is an ellipsoid of leaves; light falls off with the way it has come through it.
 * Expects `frame` and lib/tree.glsl. */

struct wd_crown {
    vec3 center_rel;
    vec3 radii_m;
    float foot_z; /* rel */
};

wd_crown crown_of(wd_tree tree, wd_model model)
{
    float height_m = WD_TREE_HEIGHT_M(tree), radius_m = WD_TREE_CROWN_M(tree) * 0.5;
    float base_m = model.crown_base_m * height_m / model.height_m;
    vec3 foot_rel = tree_foot_rel(tree);
    wd_crown crown;
    crown.foot_z = foot_rel.z;
    crown.center_rel = foot_rel + vec3(0.0, 0.0, 0.5 * (height_m + base_m));
    crown.radii_m = max(vec3(radius_m, radius_m, 0.5 * (height_m - base_m)), vec3(0.1));
    return crown;
}

/* Grasses close over the ground: 1 where a plant is one of such a layer, which has no sides that light
 * could come in by. */
float crown_is_sward(wd_crown crown)
{
    return 1.0 - smoothstep(0.22, 0.35, crown.radii_m.z);
}

/* Metres of leaves over a place in a sward. */
float sward_depth_m(wd_crown crown, vec3 rel)
{
    return clamp(crown.center_rel.z + crown.radii_m.z - rel.z, 0.0, 2.0 * crown.radii_m.z);
}

/* Metres of crown between a place and the sun; leaves without the ellipsoid are taken to stand on
 * it, the stem below where it is. */
float crown_path_m(wd_crown crown, vec3 rel)
{
    vec3 q = (rel - crown.center_rel) / crown.radii_m;
    q /= q.z < -1.0 ? 1.0 : max(length(q), 1.0);
    vec3 s = frame.sun_direction / crown.radii_m;
    float ss = dot(s, s), qs = dot(q, s);
    float root = sqrt(max(qs * qs - ss * (dot(q, q) - 1.0), 0.0));
    float path_m = (max(root - qs, 0.0) - max(-root - qs, 0.0)) / ss;
    float level_m = sward_depth_m(crown, rel) / max(frame.sun_direction.z, 0.05);
    return mix(path_m, level_m, crown_is_sward(crown));
}

/* Of the light, a metre of crown takes this share: half the leaf area a ray meets stands across it
 * (spherical leaf angles), and a crown holds some 4 m2 of leaves over each m2 of ground, somewhat
 * clumped. */
float crown_per_m(wd_crown crown)
{
    return 0.5 * 4.0 * 0.85 / (2.0 * crown.radii_m.z) + 0.06;
}

/* Share of the sun left after that way. */
float crown_through(wd_crown crown, float path_m)
{
    return exp(-crown_per_m(crown) * path_m);
}

/* The same for a sward, whose leaves the eye meets by a, the sun by b a metre of depth: of those seen
 * a / (a + b) are lit. Where that share of the sun is left: */
float sward_card_height_m(wd_crown crown, vec3 direction)
{
    float sun = max(frame.sun_direction.z, 0.05);
    float depth_m = sun / crown_per_m(crown) * log(1.0 + abs(direction.z) / (1.5 * sun));
    return crown.center_rel.z + crown.radii_m.z - depth_m;
}

/* A card's picture is flat: its places are moved along the view ray to where the sun is as strong
 * as on the mean of what the ray may meet. Light falls off with e^-t; the eye's ray meets leaves and
 * wood half as often again (chosen by the brightness of cards beside that of meshes): with the
 * density 1.5 e^-1.5t / (1 - e^-1.5x) on a way of x. The mean of e^-t over that is
 * 0.6 (1 - e^-2.5x) / (1 - e^-1.5x). Octants strew a tree's leaves all over its box: those well off the
 * crown are lit as what lies half way in, for a disc's mean distance from its middle is 2/3. */
vec3 crown_card_place(wd_crown crown, vec3 direction)
{
    vec3 s = direction / crown.radii_m;
    float ss = dot(s, s), nearest_m = dot(crown.center_rel / crown.radii_m, s) / ss;
    vec3 off = (direction * nearest_m - crown.center_rel) / crown.radii_m;
    float out_by = length(off);
    off *= out_by > 1.25 ? 0.67 / out_by : 1.0;
    float half_m = sqrt(max(1.0 - dot(off, off), 0.0) / ss);
    float from_m = max(nearest_m - half_m, 0.1);
    float way_m = max(nearest_m + half_m - from_m, 0.0), x = way_m * crown_per_m(crown);
    float left = 0.6 * (1.0 - exp(-2.5 * x)) / (1.0 - exp(-1.5 * max(x, 1e-3)));
    float share = x < 0.02 ? 0.5 : -log(left) / x;
    vec3 within = crown.center_rel + off * crown.radii_m
                  + direction * (from_m - nearest_m + share * way_m);
    within.z = mix(within.z, sward_card_height_m(crown, direction), crown_is_sward(crown));
    return within;
}

/* The crown's outward direction at a place: the smooth normal of its ellipsoid. */
vec3 crown_normal(wd_crown crown, vec3 rel)
{
    vec3 q = (rel - crown.center_rel) / (crown.radii_m * crown.radii_m);
    return normalize(q + vec3(0.0, 0.0, 1e-4));
}
