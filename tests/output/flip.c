/* FLIP and SSIM. Expected values of FLIP were computed with the authors' own program (FLIP.h of
 * github.com/NVlabs/flip, default parameters) on the same pixels. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "output/flip.h"
#include "output/ssim.h"
#include "shared/hash.h"

enum { WIDTH = 96, HEIGHT = 64 };

static void fill(uint8_t *pixels, int changed)
{
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++)
            for (uint32_t c = 0; c < 3; c++) {
                uint32_t value = wd_hash_mix(x / 8 * 73u + y / 8 * 179u + c * 283u + 7u) >> 24;
                if (changed)
                    value = value * 3 / 4 + (wd_hash_mix(x * 31 + y * 977 + c) >> 26);
                if (changed && x > 40 && x < 52 && y > 20)
                    value = 255 - value;
                pixels[3 * (y * WIDTH + x) + c] = (uint8_t)(value > 255 ? 255 : value);
            }
}

static double flip(const uint8_t *a, const uint8_t *b, float *error)
{
    return wd_flip(error, a, b, WIDTH, HEIGHT, 3, WD_FLIP_PIXELS_PER_DEGREE);
}

static void test_flip_of_patterns(void **state)
{
    (void)state;
    static uint8_t a[WIDTH * HEIGHT * 3], b[WIDTH * HEIGHT * 3];
    static float error[WIDTH * HEIGHT];
    fill(a, 0);
    fill(b, 1);
    assert_true(fabs(flip(a, b, error) - 0.420949) < 1e-4);
    assert_true(fabsf(error[30 * WIDTH + 45] - 0.969260f) < 5e-4f);
    assert_true(fabsf(error[10 * WIDTH + 10] - 0.407422f) < 5e-4f);
    assert_true(fabsf(error[60 * WIDTH + 90] - 0.431360f) < 5e-4f);
    assert_true(fabsf(error[0] - 0.273347f) < 5e-4f);
    assert_true(flip(a, a, error) == 0);
}

static void test_flip_of_colors(void **state)
{
    (void)state;
    static const uint8_t colors[5][3] = {
        {0, 0, 0}, {255, 255, 255}, {0, 255, 0}, {0, 0, 255}, {200, 30, 90}};
    static const double expected[10] = {0.967388, 0.996970, 0.958333, 0.957589, 0.973394,
                                        0.971203, 0.962039, 1.000000, 0.989757, 0.908733};
    static uint8_t a[WIDTH * HEIGHT * 3], b[WIDTH * HEIGHT * 3];
    static float error[WIDTH * HEIGHT];
    int pair = 0;
    for (int i = 0; i < 5; i++)
        for (int j = i + 1; j < 5; j++) {
            for (int p = 0; p < WIDTH * HEIGHT * 3; p++) {
                a[p] = colors[i][p % 3];
                b[p] = colors[j][p % 3];
            }
            assert_true(fabs(flip(a, b, error) - expected[pair++]) < 1e-4);
        }
}

/* For equal variances around different means the formula can be worked out by hand. */
static void test_ssim(void **state)
{
    (void)state;
    static uint8_t a[WIDTH * HEIGHT * 3], b[WIDTH * HEIGHT * 3];
    fill(a, 0);
    assert_true(fabs(wd_ssim(a, a, WIDTH, HEIGHT, 3) - 1) < 1e-6);
    memset(a, 100, sizeof a);
    memset(b, 120, sizeof b);
    double expected = (2.0 * 100 * 120 + 6.5025) / (100.0 * 100 + 120.0 * 120 + 6.5025);
    assert_true(fabs(wd_ssim(a, b, WIDTH, HEIGHT, 3) - expected) < 1e-4);
    fill(a, 0);
    fill(b, 1);
    double changed = wd_ssim(a, b, WIDTH, HEIGHT, 3);
    assert_true(changed > 0.1 && changed < 0.9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_flip_of_patterns),
        cmocka_unit_test(test_flip_of_colors),
        cmocka_unit_test(test_ssim),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
