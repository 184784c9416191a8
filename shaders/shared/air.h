/* air.h: the sky toward a direction, the sun's disc, and haze on the way to what is seen. Shaders
 * declare `frame` before they include this. Directions are of unit length. */
#ifndef WD_SHARED_AIR_H
#define WD_SHARED_AIR_H

#include "shared/frame.h"
#include "shared/sky.h"

/* Without the sun's disc; below the horizon as at the horizon. */
WD_FUNC WD_VECTOR wd_sky_toward(WD_FRAME_IN WD_VECTOR direction)
{
    WD_VECTOR sun = WD_FRAME_V3(sun_direction);
    float cosine = wd_v3_dot(direction, sun), turbidity = WD_FRAME(sky_turbidity);
    float v = wd_air_mass(direction.z), s = wd_air_mass(sun.z);
    float air = wd_air_phase(cosine), haze = wd_haze_phase(cosine);
    WD_VECTOR radiance =
        WD_V3(wd_sky_radiance(wd_sky_band_of(0, turbidity), v, s, air, haze, sun.z),
              wd_sky_radiance(wd_sky_band_of(1, turbidity), v, s, air, haze, sun.z),
              wd_sky_radiance(wd_sky_band_of(2, turbidity), v, s, air, haze, sun.z));
    return wd_v3_add(wd_v3_scale(radiance, WD_FRAME(sky_strength)),
                     wd_v3_scale(WD_FRAME_V3(sky_cloud), wd_cloud_gradient(direction.z)));
}

/* The sky at the horizon below or above a direction: what haze fades into. `glow` is a factor on
 * the light that haze scatters forward. */
WD_FUNC WD_VECTOR wd_horizon_toward(WD_FRAME_IN WD_VECTOR direction, float glow)
{
    float cosine = wd_v3_dot(direction, WD_FRAME_V3(sun_direction));
    return wd_v3_add(WD_FRAME_V3(sky_horizon),
                     wd_v3_scale(WD_FRAME_V3(sky_glow), wd_haze_phase(cosine) * glow));
}

/* The disc, with the darkening of its limb (Hestroffer and Magnan 1998: exponent 0.5). */
WD_FUNC WD_VECTOR wd_sun_disc_toward(WD_FRAME_IN WD_VECTOR direction)
{
    float apart = 1.0f - WD_FRAME(sun_cos_radius);
    float cosine = wd_v3_dot(direction, WD_FRAME_V3(sun_direction));
    float inside = (cosine - WD_FRAME(sun_cos_radius)) / apart;
    if (inside <= 0.0f || direction.z < 0.0f)
        return WD_V3(0.0f, 0.0f, 0.0f);
    float share = 1.25f * WD_SQRT(WD_SQRT(inside)) / (6.2831853f * apart); /* 1.25: mean is 1 */
    return wd_v3_scale(WD_FRAME_V3(sun_irradiance), share);
}

/* Metres of air at full density that a ray of this length from the camera passes: haze thins
 * exponentially with height. Told from the ray's lower end, where it is thickest: from there up the
 * integral cannot overflow, however high the camera is. */
WD_FUNC float wd_fog_path_m(WD_FRAME_IN WD_VECTOR direction, float length_m)
{
    float eye_z = WD_FLOAT(WD_FRAME(camera_mm[2])) * 0.001f;
    float per_height = 1.0f / WD_FRAME(fog_height_m);
    float rise_m = direction.z * length_m;
    float low_z = eye_z + WD_MIN(rise_m, 0.0f);
    float at_low = WD_EXP(WD_CLAMP((WD_FRAME(fog_base_m) - low_z) * per_height, -20.0f, 1.5f));
    float rise = WD_ABS(rise_m * per_height);
    float mean = 1.0f - 0.5f * rise;
    if (rise > 1e-3f)
        mean = (1.0f - WD_EXP(-rise)) / rise;
    return at_low * mean * length_m;
}

/* Share of the light that comes through. Air scatters blue more than haze does: extinction per
 * band, about 1 at 550 nm. */
WD_FUNC WD_VECTOR wd_fog_through(WD_FRAME_IN WD_VECTOR direction, float length_m)
{
    float depth = WD_FRAME(fog_per_m) * wd_fog_path_m(WD_FRAME_PASS direction, length_m);
    return WD_V3(WD_EXP(-0.80f * depth), WD_EXP(-depth), WD_EXP(-1.34f * depth));
}

/* Of the light that haze scatters forward, what is left where hills keep the sun's own from it. */
#define WD_HAZE_IN_SHADE 0.45f

/* `radiance` as it arrives from `length_m` off. `sunlit`: share of the way on which the ground lets the sun reach
 * the haze; `sky`, `sun`: what trees let through to it of each. */
WD_FUNC WD_VECTOR wd_fog_apply(WD_FRAME_IN WD_VECTOR radiance, WD_VECTOR direction, float length_m,
                               float sunlit, float sky, float sun)
{
    WD_VECTOR through = wd_fog_through(WD_FRAME_PASS direction, length_m);
    float phase = wd_haze_phase(wd_v3_dot(direction, WD_FRAME_V3(sun_direction)));
    float glow = phase * WD_MIX(WD_HAZE_IN_SHADE * sky, sun, sunlit);
    WD_VECTOR haze = wd_v3_add(wd_v3_scale(WD_FRAME_V3(sky_horizon), sky),
                               wd_v3_scale(WD_FRAME_V3(sky_glow), glow));
    WD_VECTOR lost = wd_v3_sub(WD_V3(1.0f, 1.0f, 1.0f), through);
    return wd_v3_add(wd_v3_mul(radiance, through), wd_v3_mul(haze, lost));
}

#endif
