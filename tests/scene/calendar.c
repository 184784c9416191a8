/* Dates, and where the sun stands. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scene/calendar.h"

static void test_dates(void **state)
{
    (void)state;
    struct wd_moment moment;
    static const char *const right[] = {"2026-10-20", "2024-02-29", "2000-02-29", "0001-01-01"};
    static const char *const wrong[] = {"2026-02-29", "1900-02-29", "2026-13-01", "2026-00-10",
                                        "2026-04-31", "2026-4-3",   "20-04-2026", "2026-10-20x",
                                        "2026-10",    "",           "tomorrow",   "2026-10-00"};
    for (size_t i = 0; i < sizeof right / sizeof *right; i++)
        assert_true(wd_date_parse(&moment, right[i]));
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_false(wd_date_parse(&moment, wrong[i]));
    assert_true(wd_date_parse(&moment, "2026-07-16"));
    assert_float_equal(wd_month_of(&moment), 7 + 15 / 31.0, 1e-12);
}

static void test_clocks(void **state)
{
    (void)state;
    double hours;
    static const char *const wrong[] = {"24:01", "12:60", "7:30", "07:30:60", "07", "", "07.30",
                                        "-1:00", "07:30:5"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_false(wd_clock_parse(&hours, wrong[i]));
    assert_true(wd_clock_parse(&hours, "24:00"));
    assert_float_equal(hours, 24, 0);
    assert_true(wd_clock_parse(&hours, "16:30:36"));
    assert_float_equal(hours, 16.51, 1e-12);
}

/* The worked example of Reda and Andreas 2004 (NREL SPA): Golden, Colorado, 2003-10-17 12:30:30
 * MST; elevation with refraction 39.8884, azimuth 194.3402. */
static void test_sun(void **state)
{
    (void)state;
    const struct wd_moment moment = {2003, 10, 17, 19 + 30 / 60.0 + 30 / 3600.0};
    double azimuth, elevation;
    wd_sun_position(&moment, 39.742476, -105.1786, &azimuth, &elevation);
    assert_float_equal(azimuth, 194.3402, 0.02);
    assert_float_equal(elevation, 39.8884, 0.02);
}

/* At noon of the solstices the sun stands at the tilt of the axis over and under the equator. */
static void test_solstices(void **state)
{
    (void)state;
    double azimuth, elevation;
    wd_sun_position(&(struct wd_moment){2026, 6, 21, 12.03}, 50, 0, &azimuth, &elevation);
    assert_float_equal(elevation, 90 - 50 + 23.44, 0.05);
    assert_float_equal(azimuth, 180, 0.5);
    wd_sun_position(&(struct wd_moment){2026, 12, 21, 11.97}, -35, 0, &azimuth, &elevation);
    assert_float_equal(elevation, 90 - 35 + 23.44, 0.05);
    assert_true(azimuth < 1 || azimuth > 359); /* in the south it stands in the north */
    wd_sun_position(&(struct wd_moment){2026, 12, 21, 12}, 70, 20, &azimuth, &elevation);
    assert_true(elevation < 0); /* polar night */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_dates), cmocka_unit_test(test_clocks), cmocka_unit_test(test_sun),
        cmocka_unit_test(test_solstices),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
