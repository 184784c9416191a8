/* waves.h: a level water's surface: waves that travel with the wind, what it mirrors, lets through
 * and throws back of the sun. Shaders declare `frame` before they include this. */
#ifndef WD_SHARED_WAVES_H
#define WD_SHARED_WAVES_H

#include "shared/noise.h"

struct wd_waves {
    WD_VECTOR normal; /* of the waves that a pixel resolves */
    float hidden;     /* variance of the slopes of those it does not */
};

/* Variance of slopes after Cox and Munk (1954): 0.003 + 0.00512 wind speed in all. */
WD_FUNC WD_STRUCT wd_waves wd_waves_at(WD_FRAME_IN float east_m, float north_m, float footprint_m)
{
    float variance = WD_MIN(0.0015f + 0.0020f * WD_FRAME(wind_speed_mps), 0.03f);
    float drift_east = WD_FRAME(wind_toward[0]) * WD_FRAME(time_s);
    float drift_north = WD_FRAME(wind_toward[1]) * WD_FRAME(time_s);
    WD_VECTOR slope = WD_V3(0.0f, 0.0f, 0.0f), wave;
    WD_STRUCT wd_waves waves;
    waves.hidden = variance;
    float share = wd_noise_share(footprint_m, 12);
    if (share > 0.0f) {
        wave = wd_gradient_noise(wd_lattice_at(WD_FRAME_PASS east_m - drift_east * 1.6f,
                                               north_m - drift_north * 1.6f, 12), 21u);
        slope = wd_v3_add(slope, wd_v3_scale(wave, share));
        waves.hidden -= 0.4f * variance * share;
    }
    share = wd_noise_share(footprint_m, 10);
    if (share > 0.0f) {
        wave = wd_gradient_noise(wd_lattice_at(WD_FRAME_PASS east_m - drift_east, north_m - drift_north,
                                               10), 22u);
        slope = wd_v3_add(slope, wd_v3_scale(wave, share));
        wave = wd_gradient_noise(wd_lattice_at(WD_FRAME_PASS north_m + drift_north * 0.3f,
                                               east_m + drift_east * 0.3f, 9), 23u);
        slope = wd_v3_add(slope, wd_v3_scale(WD_V3(wave.x, wave.z, wave.y), share * 0.7f));
        waves.hidden -= 0.5f * variance * share;
    }
    slope = wd_v3_scale(slope, WD_SQRT(variance) * 0.7f);
    waves.normal = wd_v3_normalize(WD_V3(-slope.y, -slope.z, 1.0f));
    return waves;
}

/* Share of the light that is mirrored toward the eye; `direction` is the eye's. */
WD_FUNC float wd_water_fresnel(WD_STRUCT wd_waves waves, WD_VECTOR direction)
{
    float cosine = WD_CLAMP(-wd_v3_dot(waves.normal, direction), 0.02f, 1.0f);
    return 0.02f + 0.98f * WD_POW(1.0f - cosine, 5.0f) / (1.0f + 20.0f * waves.hidden);
}

/* Sun in a surface of Gaussian slopes. */
WD_FUNC WD_VECTOR wd_water_glint(WD_FRAME_IN WD_STRUCT wd_waves waves, WD_VECTOR direction)
{
    WD_VECTOR sun = WD_FRAME_V3(sun_direction);
    WD_VECTOR half_way = wd_v3_normalize(wd_v3_sub(sun, direction));
    float variance = WD_MAX(waves.hidden, 0.0008f);
    float cosine = WD_MAX(wd_v3_dot(half_way, waves.normal), 1e-3f);
    float cosine2 = cosine * cosine;
    float tangent2 = (1.0f - cosine2) / cosine2;
    float spread = WD_EXP(-tangent2 / (2.0f * variance))
                   / (6.2831853f * variance * cosine2 * cosine2);
    float facing = WD_CLAMP(wd_v3_dot(half_way, sun), 0.0f, 1.0f);
    float fresnel = 0.02f + 0.98f * WD_POW(1.0f - facing, 5.0f);
    return wd_v3_scale(WD_FRAME_V3(sun_irradiance),
                       fresnel * spread / (4.0f * WD_MAX(-direction.z, 0.06f)));
}

/* Share of the light left after a way in water: red goes first, green last. */
WD_FUNC WD_VECTOR wd_water_through(WD_FRAME_IN float depth_m)
{
    float depth = depth_m / WD_FRAME(water_clarity_m);
    return WD_V3(WD_EXP(-depth / 0.55f), WD_EXP(-depth), WD_EXP(-depth / 0.85f));
}

/* What deep water throws back. `lit`: share of the sun that reaches it. */
WD_FUNC WD_VECTOR wd_water_body(WD_FRAME_IN float lit)
{
    float up = WD_MAX(WD_FRAME_V3(sun_direction).z, 0.0f) * lit;
    WD_VECTOR light = wd_v3_add(wd_v3_scale(WD_FRAME_V3(sun_irradiance), up),
                                WD_FRAME_V3(sky_irradiance));
    return wd_v3_scale(wd_v3_mul(WD_FRAME_V3(water_color), light), 1.0f / 3.14159f);
}

#endif
