/* Haze among trees has the light that these let down. Expects `frame`, `push` (wd_light_push) and lib/skylight.glsl;
 * with SHAFT_AT(tile, slice) the sun's comes in shafts (lib/shafts.glsl). */
#include "shared/air.h"
#ifdef SHAFT_AT
#include "lib/shafts.glsl"
#endif

/* A stand, and how high over its ground: log2 of the share of the sky's light that reaches the floor; base and top of
 * its leaves. */
struct wd_haze_place {
    float floor_log;
    vec2 layer_m;
    float height_m;
};
const wd_haze_place IN_THE_OPEN = wd_haze_place(0.0, vec2(0.0), 0.0);

/* Share of the sky's light and of the sun's that does not come there. Haze takes light from all the sky alike, more of
 * it level than floors do. */
const float HAZE_SKY_WAY = 1.2, HAZE_SUN_WAY = 0.67;

vec2 haze_shade(wd_haze_place place)
{
    vec2 ways = vec2(HAZE_SKY_WAY, HAZE_SUN_WAY / max(frame.sun_direction.z, 0.2));
    return 1.0 - exp2(canopy_above(place.layer_m, place.height_m) * place.floor_log * ways);
}

/* Where the eye is, and what is lit. */
wd_haze_place haze_eye = IN_THE_OPEN, haze_end = IN_THE_OPEN;

float haze_floor_log(vec2 place_m)
{
    vec4 field = CANOPY_LIGHT_AT(canopy_at(place_m), 0.0);
    return log2(dot(max(field * field, vec4(1e-3)), vec4(0.25)));
}

void know_eye()
{
    vec4 layers = CANOPY_LIGHT_AT(canopy_at(push.camera_m), 1.0);
    haze_eye.floor_log = haze_floor_log(push.camera_m);
    haze_eye.layer_m = WD_CANOPY_MOST_M * layers.xy * layers.xy;
    haze_eye.height_m = push.eye_over_ground_m;
}

/* Hardly any way within a stand is as long as this. */
const float HAZE_STAND_M = 1000.0;

/* Of shade that falls from each end of the way to the other, and beyond that length besides, the mean over it. */
float haze_reach(float length_m)
{
    float x = length_m / HAZE_STAND_M;
    return inversesqrt(1.0 + x * x);
}

#ifdef SHAFT_AT
/* The pixel that is lit, and noise of it. */
uvec2 haze_pixel = uvec2(0u);
float haze_noise = 0.5;

/* A row of three tiles, by a quadratic B-spline: of the few places of each tile it leaves little noise. */
float shaft_row(uint row, uvec3 columns, vec3 weights, uint slice)
{
    uint first = row * push.tile_columns;
    return dot(weights, vec3(SHAFT_AT(first + columns.x, slice), SHAFT_AT(first + columns.y, slice),
                             SHAFT_AT(first + columns.z, slice)));
}

vec3 spline_weights(float at)
{
    vec2 ends = 0.5 * vec2((1.0 - at) * (1.0 - at), at * at);
    return vec3(ends.x, 1.0 - ends.x - ends.y, ends.y);
}

float shaft_at(uint slice)
{
    vec2 at = (vec2(haze_pixel) + 0.5) / float(WD_TILE);
    uvec2 most = uvec2(push.tile_columns, push.tile_rows) - 1u, tile = uvec2(at);
    uvec2 low = uvec2(max(ivec2(tile) - 1, 0)), high = min(tile + 1u, most);
    uvec3 columns = uvec3(low.x, tile.x, high.x);
    vec3 across = spline_weights(fract(at.x)), down = spline_weights(fract(at.y));
    return dot(down, vec3(shaft_row(low.y, columns, across, slice), shaft_row(tile.y, columns, across, slice),
                          shaft_row(high.y, columns, across, slice)));
}

/* Slices of tiles up to the last that ends before what is seen, and one place of the rest: behind what is seen light
 * may be another. `open` is what the canopy's field tells of all the way. */
float sun_on_way(float open, vec3 direction, float length_m)
{
    float axis = (frame.clip_from_rel * vec4(direction, 0.0)).w, reach_m = shafts_reach_m(axis);
    float near_m = min(length_m, reach_m);
    uint whole = uint(sqrt(near_m / reach_m) * float(WD_SHAFT_SLICES) + 1e-3);
    float from_m = whole > 0u ? slice_end_m(reach_m, whole - 1u) : 0.0;
    float lit = shaft_at(max(whole, 1u) - 1u);
    float at_m = mix(from_m, near_m, haze_noise);
    float last = sun_in_air(direction * at_m, at_m * axis, haze_noise);
    float before = 1.0 - wd_fog_through(direction, from_m).y, near = 1.0 - wd_fog_through(direction, near_m).y;
    float all = max(1.0 - wd_fog_through(direction, length_m).y, 1e-4);
    lit = (lit * before + last * max(near - before, 0.0)) / max(near, 1e-4);
    return mix(open, lit, push.shafts * min(near / all, 1.0));
}
#endif

/* What haze of an optical depth on a way adds to what arrives, by three places: the near end of the way, one `at` this
 * part of it, and its far end. Haze lies at `mean` in the mean. Where it is thin this is Simpson's rule; where it hides
 * the far end, Radau's. */
struct wd_haze_rule {
    vec3 weights;
    float at, mean;
};

wd_haze_rule haze_rule(float depth)
{
    float first = 0.5 - depth / 12.0, second = 1.0 / 3.0 - depth / 12.0; /* moments of the place */
    if (depth > 0.05) {
        float through = exp(-depth), per_lost = through / (1.0 - through);
        first = 1.0 / depth - per_lost;
        second = 2.0 * first / depth - per_lost;
    }
    float at = min(second / first, 0.5);
    float between = (first - second) / (at - at * at), far = first - at * between;
    return wd_haze_rule(vec3(1.0 - between - far, between, far), at, first);
}

/* Shares of the sky's light and of the sun's that stands let through to haze on a way: shade counts on the part of it that
 * is below their tops, as much as haze there does. */
vec2 haze_open(vec3 direction, float length_m)
{
    bool rises = haze_eye.height_m < haze_end.height_m;
    wd_haze_place near = haze_eye, far = haze_end;
    float low_m = min(near.height_m, far.height_m), high_m = max(near.height_m, far.height_m);
    float top_m = max(near.layer_m.y, far.layer_m.y) + 0.5;
    float part = clamp((top_m - low_m) / max(high_m - low_m, 1e-3), 0.0, 1.0), before = rises ? 0.0 : 1.0 - part;
    near.height_m = min(near.height_m, top_m);
    far.height_m = min(far.height_m, top_m);
    float depth = frame.fog_per_m * wd_fog_path_m(direction, length_m), share = part;
    if (depth > 1e-3)
        share = exp(-depth * before) * (1.0 - exp(-depth * part)) / (1.0 - exp(-depth));
    wd_haze_rule rule = haze_rule(depth * part);
    float between_m = length_m * (before + rule.at * part);
    wd_haze_place between = wd_haze_place(haze_floor_log(push.camera_m + direction.xy * between_m),
                                          mix(near.layer_m, far.layer_m, rule.at),
                                          mix(near.height_m, far.height_m, rule.at));
    vec2 shade = mat3x2(haze_shade(near), haze_shade(between), haze_shade(far)) * rule.weights;
    vec2 open = 1.0 - shade * (share * haze_reach(2.0 * rule.mean * length_m * part));
#ifdef SHAFT_AT
    if (push.shafts > 0.0)
        open.y = sun_on_way(open.y, direction, length_m);
#endif
    return open;
}

vec3 apply_haze(vec3 radiance, vec3 direction, float length_m, float sunlit)
{
    vec2 open = haze_open(direction, length_m);
    return wd_fog_apply(radiance, direction, length_m, sunlit, open.x, open.y);
}

/* Trees beyond those next to the eye are as there. */
wd_haze_place over_eye(vec3 direction, float length_m)
{
    wd_haze_place place = haze_eye;
    place.height_m += max(direction.z, 0.0) * length_m;
    return place;
}
