/* What stems hide of the sky from the ground beside them. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "shared/crown_sky.h"

/* Of an endless upright cylinder, by rays over the sky by what level ground has of them. */
static double cylinder_hides(double away_m, double radius_m)
{
    enum { BEARINGS = 4096 };
    int hidden = 0; /* at every height alike */
    for (int i = 0; i < BEARINGS; i++) {
        double bearing = 6.283185307179586 * (i + 0.5) / BEARINGS;
        double past_m = fabs(away_m * sin(bearing));
        hidden += cos(bearing) > 0 && past_m < radius_m;
    }
    return hidden / (double)BEARINGS;
}

static void a_stem_hides_what_a_cylinder_would(void **state)
{
    (void)state;
    for (float radius_m = 0.02f; radius_m < 0.36f; radius_m += 0.02f)
        for (float away_m = WD_STEM_ROOTS_END * radius_m; away_m <= WD_STEM_REACH_M; away_m += 0.02f) {
            float exact = (float)cylinder_hides((double)away_m, (double)radius_m);
            assert_float_equal(wd_stem_hides(away_m, radius_m), exact, 2e-3f);
        }
}

static void roots_hide_more_at_its_foot(void **state)
{
    (void)state;
    float before = 1;
    for (float away_m = 0.3f; away_m < 2.5f; away_m += 0.05f) {
        float hides = wd_stem_hides(away_m, 0.3f);
        assert_true(hides <= before && hides >= 0);
        before = hides;
    }
    assert_true(wd_stem_hides(0.3f, 0.3f) > 0.7f && wd_stem_hides(0.3f, 0.3f) < 0.8f);
    assert_true(wd_stem_hides(WD_STEM_NO_REACH_M, 0.3f) == 0);
}

static void stems_are_told_to_two_millimetres(void **state)
{
    (void)state;
    for (float east_m = -WD_STEM_FAR_M; east_m < WD_STEM_FAR_M; east_m += 0.37f)
        for (float radius_m = 0.01f; radius_m < WD_STEM_MOST_M; radius_m *= 1.7f) {
            uint32_t stem = wd_stem_pack(east_m, -east_m, radius_m);
            assert_float_equal(WD_STEM_EAST_M(stem), east_m, 0.002f);
            assert_float_equal(WD_STEM_NORTH_M(stem), -east_m, 0.002f);
            assert_float_equal(WD_STEM_RADIUS_M(stem), radius_m, 0.0011f);
            assert_true(stem != 0);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_stem_hides_what_a_cylinder_would),
        cmocka_unit_test(roots_hide_more_at_its_foot),
        cmocka_unit_test(stems_are_told_to_two_millimetres),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
