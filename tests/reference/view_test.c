/* What can be in a traced picture: by rays through its pixels. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "reference/view.h"

enum { WIDTH = 48, HEIGHT = 32 };

static struct wd_trace_view view_of(double yaw_rad, double pitch_rad, double fov_deg)
{
    const struct wd_camera camera = {
        .yaw_rad = yaw_rad, .pitch_rad = pitch_rad, .fov_rad = fov_deg * 0.017453292519943295};
    return wd_trace_view_of(&camera, WIDTH, HEIGHT);
}

static bool sees_point(const struct wd_trace_view *view, struct wd_vec3 at, float radius_m)
{
    return wd_trace_view_sees(view, at, at, radius_m);
}

/* A place so far along a ray through the picture. */
static struct wd_vec3 along(const struct wd_trace_view *view, float x, float y, float way_m)
{
    return wd_v3_scale(wd_v3_unit(wd_trace_view_ray(view, x, y)), way_m);
}

static const struct {
    double yaw, pitch, fov_deg;
} looks[] = {{0, 0, 60}, {2.5, 0.3, 0.1}, {-1, -1.5707963, 50}, {4, 1.5707963, 90}, {0.7, -0.4, 150}};
enum { LOOKS = sizeof looks / sizeof *looks };

static void what_rays_pass_is_seen_and_nothing_beside(void **state)
{
    (void)state;
    for (size_t i = 0; i < LOOKS; i++) {
        const struct wd_trace_view view = view_of(looks[i].yaw, looks[i].pitch, looks[i].fov_deg);
        for (float y = 0.5f; y < HEIGHT; y++)
            for (float x = 0.5f; x < WIDTH; x++)
                assert_true(sees_point(&view, along(&view, x, y, 7), 0));
        for (float y = 0.5f; y < HEIGHT; y++) {
            assert_false(sees_point(&view, along(&view, -1, y, 7), 0));
            assert_false(sees_point(&view, along(&view, WIDTH + 1, y, 7), 0));
        }
        for (float x = 0.5f; x < WIDTH; x++) {
            assert_false(sees_point(&view, along(&view, x, -1, 7), 0));
            assert_false(sees_point(&view, along(&view, x, HEIGHT + 1, 7), 0));
        }
        assert_false(sees_point(&view, wd_v3_scale(view.forward, -3), 2.9f));
        assert_true(sees_point(&view, wd_v3_scale(view.forward, -3), 3.1f));
    }
}

/* Things beside the picture reach into it by their radius, ways by what lies between their ends. */
static void radii_and_ways_reach_into_it(void **state)
{
    (void)state;
    const struct wd_trace_view view = view_of(0.4, 0.2, 60);
    const struct wd_vec3 edge = along(&view, WIDTH, 16, 5), right = wd_v3_unit(view.right);
    assert_false(sees_point(&view, wd_v3_mad(edge, right, 2), 1));
    assert_true(sees_point(&view, wd_v3_mad(edge, right, 2), 2));
    const struct wd_vec3 middle = wd_v3_scale(view.forward, 5);
    const struct wd_vec3 east = wd_v3_mad(middle, right, 40), west = wd_v3_mad(middle, right, -40);
    assert_true(wd_trace_view_sees(&view, east, west, 0));
    assert_false(wd_trace_view_sees(&view, east, wd_v3_mad(middle, right, 10), 0));
}

/* Rays leave all of a lens and part again beyond what is in focus. */
static void lenses_see_more(void **state)
{
    (void)state;
    struct wd_trace_view view = view_of(0, 0, 40);
    const struct wd_vec3 right = wd_v3_unit(view.right);
    const struct wd_vec3 close = wd_v3_mad(along(&view, WIDTH, 16, 0.5f), right, 0.04f);
    const struct wd_vec3 far = wd_v3_mad(along(&view, WIDTH, 16, 8), right, 0.3f);
    assert_false(sees_point(&view, close, 0));
    assert_false(sees_point(&view, far, 0));
    view.lens_m = 0.05f;
    view.focus_m = 1;
    assert_true(sees_point(&view, close, 0));
    assert_true(sees_point(&view, far, 0));
    assert_false(sees_point(&view, wd_v3_mad(close, right, 0.2f), 0));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_rays_pass_is_seen_and_nothing_beside),
        cmocka_unit_test(radii_and_ways_reach_into_it),
        cmocka_unit_test(lenses_see_more),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
