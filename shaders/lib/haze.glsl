/* Haze among trees has the light that these let down. Expects `frame`, `push` (wd_light_push) and lib/skylight.glsl. */
#include "shared/air.h"

/* Share of the sky's light and of the sun's that does not come to a place so high over the ground in a stand, of which
 * `floor_mean` of the sky's light reaches the floor. Haze takes light from all the sky alike, more of it level than
 * floors do. */
const float HAZE_SKY_WAY = 1.35, HAZE_SUN_WAY = 0.67;

vec2 haze_shade(float floor_mean, vec2 layer_m, float height_m)
{
    vec2 ways = vec2(HAZE_SKY_WAY, HAZE_SUN_WAY / max(frame.sun_direction.z, 0.2));
    return 1.0 - exp2(canopy_above(layer_m, height_m) * log2(floor_mean) * ways);
}

/* Where the eye is, and at the place that is lit: of these two the way between them is told. */
vec2 haze_shade_of_eye, haze_shade_of_place = vec2(0.0);

void know_eye()
{
    vec2 at = push.camera_m * push.canopy_scale;
    vec4 field = CANOPY_LIGHT_AT(at, 0.0), layers = CANOPY_LIGHT_AT(at, 1.0);
    float floor_mean = dot(max(field * field, vec4(1e-3)), vec4(0.25));
    haze_shade_of_eye = haze_shade(floor_mean, WD_CANOPY_MOST_M * layers.xy * layers.xy, push.eye_over_ground_m);
}

/* In a stand no way is much longer than this: longer ones are in the open between their ends. */
const float HAZE_STAND_M = 1000.0;

/* Of shade that falls from each end of the way to the other, and off besides as exp(-x), the mean over it. */
float haze_reach(float length_m)
{
    float x = length_m / HAZE_STAND_M;
    return x < 0.05 ? 0.5 - x / 6.0 : (x - 1.0 + exp(-x)) / (x * x);
}

vec3 apply_haze(vec3 radiance, vec3 direction, float length_m, float sunlit)
{
    vec2 open = 1.0 - (haze_shade_of_eye + haze_shade_of_place) * haze_reach(length_m);
    return wd_fog_apply(radiance, direction, length_m, sunlit, open.x, open.y);
}
