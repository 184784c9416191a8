/* tone.h: from radiance to what a display shows; exposure from a histogram of luminance. */
#ifndef WD_SHARED_TONE_H
#define WD_SHARED_TONE_H

#include "shared/light.h"
#include "shared/vec.h"

WD_FUNC float wd_luminance(WD_VECTOR radiance)
{
    return wd_v3_dot(radiance, WD_V3(0.2126f, 0.7152f, 0.0722f));
}

/* Class of the histogram that a luminance falls into. */
WD_FUNC uint32_t wd_meter_bin(float luminance)
{
    float at = (WD_LOG2(WD_MAX(luminance, 1e-30f)) - WD_METER_LOW) * WD_METER_PER_EV;
    return WD_UINT(WD_CLAMP(at, 0.0f, WD_FLOAT(WD_METER_BINS) - 1.0f));
}

WD_FUNC float wd_meter_log2(int32_t bin)
{
    return WD_METER_LOW + (WD_FLOAT(bin) + 0.5f) / WD_METER_PER_EV;
}

/* Middle grey for daylight, less for dusk and night: pictures of the night should be dark
 * (Krawczyk et al. 2005: key = 1.03 - 2 / (2 + log10(L + 1)), L in cd/m2). */
WD_FUNC float wd_meter_key(float luminance)
{
    float nits = luminance * 41000.0f;
    float key = 1.03f - 2.0f / (2.0f + WD_LOG2(nits + 1.0f) * 0.30103f);
    return 0.235f * WD_CLAMP(key / 0.62f, 0.15f, 1.1f);
}

/* AgX (Sobotka 2022; polynomial by Wrensch 2023): colours are drawn toward each other before a film-like
 * curve over 16.5 stops, so that bright ones pale without a turn of hue. Its flat base look to the power of 1.42
 * and times 1.15 (ASC CDL), for more contrast, is this within 1e-4 (tests/frame/tone_test.c): on software devices a
 * power costs as much as all of it. */
WD_FUNC float wd_tone_curve(float stops)
{
    float x = WD_CLAMP((stops + 12.47393f) / 16.5f, 0.0f, 1.0f);
    float y = -39.824152f;
    y = y * x + 153.838137f;
    y = y * x - 205.864123f;
    y = y * x + 104.677524f;
    y = y * x - 11.70336f;
    y = y * x + 0.1186268f;
    y = y * x - 0.24327775f;
    y = y * x + 0.14383392f;
    y = y * x + 0.0044726677f;
    return WD_MAX(y * x - 0.00007474968f, 0.0f);
}

/* The power of 2.2 that AgX's numbers are linear light by, and sRGB's transfer function of that, within 1e-4. */
WD_FUNC float wd_tone_encode(float value)
{
    float v = WD_CLAMP(value, 0.0f, 1.0f);
    float toe = ((18.9621f * v + 6.57326f) * v - 0.0220587f) * v;
    float rest = ((((0.180923f * v - 0.586661f) * v + 0.770794f) * v - 0.580943f) * v + 1.26461f) * v - 0.0486283f;
    return v < 0.0727f ? WD_MAX(toe, 0.0f) : WD_MIN(rest, 1.0f);
}

/* `radiance` times the exposure; the result is what a display of sRGB is told, 0..1. */
WD_FUNC WD_VECTOR wd_tone_display(WD_VECTOR radiance)
{
    /* white balance for sun and sky together, as of a camera set to daylight */
    WD_VECTOR c = wd_v3_mul(radiance, WD_V3(1.04f, 1.0f, 0.93f));
    float r = wd_v3_dot(c, WD_V3(0.842479062253094f, 0.0784335999999992f, 0.0792237451477643f));
    float g = wd_v3_dot(c, WD_V3(0.0423282422610123f, 0.878468636469772f, 0.0791661274605434f));
    float b = wd_v3_dot(c, WD_V3(0.0423756549057051f, 0.0784336f, 0.879142973793104f));
    c = WD_V3(wd_tone_curve(WD_LOG2(WD_MAX(r, 1e-10f))), wd_tone_curve(WD_LOG2(WD_MAX(g, 1e-10f))),
              wd_tone_curve(WD_LOG2(WD_MAX(b, 1e-10f))));
    float luma = wd_luminance(c); /* and more colour */
    c = WD_V3(luma + 1.16f * (c.x - luma), luma + 1.16f * (c.y - luma), luma + 1.16f * (c.z - luma));
    r = wd_v3_dot(c, WD_V3(1.19687900512017f, -0.0980208811401368f, -0.0990297440797205f));
    g = wd_v3_dot(c, WD_V3(-0.0528968517574562f, 1.15190312990417f, -0.0989611768448433f));
    b = wd_v3_dot(c, WD_V3(-0.0529716355144438f, -0.0980434501171241f, 1.15107367264116f));
    return WD_V3(wd_tone_encode(r), wd_tone_encode(g), wd_tone_encode(b));
}

/* The sRGB transfer function, of linear values. */
WD_FUNC float wd_display_encode(float linear_value)
{
    return linear_value <= 0.0031308f ? linear_value * 12.92f
                                      : 1.055f * WD_POW(linear_value, 1.0f / 2.4f) - 0.055f;
}

#endif
