#version 460
/* The exposure that the histogram asks for. */
#include "shared/frame.h"
#include "shared/light.h"

layout(local_size_x = 1) in;

layout(scalar, set = 0, binding = 0) readonly buffer Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 1) buffer Meter { wd_meter meter; };

float log2_luminance_of(int bin)
{
    return WD_METER_LOW + (float(bin) + 0.5) / WD_METER_PER_EV;
}

/* x: log-average luminance between the 10th and the 90th percentile (neither the sun's disc nor
 * black holes move it); y: the 94th percentile; both log2. */
vec2 metered()
{
    uint total = 0u;
    for (int i = 0; i < WD_METER_BINS; i++)
        total += meter.bins[i];
    float low = 0.10 * float(total), high = 0.90 * float(total), bright = 0.94 * float(total);
    float before = 0.0, sum = 0.0, weight = 0.0, light = WD_METER_LOW;
    for (int i = 0; i < WD_METER_BINS; i++) {
        float after = before + float(meter.bins[i]);
        float inside = max(min(after, high) - max(before, low), 0.0);
        sum += inside * log2_luminance_of(i);
        weight += inside;
        light = before <= bright ? log2_luminance_of(i) : light;
        before = after;
    }
    return vec2(sum / max(weight, 1e-6), light);
}

/* Middle grey for daylight, less for dusk and night: pictures of the night should be dark
 * (Krawczyk et al. 2005: key = 1.03 - 2 / (2 + log10(L + 1)), L in cd/m2). */
float key_of(float luminance)
{
    float nits = luminance * 41000.0;
    float key = 1.03 - 2.0 / (2.0 + log2(nits + 1.0) * 0.30103);
    return 0.235 * clamp(key / 0.62, 0.15, 1.1);
}

/* Lights are held, too, where a scene is too wide for film: half of what they are over is given. */
void main()
{
    vec2 log2_luminance = metered();
    float luminance = exp2(log2_luminance.x);
    float exposure = key_of(luminance) / luminance;
    float over = exposure * exp2(log2_luminance.y) / 1.2;
    meter.exposure = exposure / sqrt(max(over, 1.0));
}
