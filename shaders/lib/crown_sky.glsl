/* What a tree's neighbours leave of the sky to a place in its crown (shared/crown_sky.h).
 * Expects `frame`, `push` (wd_light_push) and the libraries of crown and skylight; CROWN_SKY: the table's texels. */
#include "shared/crown_sky.h"

struct wd_past_neighbours {
    float share;    /* how far that is known */
    vec4 high, low; /* as in wd_alone */
    vec4 high_here, low_here; /* the same, whatever the tree's own leaves leave */
};

#ifdef CROWN_SKY
/* Between eight places of the table; the roots are mixed. */
wd_past_neighbours past_neighbours_at(int first, vec3 at)
{
    ivec3 cell = ivec3(at);
    vec3 next = at - vec3(cell), here = 1.0 - next;
    int corner = first + cell.x + int(WD_CROWN_SKY_ACROSS) * (cell.y + int(WD_CROWN_SKY_ACROSS) * cell.z);
    vec4 high = vec4(0.0), low = vec4(0.0);
    for (int i = 0; i < 4; i++) {
        ivec2 on = ivec2(i & 1, i >> 1);
        vec2 shares = mix(here.xy, next.xy, vec2(on));
        uvec4 texel = texelFetch(CROWN_SKY, corner + on.x + int(WD_CROWN_SKY_ACROSS) * on.y);
        float share = shares.x * shares.y;
        high += share * mix(unpackUnorm4x8(texel.x), unpackUnorm4x8(texel.z), next.z);
        low += share * mix(unpackUnorm4x8(texel.y), unpackUnorm4x8(texel.w), next.z);
    }
    return wd_past_neighbours(1.0, high * high, low * low, high * high, low * low);
}

/* Metres of the crown's own leaves along the ways to the quarters of the sky, so far up. */
vec4 own_ways_m(wd_crown crown, vec3 from_m, float up)
{
    float level = sqrt(1.0 - up * up);
    return vec4(wd_crown_path_m(from_m, crown.radii_m, vec3(level, 0.0, up)),
                wd_crown_path_m(from_m, crown.radii_m, vec3(0.0, level, up)),
                wd_crown_path_m(from_m, crown.radii_m, vec3(-level, 0.0, up)),
                wd_crown_path_m(from_m, crown.radii_m, vec3(0.0, -level, up)));
}
#endif

/* How much more of the leaves that lie along a way hide than wd_crown_per_m says of them on the mean way: by path-traced
 * leaves of scenes/bench75k.json at 512 px, 16 places, under an even sky. */
const float OWN_WAYS = 2.0;

/* About the eye one place errs for all that is seen, by the table up to twice as bright, by the canopy's field as dark: up to
 * so near half of each. By twelve places of scenes/bench75k.json at 1,024 px. */
const vec2 CLOSE_BY_M = vec2(4.0, 7.0);
const float CLOSE_BY_SHARE = 0.5;

/* The crown's own leaves leave some ways more open than others, and the eye sees leaves that look its way: what the
 * neighbours leave of these counts more, and for faces that look out there more yet. `tree`: record; `side`: see
 * eye_side. */
wd_past_neighbours past_neighbours(uint tree, wd_crown crown, vec3 rel, vec4 side, float openness)
{
    wd_past_neighbours past = wd_past_neighbours(0.0, vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
#ifdef CROWN_SKY
    int set = int(wd_crown_sky_set(tree));
    bvec4 is = equal(texelFetch(CROWN_SKY, set), uvec4(tree + 1u));
    if (!any(is))
        return past;
    int slot = int(WD_CROWN_SKY_SLOTS) * set + (is.y ? 1 : is.z ? 2 : is.w ? 3 : 0);
    float top = crown.center_rel.z + crown.radii_m.z, bottom = crown.foot_z + WD_CROWN_SKY_LOW_M;
    vec3 at = vec3(0.5 * (rel.xy - crown.center_rel.xy) / crown.radii_m.x + 0.5, (rel.z - bottom) / (top - bottom));
    const vec3 last = vec3(vec2(float(WD_CROWN_SKY_ACROSS - 1u)), float(WD_CROWN_SKY_UP - 1u));
    past = past_neighbours_at(int(WD_CROWN_SKY_SETS + uint(slot) * WD_CROWN_SKY_TEXELS),
                              clamp(at, vec3(0.0), vec3(0.9999)) * last);
    float away_m = length(rel);
    past.share = wd_crown_sky_share(top - crown.foot_z, away_m, push.pixels_a_radian)
                 * mix(CLOSE_BY_SHARE, 1.0, smoothstep(CLOSE_BY_M.x, CLOSE_BY_M.y, away_m));
    float per_m = -OWN_WAYS * wd_crown_per_m(crown.radii_m);
    vec4 high = side * exp(per_m * own_ways_m(crown, rel - crown.center_rel, 0.784));
    vec4 low = side * exp(per_m * own_ways_m(crown, rel - crown.center_rel, 0.26));
    float mean = 0.25 * dot(0.75 * high + 0.25 * low, vec4(1.0));
    float most = mean / wd_skylit_above(openness); /* no way is more open than open */
    past.high *= min(high, most) / mean;
    past.low *= min(low, most) / mean;
#endif
    return past;
}

/* Of a tree that stands free the canopy's field says it, or the table where that leaves less. */
void know_neighbours(inout wd_alone alone, wd_past_neighbours past, float told, float herbs)
{
    float free = past.share * told * alone.share;
    alone.high = mix(alone.high, min(alone.high, past.high_here * herbs), free);
    alone.low = mix(alone.low, min(alone.low, past.low_here * herbs), free);
    alone.sides = mix(alone.sides, min(alone.sides, 0.75 * alone.high + 0.25 * alone.low), free);
    alone.by_crown = past.share * told * (1.0 - alone.share);
    alone.high = mix(alone.high, past.high * herbs, alone.by_crown);
    alone.low = mix(alone.low, past.low * herbs, alone.by_crown);
    alone.sides = mix(alone.sides, 0.75 * alone.high + 0.25 * alone.low, alone.by_crown);
    alone.known = max(alone.known, alone.by_crown);
}
