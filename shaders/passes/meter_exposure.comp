#version 460
/* The exposure that the histogram asks for. */
#include "shared/frame.h"
#include "shared/light.h"

layout(local_size_x = 1) in;

layout(scalar, set = 0, binding = 0) readonly buffer Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 1) buffer Meter { wd_meter meter; };

/* Log-average luminance between the 10th and the 90th percentile: neither the sun's disc nor black
 * holes move it. */
float mean_log2_luminance()
{
    uint total = 0u;
    for (int i = 0; i < WD_METER_BINS; i++)
        total += meter.bins[i];
    float low = 0.10 * float(total), high = 0.90 * float(total);
    float before = 0.0, sum = 0.0, weight = 0.0;
    for (int i = 0; i < WD_METER_BINS; i++) {
        float after = before + float(meter.bins[i]);
        float inside = max(min(after, high) - max(before, low), 0.0);
        sum += inside * (WD_METER_LOW + (float(i) + 0.5) / WD_METER_PER_EV);
        weight += inside;
        before = after;
    }
    return sum / max(weight, 1e-6);
}

/* Middle grey for daylight, less for dusk and night: pictures of the night should be dark
 * (Krawczyk et al. 2005: key = 1.03 - 2 / (2 + log10(L + 1)), L in cd/m2). */
float key_of(float luminance)
{
    float nits = luminance * 41000.0;
    float key = 1.03 - 2.0 / (2.0 + log2(nits + 1.0) * 0.30103);
    return 0.21 * clamp(key / 0.62, 0.04, 1.1);
}

void main()
{
    float luminance = exp2(mean_log2_luminance());
    meter.exposure = key_of(luminance) / luminance;
}
