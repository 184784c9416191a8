/* waves.h: a level water's surface: waves that travel with the wind, what it mirrors, lets through
 * and throws back of the sun. Shaders declare `frame` before they include this. */
#ifndef WD_SHARED_WAVES_H
#define WD_SHARED_WAVES_H

#include "shared/noise.h"
#include "shared/wind.h"

struct wd_waves {
    WD_VECTOR normal; /* of the waves that a pixel resolves */
    float hidden;     /* variance of the slopes of those it does not */
};

/* The size of a pixel on the water: a mean of its length away from the eye and its width. */
WD_FUNC float wd_water_footprint_m(WD_VECTOR direction, float distance_m, float pixel_rad)
{
    return distance_m * pixel_rad / WD_SQRT(WD_MAX(-direction.z, 0.02f));
}

/* Variance of all slopes: half of what Cox and Munk (1954) saw at sea, as inland waters lie sheltered.
 * Waves of 4 m down to 0.13 m, each octave with as much of it (Phillips 1958), at the speed of deep
 * water's waves; capillary waves, the rest, are always hidden. */
WD_FUNC WD_STRUCT wd_waves wd_waves_at(WD_FRAME_IN float east_m, float north_m, float footprint_m)
{
    float variance = WD_MIN(0.0002f + 0.0026f * WD_FRAME(wind_speed_mps), 0.05f);
    float each = 0.15f * variance;
    WD_VECTOR slope = WD_V3(0.0f, 0.0f, 0.0f);
    WD_STRUCT wd_waves waves;
    waves.hidden = variance;
    for (int32_t bits = 12; bits >= 7; bits--) {
        float share = wd_noise_share(footprint_m, bits);
        if (share <= 0.0f)
            break; /* shorter ones neither */
        float cell_m = WD_FLOAT(1 << bits) * 0.001f, hertz = 1.25f / WD_SQRT(cell_m);
        float aside = (bits & 1) != 0 ? 0.45f : -0.45f;
        float east = wd_wind_rate((WD_FRAME(wind_toward[0]) - aside * WD_FRAME(wind_toward[1])) * hertz);
        float north = wd_wind_rate((WD_FRAME(wind_toward[1]) + aside * WD_FRAME(wind_toward[0])) * hertz);
        WD_STRUCT wd_lattice at = wd_lattice_at(WD_FRAME_PASS east_m - east * cell_m * WD_FRAME(time_s),
                                                north_m - north * cell_m * WD_FRAME(time_s), bits);
        /* modulo 2^32: years of periods are more cells than numbers */
        at.column = WD_INT(WD_UINT(at.column) - WD_UINT(WD_FRAME(wind_period)) * WD_UINT(wd_wind_turns(east)));
        at.row = WD_INT(WD_UINT(at.row) - WD_UINT(WD_FRAME(wind_period)) * WD_UINT(wd_wind_turns(north)));
        WD_VECTOR wave = wd_gradient_noise(at, 20u + WD_UINT(bits));
        slope = wd_v3_add(slope, wd_v3_scale(wave, share));
        waves.hidden -= each * share * share;
    }
    /* the noise's gradient has a variance of 0.26 each way */
    slope = wd_v3_scale(slope, WD_SQRT(0.5f * each / 0.26f));
    waves.normal = wd_v3_normalize(WD_V3(-slope.y, -slope.z, 1.0f));
    return waves;
}

/* The normal of one of the facets that a pixel hides, among those that the eye sees, by two numbers
 * 0..1. Slopes are Gaussian; that toward the eye, x in units of its spread, is seen by m + x, m the eye's
 * own slope over the water. Its mean is P / (m P + p) and its mean square (m P + 2 p) / (m P + p), P
 * the normal distribution at m and p its density: a Gaussian with these is very near it. */
WD_FUNC WD_VECTOR wd_water_facet(WD_STRUCT wd_waves waves, WD_VECTOR direction, float first,
                                 float second)
{
    float spread = WD_SQRT(0.5f * WD_MAX(waves.hidden, 1e-8f));
    float level = WD_MAX(WD_SQRT(direction.x * direction.x + direction.y * direction.y), 1e-3f);
    float ahead_x = direction.x / level, ahead_y = direction.y / level;
    WD_VECTOR n = waves.normal;
    float away = -(n.x * ahead_x + n.y * ahead_y) / n.z; /* rise away from the eye, and across */
    float across = -(n.y * ahead_x - n.x * ahead_y) / n.z;
    float m = WD_CLAMP((away - direction.z / level) / spread, -2.0f, 1e3f);
    float p = 0.3989423f * WD_EXP(-0.5f * m * m);
    float below = 1.0f / (1.0f + WD_EXP(-m * (1.5976f + 0.070566f * m * m))); /* within 2e-4 */
    float seen = m * below + p, mean = below / seen;
    float deviation = WD_SQRT(WD_MAX((seen + p) / seen - mean * mean, 0.0f));
    float radius = WD_SQRT(-2.0f * WD_LOG2(WD_MAX(first, 1e-4f)) * 0.6931472f);
    float x = WD_MAX(mean + deviation * radius * WD_COS(6.2831853f * second), 0.05f - m);
    away += spread * x;
    across += spread * radius * WD_SIN(6.2831853f * second);
    return wd_v3_normalize(WD_V3(across * ahead_y - away * ahead_x,
                                 -across * ahead_x - away * ahead_y, 1.0f));
}

/* Share of the light that is mirrored toward the eye (Schlick 1994); `direction` is the eye's. */
WD_FUNC float wd_water_fresnel(WD_VECTOR normal, WD_VECTOR direction)
{
    float rest = 1.0f - WD_CLAMP(-wd_v3_dot(normal, direction), 0.0f, 1.0f);
    float rest2 = rest * rest;
    return 0.02f + 0.98f * rest2 * rest2 * rest;
}

/* Where a ray goes on from a facet: never into the water. */
WD_FUNC WD_VECTOR wd_water_mirrored(WD_VECTOR normal, WD_VECTOR direction)
{
    float facing = wd_v3_dot(direction, normal);
    WD_VECTOR mirrored = wd_v3_sub(direction, wd_v3_scale(normal, 2.0f * facing));
    mirrored.z = WD_MAX(mirrored.z, 0.005f);
    return wd_v3_normalize(mirrored);
}

/* Sun in a surface of Gaussian slopes. */
WD_FUNC WD_VECTOR wd_water_glint(WD_FRAME_IN WD_STRUCT wd_waves waves, WD_VECTOR direction)
{
    WD_VECTOR sun = WD_FRAME_V3(sun_direction);
    WD_VECTOR half_way = wd_v3_normalize(wd_v3_sub(sun, direction));
    float variance = WD_MAX(0.5f * waves.hidden, 0.0004f); /* each way */
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
