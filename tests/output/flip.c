/* FLIP and SSIM. Expected values of FLIP on made pictures were computed with the authors' own
 * program (FLIP.h of github.com/NVlabs/flip, default parameters) on the same pixels. flip [FOLDER]
 * with a folder that holds tree-ref.png and tree-test.png of github.com/gfx-rs/nv-flip-rs: also the
 * values published with that pair */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "output/flip.h"
#include "output/image.h"
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

/* --- a published pair ----------------------------------------------------------------------------
 */

static int compare(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return x < y ? -1 : x > y;
}

/* The error below which `share` of the sum of all errors lies. `errors` are sorted. */
static double weighted_percentile(const float *errors, size_t count, double share)
{
    double sum = 0, part = 0;
    size_t i = 0;
    for (size_t k = 0; k < count; k++)
        sum += (double)errors[k];
    while (i + 1 < count && (part += (double)errors[i]) < share * sum)
        i++;
    return (double)errors[i];
}

static bool read_pair(struct wd_image8 pair[2], const char *folder)
{
    static const char *const names[] = {"tree-ref.png", "tree-test.png"};
    const struct wd_log log = {0};
    char path[1024];
    for (int i = 0; i < 2; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        FILE *file = fopen(path, "rb");
        if (!file || fclose(file) != 0) {
            print_message("%s is not there: the published pair was not compared\n", path);
            return false;
        }
        assert_true(wd_png_read(&pair[i], path, &log));
    }
    return true;
}

static void test_flip_of_published_pair(void **state)
{
    struct wd_image8 pair[2] = {{0}, {0}};
    if (!*state || !read_pair(pair, *state))
        skip();
    size_t count = (size_t)pair[0].width * pair[0].height;
    float *error = malloc(count * sizeof *error);
    assert_non_null(error);
    double mean =
        wd_flip(error, pair[0].pixels, pair[1].pixels, pair[0].width, pair[0].height, 3, 67.0f);
    qsort(error, count, sizeof *error, compare);
    assert_true(fabs(mean - 0.133285) < 1e-5);
    assert_true(fabs(weighted_percentile(error, count, 0.25) - 0.184924) < 1e-4);
    assert_true(fabs(weighted_percentile(error, count, 0.50) - 0.333241) < 1e-4);
    assert_true(fabs(weighted_percentile(error, count, 0.75) - 0.503441) < 1e-4);
    assert_true(fabs((double)error[count - 1] - 0.983044) < 1e-5);
    free(error);
    wd_image8_finish(&pair[0]);
    wd_image8_finish(&pair[1]);
}

/* --- SSIM ----------------------------------------------------------------------------------------
 */

/* The paper's formula, pixel by pixel, the window cut off at the edges as wd_convolve repeats them.
 */
static double plain_ssim(const uint8_t *a, const uint8_t *b)
{
    double sum = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            double w = 0, m[5] = {0};
            for (int k = 0; k < 121; k++) {
                int dx = k % 11 - 5, dy = k / 11 - 5;
                int u = x + dx < 0 ? 0 : x + dx >= WIDTH ? WIDTH - 1 : x + dx;
                int v = y + dy < 0 ? 0 : y + dy >= HEIGHT ? HEIGHT - 1 : y + dy;
                const uint8_t *p = a + 3 * (v * WIDTH + u), *q = b + 3 * (v * WIDTH + u);
                double weight = exp(-(dx * dx + dy * dy) / 4.5);
                double s = 0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2];
                double t = 0.299 * q[0] + 0.587 * q[1] + 0.114 * q[2];
                const double parts[5] = {s, t, s * s, t * t, s * t};
                for (int i = 0; i < 5; i++)
                    m[i] += weight * parts[i];
                w += weight;
            }
            for (int i = 0; i < 5; i++)
                m[i] /= w;
            sum += (2 * m[0] * m[1] + 6.5025) * (2 * (m[4] - m[0] * m[1]) + 58.5225) /
                   ((m[0] * m[0] + m[1] * m[1] + 6.5025) *
                    (m[2] - m[0] * m[0] + m[3] - m[1] * m[1] + 58.5225));
        }
    return sum / (WIDTH * HEIGHT);
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
    assert_true(fabs(changed - plain_ssim(a, b)) < 1e-4);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_flip_of_patterns),
        cmocka_unit_test(test_flip_of_colors),
        cmocka_unit_test_prestate(test_flip_of_published_pair, argc > 1 ? argv[1] : NULL),
        cmocka_unit_test(test_ssim),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
