#include "tree_test.h"

#include "base/color.h"

enum { SIZE = 128 };

static double row_difference(const uint8_t *rgba, int a, int b, int stride, int step)
{
    double sum = 0;
    for (int i = 0; i < SIZE; i++)
        for (int k = 0; k < 3; k++)
            sum += fabs((double)rgba[4 * (a * stride + i * step) + k] -
                        (double)rgba[4 * (b * stride + i * step) + k]);
    return sum / (3 * SIZE);
}

/* The step across the seam is no larger than the largest steps elsewhere. */
static void assert_seamless(const uint8_t *rgba, int stride, int step)
{
    double largest = 0;
    for (int i = 0; i + 1 < SIZE; i++)
        largest = fmax(largest, row_difference(rgba, i, i + 1, stride, step));
    assert_true(row_difference(rgba, SIZE - 1, 0, stride, step) <= 1.15 * largest);
}

static void mean_linear(const uint8_t *rgba, double mean[3])
{
    for (int k = 0; k < 3; k++) {
        mean[k] = 0;
        for (int i = 0; i < SIZE * SIZE; i++)
            mean[k] += (double)wd_srgb_decode(rgba[4 * i + k]) / (SIZE * SIZE);
    }
}

static void bark_tiles_and_keeps_its_colour(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    uint8_t *rgba = malloc(4 * SIZE * SIZE);
    for (int s = 0; s < SPECIES_COUNT; s++) {
        struct wd_species species = test_species(&arena, test_species_names[s]);
        double mean[3];
        wd_species_bark_texture(&species, SIZE, rgba);
        assert_seamless(rgba, SIZE, 1);
        assert_seamless(rgba, 1, SIZE);
        mean_linear(rgba, mean);
        for (int k = 0; k < 3; k++) {
            double plate = fmax((double)species.bark.color[k],
                                fmax((double)species.bark.upper_color[k],
                                     (double)species.bark.twig_color[k]));
            assert_true(mean[k] > 0.45 * plate && mean[k] < 1.25 * plate);
        }
    }
    free(rgba);
    wd_arena_finish(&arena);
}

static void leaf_texture_keeps_the_albedo(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    uint8_t *rgba = malloc(4 * SIZE * SIZE);
    for (int s = 0; s < SPECIES_COUNT; s++) {
        struct wd_species species = test_species(&arena, test_species_names[s]);
        double mean[3];
        wd_species_leaf_texture(&species, SIZE, rgba);
        mean_linear(rgba, mean);
        for (int k = 0; k < 3; k++) /* tints average 0.8 */
            assert_float_equal(0.8 * mean[k] / (double)species.leaf.color[k], 1, 0.12);
        for (int i = 0; i < SIZE * SIZE; i++)
            assert_int_equal(rgba[4 * i + 3], 255);
    }
    free(rgba);
    wd_arena_finish(&arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bark_tiles_and_keeps_its_colour),
        cmocka_unit_test(leaf_texture_keeps_the_albedo),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
