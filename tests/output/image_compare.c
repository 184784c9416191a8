#include "image_compare.h"

#include <math.h>
#include <stdlib.h>

#include "base/color.h"
#include "base/memory.h"

enum { BLOCK = 16 };

static unsigned distance(uint8_t a, uint8_t b)
{
    return a > b ? (unsigned)(a - b) : (unsigned)(b - a);
}

void wd_image_block_means(const uint8_t *rgb, uint32_t width, uint32_t height, uint32_t block,
                          float *means)
{
    uint32_t columns = (width + block - 1) / block, rows = (height + block - 1) / block;
    const float *linear = wd_srgb_table();
    double *sums = wd_alloc_array((size_t)columns * rows * 3, sizeof *sums);
    for (uint32_t y = 0; y < height; y++) {
        double *row = sums + (size_t)(y / block) * columns * 3;
        for (uint32_t x = 0; x < width; x++, rgb += 3) {
            for (int c = 0; c < 3; c++)
                row[x / block * 3 + c] += (double)linear[rgb[c]];
        }
    }
    for (uint32_t j = 0; j < rows; j++) {
        uint32_t tall = height - j * block < block ? height - j * block : block;
        for (uint32_t i = 0; i < columns; i++) {
            uint32_t wide = width - i * block < block ? width - i * block : block;
            for (int c = 0; c < 3; c++) {
                size_t at = ((size_t)j * columns + i) * 3 + c;
                means[at] = (float)(sums[at] / ((double)wide * tall));
            }
        }
    }
    free(sums);
}

static void compare_blocks(const uint8_t *a, const uint8_t *b, uint32_t width, uint32_t height,
                           struct wd_image_difference *difference)
{
    size_t count = (size_t)((width + BLOCK - 1) / BLOCK) * ((height + BLOCK - 1) / BLOCK) * 3;
    float *means_a = wd_alloc_array(count, sizeof *means_a);
    float *means_b = wd_alloc_array(count, sizeof *means_b);
    wd_image_block_means(a, width, height, BLOCK, means_a);
    wd_image_block_means(b, width, height, BLOCK, means_b);
    double squares = 0, sum_a = 0, sum_b = 0;
    for (size_t i = 0; i < count; i++) {
        double apart = fabs((double)means_a[i] - (double)means_b[i]);
        squares += apart * apart;
        difference->block_max_linear = fmax(difference->block_max_linear, apart);
        sum_a += (double)means_a[i];
        sum_b += (double)means_b[i];
    }
    difference->block_rmse_linear = sqrt(squares / (double)count);
    difference->brightness_ratio = sum_a > 0 ? sum_b / sum_a : 1;
    free(means_a);
    free(means_b);
}

struct wd_image_difference wd_image_compare(const uint8_t *a, const uint8_t *b, uint32_t width,
                                            uint32_t height)
{
    struct wd_image_difference difference = {.brightness_ratio = 1};
    size_t pixels = (size_t)width * height;
    if (pixels == 0)
        return difference;
    const float *linear = wd_srgb_table();
    double squares = 0;
    uint64_t sum = 0, different = 0;
    for (size_t i = 0; i < pixels; i++) {
        unsigned worst = 0;
        for (size_t at = i * 3; at < i * 3 + 3; at++) {
            unsigned apart = distance(a[at], b[at]);
            double light = (double)linear[a[at]] - (double)linear[b[at]];
            squares += light * light;
            sum += apart;
            worst = apart > worst ? apart : worst;
        }
        different += worst > 0;
        difference.max_absolute = worst > difference.max_absolute ? worst : difference.max_absolute;
    }
    difference.rmse_linear = sqrt(squares / (double)(pixels * 3));
    difference.mean_absolute = (double)sum / (double)(pixels * 3);
    difference.different_share = (double)different / (double)pixels;
    compare_blocks(a, b, width, height, &difference);
    return difference;
}

void wd_image_difference_picture(const uint8_t *a, const uint8_t *b, uint32_t width,
                                 uint32_t height, unsigned gain, uint8_t *picture)
{
    for (size_t i = 0; i < (size_t)width * height * 3; i++) {
        unsigned apart = distance(a[i], b[i]) * gain;
        picture[i] = (uint8_t)(apart > 255 ? 255 : apart);
    }
}
