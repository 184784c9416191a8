#include "reference/display.h"

#include <stddef.h>

#include "shared/exposure.h"
#include "shared/hash.h"

/* Every second pixel of every second row. */
float wd_display_exposure(const float *color, uint32_t width, uint32_t height)
{
    uint32_t bins[WD_METER_BINS] = {0};
    for (uint32_t y = 0; y < height; y += 2)
        for (uint32_t x = 0; x < width; x += 2)
            bins[wd_meter_bin(wd_luminance(wd_v3_of(color + 3 * ((size_t)y * width + x))))]++;
    return wd_exposure_of(bins);
}

void wd_display_map_at(const float *color, uint32_t width, uint32_t height, float exposure,
                       uint8_t *display)
{
    for (uint32_t y = 0; y < height; y++) {
        for (uint32_t x = 0; x < width; x++) {
            size_t pixel = (size_t)y * width + x;
            struct wd_vec3 mapped =
                wd_tone_display(wd_v3_scale(wd_v3_of(color + 3 * pixel), exposure));
            const float shown[3] = {mapped.x, mapped.y, mapped.z};
            uint32_t random = wd_hash2(x, y); /* half a step of noise hides the steps of 8 bits */
            for (int k = 0; k < 3; k++) {
                float dither = (float)(random >> (10 * k + (k == 2 ? 2 : 0)) & 0x3ffu) / 1023 - 0.5f;
                float value = shown[k] * 255 + dither;
                display[4 * pixel + (size_t)k] = (uint8_t)(wd_clampf(value, 0, 255) + 0.5f);
            }
            display[4 * pixel + 3] = 255;
        }
    }
}

void wd_display_map(const float *color, uint32_t width, uint32_t height, float exposure_ev,
                    uint8_t *display)
{
    float exposure = wd_display_exposure(color, width, height) * exp2f(exposure_ev);
    wd_display_map_at(color, width, height, exposure, display);
}
