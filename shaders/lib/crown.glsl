/* Light inside a tree's crown without tracing it: depth along the sun (Guerrero 2006, section 5).
 * The crown is an ellipsoid of leaves; light falls off with the way it has come through it.
 * Expects `frame` and lib/tree.glsl. */

struct wd_crown {
    vec3 center_rel;
    vec3 radii_m;
};

wd_crown crown_of(wd_tree tree, wd_model model)
{
    float height_m = WD_TREE_HEIGHT_M(tree), radius_m = WD_TREE_CROWN_M(tree) * 0.5;
    float base_m = model.crown_base_m * height_m / model.height_m;
    wd_crown crown;
    crown.center_rel = tree_foot_rel(tree) + vec3(0.0, 0.0, 0.5 * (height_m + base_m));
    crown.radii_m = max(vec3(radius_m, radius_m, 0.5 * (height_m - base_m)), vec3(0.1));
    return crown;
}

/* A card's picture is flat: its places are moved, along the view ray, to a plane that faces the
 * camera, half the crown's radius before its centre. */
vec3 crown_card_place(wd_crown crown, vec3 rel)
{
    float far = length(crown.center_rel);
    vec3 toward = crown.center_rel / far;
    float radius_m = 1.0 / length(toward / crown.radii_m);
    float along = dot(rel, toward);
    return along > 0.1 ? rel * (max(far - 0.5 * radius_m, 0.1) / along) : rel;
}

/* Metres of crown between a place and the sun. */
float crown_path_m(wd_crown crown, vec3 rel)
{
    vec3 q = (rel - crown.center_rel) / crown.radii_m;
    float outside = length(q);
    q /= max(outside, 1.0);
    vec3 s = frame.sun_direction / crown.radii_m;
    float ss = dot(s, s), qs = dot(q, s);
    return (sqrt(max(qs * qs - ss * (dot(q, q) - 1.0), 0.0)) - qs) / ss;
}

/* Share of the sun left after that way: half the leaf area a ray meets stands across it (spherical
 * leaf angles), and a crown holds some 4 m2 of leaves over each m2 of ground, somewhat clumped. */
float crown_through(wd_crown crown, float path_m)
{
    float per_m = 0.5 * 4.0 * 0.85 / (2.0 * crown.radii_m.z) + 0.06;
    return exp(-per_m * path_m);
}

/* The crown's outward direction at a place: the smooth normal of its ellipsoid. */
vec3 crown_normal(wd_crown crown, vec3 rel)
{
    vec3 q = (rel - crown.center_rel) / (crown.radii_m * crown.radii_m);
    return normalize(q + vec3(0.0, 0.0, 1e-4));
}
