/* crown.h: a tree's crown as an ellipsoid of leaves, in which light falls off with the way that it has come
 * (Guerrero 2006, section 5). */
#ifndef WD_SHARED_CROWN_H
#define WD_SHARED_CROWN_H

#include "shared/vec.h"

/* Of the light that a leaf scatters, this share meets another of its own tree's (recollision probability:
 * Stenberg, Mottus and Rautiainen 2016). */
#define WD_RECOLLISION 0.7f

/* Of the light, a metre of crown takes this share: half the leaf area a ray meets stands across it
 * (spherical leaf angles), and a crown holds some 4 m2 of leaves over each m2 of ground, somewhat
 * clumped. */
WD_FUNC float wd_crown_per_m(WD_VECTOR radii_m)
{
    return 0.5f * 4.0f * 0.85f / (2.0f * radii_m.z) + 0.06f;
}

/* In units of the ellipsoid's radii. */
WD_FUNC WD_VECTOR wd_crown_units(WD_VECTOR way_m, WD_VECTOR radii_m)
{
    return WD_V3(way_m.x / radii_m.x, way_m.y / radii_m.y, way_m.z / radii_m.z);
}

/* Metres from a place toward the sun to where the crown begins and ends. */
struct wd_crown_way {
    float begins_m, ends_m;
};

/* Of a place from the crown's middle; leaves without the ellipsoid are taken to stand on it, the stem below
 * where it is. */
WD_FUNC WD_STRUCT wd_crown_way wd_crown_way_of(WD_VECTOR from_middle_m, WD_VECTOR radii_m, WD_VECTOR sun)
{
    WD_STRUCT wd_crown_way way;
    WD_VECTOR q = wd_crown_units(from_middle_m, radii_m), s = wd_crown_units(sun, radii_m);
    float out_by = WD_MAX(WD_SQRT(wd_v3_dot(q, q)), 1.0f);
    q = wd_v3_scale(q, q.z < -1.0f ? 1.0f : 1.0f / out_by);
    float ss = wd_v3_dot(s, s), qs = wd_v3_dot(q, s);
    float root = WD_SQRT(WD_MAX(qs * qs - ss * (wd_v3_dot(q, q) - 1.0f), 0.0f));
    way.begins_m = WD_MAX(-root - qs, 0.0f) / ss;
    way.ends_m = WD_MAX(root - qs, 0.0f) / ss;
    return way;
}

WD_FUNC float wd_crown_path_m(WD_VECTOR from_middle_m, WD_VECTOR radii_m, WD_VECTOR sun)
{
    WD_STRUCT wd_crown_way way = wd_crown_way_of(from_middle_m, radii_m, sun);
    return way.ends_m - way.begins_m;
}

/* Share of the sun left after that way, at a place that sees `openness` of the sky: a crown is no even
 * cloud, what sees little of the sky sees little of the sun. */
WD_FUNC float wd_crown_through(WD_VECTOR radii_m, float path_m, float openness)
{
    return WD_EXP(-wd_crown_per_m(radii_m) * path_m) * WD_MIN(openness * 1.27f, 1.0f);
}

/* Of places where the crown's depth leaves that share, so many are lit: leaves stand in clumps, and what is
 * past the first few of them is open or is not. `curve`: a model's own (src/tree/sunlit.h). */
WD_FUNC float wd_crown_lit(float through, float curve_x, float curve_y)
{
    return 1.0f - WD_EXP(-curve_x * WD_EXP2(curve_y * WD_LOG2(WD_MAX(through, 1e-4f))));
}

/* A card's picture is flat: its places are moved along the view ray to where the sun is as strong
 * as on the mean of what the ray may meet. Light falls off with e^-t; the eye's ray meets leaves and
 * wood half as often again (chosen by the brightness of cards beside that of meshes): with the
 * density 1.5 e^-1.5t / (1 - e^-1.5x) on a way of x. The mean of e^-t over that is
 * 0.6 (1 - e^-2.5x) / (1 - e^-1.5x). Octants strew a tree's leaves all over its box: those well off the
 * crown are lit as what lies half way in, for a disc's mean distance from its middle is 2/3.
 * `middle_m` of the crown and the result are from the eye. */
WD_FUNC WD_VECTOR wd_crown_card_place(WD_VECTOR middle_m, WD_VECTOR radii_m, WD_VECTOR direction)
{
    WD_VECTOR s = wd_crown_units(direction, radii_m);
    float ss = wd_v3_dot(s, s);
    float nearest_m = wd_v3_dot(wd_crown_units(middle_m, radii_m), s) / ss;
    WD_VECTOR off = wd_crown_units(
        wd_v3_sub(wd_v3_scale(direction, nearest_m), middle_m), radii_m);
    float out_by = WD_SQRT(wd_v3_dot(off, off));
    off = wd_v3_scale(off, out_by > 1.25f ? 0.67f / out_by : 1.0f);
    float half_m = WD_SQRT(WD_MAX(1.0f - wd_v3_dot(off, off), 0.0f) / ss);
    float from_m = WD_MAX(nearest_m - half_m, 0.1f);
    float way_m = WD_MAX(nearest_m + half_m - from_m, 0.0f), x = way_m * wd_crown_per_m(radii_m);
    float left = 0.6f * (1.0f - WD_EXP(-2.5f * x)) / (1.0f - WD_EXP(-1.5f * WD_MAX(x, 1e-3f)));
    float share = x < 0.02f ? 0.5f : -0.69314718f * WD_LOG2(left) / x;
    return wd_v3_add(wd_v3_add(middle_m, wd_v3_mul(off, radii_m)),
                     wd_v3_scale(direction, from_m - nearest_m + share * way_m));
}

#endif
