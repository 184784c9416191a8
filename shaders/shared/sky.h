/* sky.h: radiance of a clear sky, and what of the sun reaches the ground; alike in C and GLSL.
 *
 * Single scattering in a plane-parallel atmosphere has a closed form. With optical depth tau along
 * the vertical, relative air masses v (of the view) and s (of the sun), light that is scattered
 * once at depth t has come through s t and leaves through v t, so
 *
 *   L = E0 P v int_0^tau exp(-s t - v (tau - t)) dt
 *     = E0 P v (exp(-tau s) - exp(-tau v)) / (v - s)
 *
 * (Chandrasekhar 1960, section 47, with true air masses in place of secants, so that it holds to
 * the horizon: Young 1994). P mixes the phase functions of air (Rayleigh) and haze (Henyey and
 * Greenstein, g = 0.76) by their optical depths. Light scattered more than once is nearly
 * isotropic and comes from the same air: a share of what the first scattering took from the sun.
 *
 * Optical depths at 680, 550, 440 nm: air after Bucholtz 1995; haze by Angstrom's law with
 * Preetham's (1999) relation of turbidity to beta = 0.0461 T - 0.0459; ozone: 300 Dobson units in
 * the Chappuis band. Radiances are in units of a white surface lit by the sun outside the
 * atmosphere: one unit is about 41,000 cd/m2. */
#ifndef WD_SHARED_SKY_H
#define WD_SHARED_SKY_H

#include "shared/vec.h"

#define WD_SUN_OUTSIDE 3.14159265f /* irradiance: pi, so that a white surface returns 1 */
#define WD_HAZE_G 0.76f

/* One colour of the sky. */
struct wd_sky_band {
    float air, haze, ozone; /* vertical optical depths */
};

WD_FUNC WD_STRUCT wd_sky_band wd_sky_band_of(int32_t channel, float turbidity)
{
    WD_STRUCT wd_sky_band band;
    float beta = 0.0461f * turbidity - 0.0459f;
    beta = beta > 0.002f ? beta : 0.002f;
    band.air = channel == 0 ? 0.0421f : channel == 1 ? 0.0985f : 0.2460f;
    band.haze = beta * (channel == 0 ? 1.651f : channel == 1 ? 2.175f : 2.907f);
    band.ozone = channel == 0 ? 0.0190f : channel == 1 ? 0.0300f : 0.0010f;
    return band;
}

/* Relative air mass toward a direction with this sine of elevation (Young 1994); 31.7 at the
 * horizon and below. */
WD_FUNC float wd_air_mass(float rise)
{
    float c = rise > 0.0f ? rise : 0.0f;
    return (1.002432f * c * c + 0.148386f * c + 0.0096467f)
           / (c * c * c + 0.149864f * c * c + 0.0102963f * c + 0.000303978f);
}

/* Light of a sun below the horizon still reaches the upper air: illuminance falls by some e^0.9 a
 * degree down to nautical twilight. */
WD_FUNC float wd_twilight(float sun_rise)
{
    return WD_EXP(52.0f * WD_MIN(sun_rise, 0.0f)); /* by no branch: llvmpipe makes a shader for each */
}

WD_FUNC float wd_air_phase(float cosine)
{
    return 0.0596831f * (1.0f + cosine * cosine); /* 3 / (16 pi) */
}

/* Henyey and Greenstein's. */
WD_FUNC float wd_haze_phase(float cosine)
{
    float x = 1.0f + WD_HAZE_G * WD_HAZE_G - 2.0f * WD_HAZE_G * cosine;
    return 0.0795775f * (1.0f - WD_HAZE_G * WD_HAZE_G) / (x * WD_SQRT(x));
}

/* Radiance of one band toward a direction: air masses v of the view and s of the sun, both phases,
 * `sun_rise` the sine of the sun's elevation. */
WD_FUNC float wd_sky_radiance(WD_STRUCT wd_sky_band band, float v, float s, float air_phase,
                              float haze_phase, float sun_rise)
{
    float low = s;
    float tau = band.air + band.haze;
    s = low / (1.0f + 0.03f * low); /* what lights the upper air has passed less of it */
    float phase = (air_phase * band.air + haze_phase * band.haze) / tau;
    float through_sun = WD_EXP(-tau * s), through_view = WD_EXP(-tau * v);
    float apart = v - s;
    float once = WD_ABS(apart) > 0.01f * s ? v * (through_sun - through_view) / apart
                                           : tau * v * through_sun;
    float height = sun_rise > 0.0f ? sun_rise : 0.0f;
    float again = 0.40f * (height + 0.02f) * (1.0f - through_sun) * (1.0f - through_view);
    float above = WD_EXP(-band.ozone * low * 0.8f); /* ozone lies above the air */
    return (WD_SUN_OUTSIDE * phase * once + again) * above * wd_twilight(sun_rise);
}

/* An overcast sky is three times as bright overhead as at the horizon (Moon and Spencer 1942):
 * radiance over that of the zenith. Its irradiance on level ground is 7 pi / 9 of the zenith's
 * radiance. */
WD_FUNC float wd_cloud_gradient(float rise)
{
    return (1.0f + 2.0f * (rise > 0.0f ? rise : 0.0f)) / 3.0f;
}

/* Share of a clear day's light, sun and sky on level ground, that a sky with this cover of clouds
 * lets through (Kasten and Czeplak 1980). */
WD_FUNC float wd_cloud_through(float cover)
{
    return 1.0f - 0.75f * WD_EXP2(3.4f * WD_LOG2(cover > 1e-3f ? cover : 1e-3f));
}

/* Share of the sun's light that comes straight through. */
WD_FUNC float wd_sun_through(WD_STRUCT wd_sky_band band, float s)
{
    return WD_EXP(-(band.air + band.haze + band.ozone) * s);
}

#endif
