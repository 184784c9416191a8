#include "output/ssim.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "output/convolve.h"

enum { RADIUS = 5, MEAN_A = 0, MEAN_B, SQUARE_A, SQUARE_B, PRODUCT, MOMENTS };

/* Rec. 601 luma, 0..255 */
static float luma(const uint8_t *p)
{
    return 0.299f * p[0] + 0.587f * p[1] + 0.114f * p[2];
}

static void fill_moment(float *plane, const uint8_t *a, const uint8_t *b, size_t pixels,
                        uint32_t stride, int moment)
{
    for (size_t i = 0; i < pixels; i++) {
        float x = luma(a + i * stride), y = luma(b + i * stride);
        plane[i] = moment == MEAN_A     ? x
                   : moment == MEAN_B   ? y
                   : moment == SQUARE_A ? x * x
                   : moment == SQUARE_B ? y * y
                                        : x * y;
    }
}

static double pixel_ssim(float *const moments[MOMENTS], size_t i)
{
    const double c1 = 0.01 * 255 * 0.01 * 255, c2 = 0.03 * 255 * 0.03 * 255;
    double x = (double)moments[MEAN_A][i], y = (double)moments[MEAN_B][i];
    double vx = (double)moments[SQUARE_A][i] - x * x, vy = (double)moments[SQUARE_B][i] - y * y;
    double vxy = (double)moments[PRODUCT][i] - x * y;
    return (2 * x * y + c1) * (2 * vxy + c2) / ((x * x + y * y + c1) * (vx + vy + c2));
}

double wd_ssim(const uint8_t *a, const uint8_t *b, uint32_t width, uint32_t height,
               uint32_t stride)
{
    size_t pixels = (size_t)width * height;
    float kernel[2 * RADIUS + 1], weight = 0, *moments[MOMENTS];
    float *plane = wd_alloc_array(pixels, sizeof *plane);
    float *scratch = wd_alloc_array(pixels, sizeof *scratch);
    double sum = 0;
    for (int k = -RADIUS; k <= RADIUS; k++)
        weight += kernel[k + RADIUS] = expf(-(float)(k * k) / (2 * 1.5f * 1.5f));
    for (int k = 0; k <= 2 * RADIUS; k++)
        kernel[k] /= weight;
    for (int m = 0; m < MOMENTS; m++) {
        moments[m] = wd_alloc_array(pixels, sizeof(float));
        fill_moment(plane, a, b, pixels, stride, m);
        wd_convolve(moments[m], scratch, plane, width, height, kernel, kernel, RADIUS);
    }
    for (size_t i = 0; i < pixels; i++)
        sum += pixel_ssim(moments, i);
    for (int m = 0; m < MOMENTS; m++)
        free(moments[m]);
    free(plane);
    free(scratch);
    return pixels ? sum / (double)pixels : 1;
}
