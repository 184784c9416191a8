#include "output/convolve.h"

static uint32_t clamp_index(int64_t i, uint32_t count)
{
    return i < 0 ? 0 : i >= count ? count - 1 : (uint32_t)i;
}

static void filter_rows(float *result, const float *plane, uint32_t width, uint32_t height,
                        const float *kernel, int radius)
{
    for (uint32_t y = 0; y < height; y++) {
        const float *row = plane + (size_t)y * width;
        for (uint32_t x = 0; x < width; x++) {
            float sum = 0;
            for (int k = -radius; k <= radius; k++)
                sum += kernel[k + radius] * row[clamp_index((int64_t)x + k, width)];
            result[(size_t)y * width + x] = sum;
        }
    }
}

static void filter_columns(float *result, const float *plane, uint32_t width, uint32_t height,
                           const float *kernel, int radius)
{
    for (uint32_t y = 0; y < height; y++) {
        float *row = result + (size_t)y * width;
        for (uint32_t x = 0; x < width; x++)
            row[x] = 0;
        for (int k = -radius; k <= radius; k++) {
            const float *from = plane + (size_t)clamp_index((int64_t)y + k, height) * width;
            for (uint32_t x = 0; x < width; x++)
                row[x] += kernel[k + radius] * from[x];
        }
    }
}

void wd_convolve(float *result, float *scratch, const float *plane, uint32_t width,
                 uint32_t height, const float *across, const float *down, int radius)
{
    filter_rows(scratch, plane, width, height, across, radius);
    filter_columns(result, scratch, width, height, down, radius);
}
