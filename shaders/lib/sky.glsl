/* The sky toward a direction. Expects `frame` (wd_frame_uniforms). */
#include "shared/sky.h"

/* Without the sun's disc; below the horizon as at the horizon. */
vec3 sky_radiance(vec3 direction)
{
    float cosine = dot(direction, frame.sun_direction);
    float v = wd_air_mass(direction.z), s = wd_air_mass(frame.sun_direction.z);
    float air_phase = wd_air_phase(cosine), haze_phase = wd_haze_phase(cosine);
    vec3 radiance;
    for (int i = 0; i < 3; i++)
        radiance[i] = wd_sky_radiance(wd_sky_band_of(i, frame.sky_turbidity), v, s, air_phase,
                                      haze_phase, frame.sun_direction.z);
    return radiance * frame.sky_strength;
}

/* The sky at the horizon below or above a direction: what haze fades into. `glow` is a factor on
 * the light that haze scatters forward. */
vec3 horizon_radiance(vec3 direction, float glow)
{
    float cosine = dot(direction, frame.sun_direction);
    return frame.sky_horizon + frame.sky_glow * (wd_haze_phase(cosine) * glow);
}

/* The disc, with the darkening of its limb (Hestroffer and Magnan 1998: exponent 0.5). */
vec3 sun_disc(vec3 direction)
{
    float cosine = dot(direction, frame.sun_direction);
    float inside = (cosine - frame.sun_cos_radius) / (1.0 - frame.sun_cos_radius);
    if (inside <= 0.0 || direction.z < 0.0)
        return vec3(0.0);
    float area = 6.2831853 * (1.0 - frame.sun_cos_radius);
    return frame.sun_irradiance / area * 1.2 * sqrt(inside);
}
