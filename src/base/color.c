#include "base/color.h"

#include <math.h>
#include <pthread.h>

static float decoded[256];

static void fill_decoded(void)
{
    for (int value = 0; value < 256; value++) {
        float x = (float)value / 255.0f;
        decoded[value] = x <= 0.04045f ? x / 12.92f : powf((x + 0.055f) / 1.055f, 2.4f);
    }
}

const float *wd_srgb_table(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, fill_decoded);
    return decoded;
}

float wd_srgb_decode(uint8_t value)
{
    return wd_srgb_table()[value];
}

uint8_t wd_unorm_encode(float value)
{
    float above = value > 0.0f ? value : 0.0f; /* 0 for NaN */
    return (uint8_t)((above < 1.0f ? above : 1.0f) * 255.0f + 0.5f);
}

uint8_t wd_srgb_encode(float linear)
{
    float x = fmaxf(linear, 0.0f);
    return wd_unorm_encode(x <= 0.0031308f ? 12.92f * x : 1.055f * powf(x, 1.0f / 2.4f) - 0.055f);
}
