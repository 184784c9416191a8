#include <math.h>

#include "common.h"
#include "image_compare.h"

static void equal_pictures_differ_in_nothing(void **state)
{
    (void)state;
    uint8_t *a = make_picture(50, 40, 1);
    struct wd_image_difference d = wd_image_compare(a, a, 50, 40);
    assert_true(d.rmse_linear == 0 && d.mean_absolute == 0 && d.max_absolute == 0);
    assert_true(d.block_rmse_linear == 0 && d.block_max_linear == 0 && d.brightness_ratio == 1);
    free(a);
}

/* Black against white in one of 20 x 17 pixels. */
static void one_pixel_counts_as_much_as_it_should(void **state)
{
    (void)state;
    uint8_t *a = wd_alloc(20 * 17 * 3), *b = wd_alloc(20 * 17 * 3);
    memset(b + 3 * 19, 255, 3); /* upper right corner: in the block of 4 x 16 pixels */
    struct wd_image_difference d = wd_image_compare(a, b, 20, 17);
    assert_true(fabs(d.rmse_linear - sqrt(1.0 / 340)) < 1e-12);
    assert_true(fabs(d.mean_absolute - 255.0 / 340) < 1e-12);
    assert_int_equal(d.max_absolute, 255);
    assert_true(fabs(d.different_share - 1.0 / 340) < 1e-12);
    assert_true(fabs(d.block_max_linear - 1.0 / 64) < 1e-7);
    assert_true(fabs(d.block_rmse_linear - 1.0 / 64 / 2) < 1e-7); /* one block of four */
    assert_true(d.brightness_ratio == 1);                         /* a is black */
    free(a);
    free(b);
}

/* Half of the pixels 0 and half 255 is half the light, as sRGB 188 is: blocks see no difference. */
static void blocks_compare_light_not_codes(void **state)
{
    (void)state;
    uint8_t *a = wd_alloc(64 * 64 * 3), *b = wd_alloc(64 * 64 * 3);
    for (size_t i = 0; i < 64 * 64 * 3; i++) {
        a[i] = i / 3 % 2 ? 255 : 0;
        b[i] = 188;
    }
    struct wd_image_difference d = wd_image_compare(a, b, 64, 64);
    assert_true(d.block_max_linear < 0.005 && fabs(d.brightness_ratio - 1) < 0.01);
    assert_true(d.rmse_linear > 0.49 && d.max_absolute == 188);
    uint8_t picture[64 * 64 * 3];
    wd_image_difference_picture(a, b, 64, 64, 2, picture);
    assert_true(picture[0] == 255 && picture[3] == 134);
    free(a);
    free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_pictures_differ_in_nothing),
        cmocka_unit_test(one_pixel_counts_as_much_as_it_should),
        cmocka_unit_test(blocks_compare_light_not_codes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
