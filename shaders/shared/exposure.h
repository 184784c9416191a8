/* exposure.h: the exposure that a histogram of luminance (tone.h) asks for. Shaders define
 * WD_BIN_AT(index) before they include this; C functions take the bins. */
#ifndef WD_SHARED_EXPOSURE_H
#define WD_SHARED_EXPOSURE_H

#include "shared/tone.h"

#ifdef __STDC_VERSION__
#define WD_BINS_IN const uint32_t *bins
#define WD_BIN_AT(index) (bins[index])
#else
#define WD_BINS_IN
#endif

/* Of the log-average luminance between the 10th and the 90th percentile: neither the sun's disc nor
 * black holes move it. Lights (the 94th percentile) are held, too, where a scene is too wide for
 * film: half of what they are over is given. */
WD_FUNC float wd_exposure_of(WD_BINS_IN)
{
    uint32_t total = 0u;
    for (int32_t i = 0; i < WD_METER_BINS; i++)
        total += WD_BIN_AT(i);
    float low = 0.10f * WD_FLOAT(total), high = 0.90f * WD_FLOAT(total);
    float bright = 0.94f * WD_FLOAT(total);
    float before = 0.0f, sum = 0.0f, weight = 0.0f, light = WD_METER_LOW;
    for (int32_t i = 0; i < WD_METER_BINS; i++) {
        float after = before + WD_FLOAT(WD_BIN_AT(i));
        float inside = WD_MAX(WD_MIN(after, high) - WD_MAX(before, low), 0.0f);
        sum += inside * wd_meter_log2(i);
        weight += inside;
        light = before <= bright ? wd_meter_log2(i) : light;
        before = after;
    }
    float luminance = WD_EXP2(sum / WD_MAX(weight, 1e-6f));
    float exposure = wd_meter_key(luminance) / luminance;
    float over = exposure * WD_EXP2(light) / 1.2f;
    return exposure / WD_SQRT(WD_MAX(over, 1.0f));
}

#endif
