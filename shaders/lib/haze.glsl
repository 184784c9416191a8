/* Haze among trees has the light that these let down. Expects `frame`, `push` (wd_light_push) and lib/skylight.glsl. */
#include "shared/air.h"

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
const float HAZE_SKY_WAY = 1.35, HAZE_SUN_WAY = 0.67;

vec2 haze_shade(wd_haze_place place)
{
    vec2 ways = vec2(HAZE_SKY_WAY, HAZE_SUN_WAY / max(frame.sun_direction.z, 0.2));
    return 1.0 - exp2(canopy_above(place.layer_m, place.height_m) * place.floor_log * ways);
}

/* Where the eye is, and what is lit. */
wd_haze_place haze_eye = IN_THE_OPEN, haze_end = IN_THE_OPEN;

void know_eye()
{
    vec2 at = push.camera_m * push.canopy_scale;
    vec4 field = CANOPY_LIGHT_AT(at, 0.0), layers = CANOPY_LIGHT_AT(at, 1.0);
    haze_eye.floor_log = log2(dot(max(field * field, vec4(1e-3)), vec4(0.25)));
    haze_eye.layer_m = WD_CANOPY_MOST_M * layers.xy * layers.xy;
    haze_eye.height_m = push.eye_over_ground_m;
}

/* Hardly any way within a stand is as long as this. */
const float HAZE_STAND_M = 1000.0;

/* Of shade that falls from each end of the way to the other, and beyond that length besides, the mean over it. */
float haze_reach(float length_m)
{
    float x = length_m / HAZE_STAND_M;
    return 0.5 * inversesqrt(1.0 + x * x);
}

/* Simpson's rule over the part of the way that is below the stands' tops. */
vec3 apply_haze(vec3 radiance, vec3 direction, float length_m, float sunlit)
{
    bool rises = haze_eye.height_m < haze_end.height_m;
    wd_haze_place low = haze_end, high = haze_eye;
    if (rises) {
        low = haze_eye;
        high = haze_end;
    }
    float top_m = max(low.layer_m.y, high.layer_m.y) + 0.5;
    float part = clamp((top_m - low.height_m) / max(high.height_m - low.height_m, 1e-3), 0.0, 1.0);
    high.height_m = min(high.height_m, top_m);
    wd_haze_place between = wd_haze_place(0.5 * (low.floor_log + high.floor_log),
                                          0.5 * (low.layer_m + high.layer_m),
                                          0.5 * (low.height_m + high.height_m));
    vec2 shade = haze_shade(low) + 4.0 * haze_shade(between) + haze_shade(high);
    vec2 open = 1.0 - shade * (part * haze_reach(length_m * part) / 3.0);
    return wd_fog_apply(radiance, direction, length_m, sunlit, open.x, open.y);
}
