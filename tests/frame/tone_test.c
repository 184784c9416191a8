/* The tone curve's polynomials beside what they stand for. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "shared/tone.h"

enum { STEPS = 4096 };

/* AgX's base look (Wrensch 2023) with its contrast. */
static double exact_curve(double x)
{
    double x2 = x * x, x4 = x2 * x2;
    double y = 15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x -
               0.00232;
    return 1.15 * pow(y > 0 ? y : 0, 1.42);
}

static void curve_is_agx(void **state)
{
    (void)state;
    float before = -1;
    for (int i = 0; i <= STEPS; i++) {
        double x = (double)i / STEPS;
        float y = wd_tone_curve((float)(x * 16.5 - 12.47393));
        assert_float_equal(y, exact_curve(x), 2e-4);
        assert_true(y >= before - 2e-6f);
        before = y;
    }
}

static void encoding_is_that_of_srgb(void **state)
{
    (void)state;
    float before = -1;
    for (int i = 0; i <= STEPS; i++) {
        float v = (float)i / STEPS, encoded = wd_tone_encode(v);
        assert_float_equal(encoded, wd_display_encode(powf(v, 2.2f)), 2e-4);
        assert_true(encoded >= before - 1e-4f);
        before = encoded;
    }
    assert_float_equal(wd_tone_encode(-3), 0, 1e-6);
    assert_float_equal(wd_tone_encode(7), 1, 2e-4);
}

/* Grey stays grey, and more light is never darker. */
static void grey_stays_grey(void **state)
{
    (void)state;
    float before = -1;
    for (int i = 0; i < 200; i++) {
        float light = exp2f((float)i * 0.08f - 12);
        struct wd_vec3 shown =
            wd_tone_display(WD_V3(light / 1.04f, light, light / 0.93f)); /* less the white balance */
        assert_float_equal(shown.x, shown.y, 2e-3);
        assert_float_equal(shown.z, shown.y, 2e-3);
        assert_true(shown.y >= before - 2e-4f);
        before = shown.y;
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(curve_is_agx),
        cmocka_unit_test(encoding_is_that_of_srgb),
        cmocka_unit_test(grey_stays_grey),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
