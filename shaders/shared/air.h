/* air.h: the sky toward a direction, the sun's disc, and haze on the way to what is seen. Shaders
 * declare `frame` before they include this. Directions are of unit length. */
#ifndef WD_SHARED_AIR_H
#define WD_SHARED_AIR_H

#include "shared/frame.h"
#include "shared/sky.h"

/* The sky at the horizon below or above a direction: what haze fades into. `glow` is a factor on
 * the light that haze scatters forward. */
WD_FUNC WD_VECTOR wd_horizon_toward(WD_FRAME_IN WD_VECTOR direction, float glow)
{
    float cosine = wd_v3_dot(direction, WD_FRAME_V3(sun_direction));
    return wd_v3_add(WD_FRAME_V3(sky_horizon),
                     wd_v3_scale(WD_FRAME_V3(sky_glow), wd_haze_phase(cosine) * glow));
}

/* Without the sun's disc; below the horizon as at the horizon. Past the fog over the camera. */
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
    radiance = wd_v3_add(wd_v3_scale(radiance, WD_FRAME(sky_strength)),
                         wd_v3_scale(WD_FRAME_V3(sky_cloud), wd_cloud_gradient(direction.z)));
    float through = WD_EXP(-WD_FRAME(fog_over) * v);
    return wd_v3_add(wd_v3_scale(radiance, through),
                     wd_v3_scale(wd_horizon_toward(WD_FRAME_PASS direction, 1.0f), 1.0f - through));
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

/* Density at a height over that of the fog's base: it thins exponentially, and is no more than e^1.5 below. */
WD_FUNC float wd_fog_density(WD_FRAME_IN float z_m)
{
    float per_height = 1.0f / WD_FRAME(fog_height_m);
    return WD_EXP(WD_CLAMP((WD_FRAME(fog_base_m) - z_m) * per_height, -20.0f, 1.5f));
}

/* Metres of air at full density that a ray of this length from the camera passes. Told from the
 * ray's lower end, where it is thickest: from there up the integral cannot overflow, however high
 * the camera is. */
WD_FUNC float wd_fog_path_m(WD_FRAME_IN WD_VECTOR direction, float length_m)
{
    float eye_z = WD_FLOAT(WD_FRAME(camera_mm[2])) * 0.001f;
    float rise_m = direction.z * length_m;
    float at_low = wd_fog_density(WD_FRAME_PASS eye_z + WD_MIN(rise_m, 0.0f));
    float rise = WD_ABS(rise_m * (1.0f / WD_FRAME(fog_height_m)));
    float mean = 1.0f - 0.5f * rise;
    if (rise > 1e-3f)
        mean = (1.0f - WD_EXP(-rise)) / rise;
    return at_low * mean * length_m;
}

/* Share of the light that comes through. */
WD_FUNC WD_VECTOR wd_fog_through(WD_FRAME_IN WD_VECTOR direction, float length_m)
{
    float depth = WD_FRAME(fog_per_m) * wd_fog_path_m(WD_FRAME_PASS direction, length_m);
    WD_VECTOR bands = WD_FRAME_V3(fog_bands);
    return WD_V3(WD_EXP(-bands.x * depth), WD_EXP(-depth), WD_EXP(-bands.z * depth));
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

/* The sky as wd_sky_toward has it, past fog that trees shade as far off as this: `sky` and `sun` as above. */
#define WD_FOG_SHADED_M 1000.0f
WD_FUNC WD_VECTOR wd_fog_shade_sky(WD_FRAME_IN WD_VECTOR radiance, WD_VECTOR direction, float sky, float sun)
{
    float share = WD_CLAMP(10.0f * WD_FRAME(fog_over), 0.0f, 1.0f); /* thin haze over the camera is the sky's own */
    WD_VECTOR none = WD_V3(0.0f, 0.0f, 0.0f);
    WD_VECTOR shade = wd_fog_apply(WD_FRAME_PASS none, direction, WD_FOG_SHADED_M, 1.0f, 1.0f - sky, 1.0f - sun);
    WD_VECTOR left = wd_v3_sub(radiance, wd_v3_scale(shade, share));
    return WD_V3(WD_MAX(left.x, 0.0f), WD_MAX(left.y, 0.0f), WD_MAX(left.z, 0.0f));
}

#endif
