/* Flying and walking over grounds that a formula gives. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "viewer/motion.h"

static double flat(const void *user, double x_m, double y_m)
{
    (void)user, (void)x_m, (void)y_m;
    return 100;
}

static double slope(const void *user, double x_m, double y_m)
{
    (void)user, (void)x_m;
    return 0.3 * y_m;
}

static double cliff(const void *user, double x_m, double y_m)
{
    (void)user, (void)x_m;
    return y_m < 10 ? 50 : 0;
}

static const struct viewer_ground on_flat = {flat, NULL}, on_slope = {slope, NULL},
                                  on_cliff = {cliff, NULL};

static struct viewer_motion at(double x_m, double y_m, double z_m, enum viewer_gait gait)
{
    return (struct viewer_motion){
        .camera = {.position_m = {x_m, y_m, z_m}, .fov_rad = 1}, .gait = gait, .speed_factor = 1};
}

static void flies_where_it_looks(void **state)
{
    (void)state;
    struct viewer_motion motion = at(0, 0, 200, VIEWER_FLY);
    motion.camera.yaw_rad = M_PI / 2; /* east */
    viewer_motion_step(&motion, &(struct viewer_push){.forward_s = 2}, 2, &on_flat);
    assert_float_equal(motion.camera.position_m[0], 40, 1e-9);
    assert_float_equal(motion.camera.position_m[1], 0, 1e-9);
    assert_float_equal(motion.camera.position_m[2], 200, 1e-9);
    viewer_motion_step(&motion, &(struct viewer_push){.right_s = 1}, 1, &on_flat);
    assert_float_equal(motion.camera.position_m[1], -20, 1e-9); /* right of east is south */
    motion.camera.pitch_rad = M_PI / 6;
    viewer_motion_step(&motion, &(struct viewer_push){.forward_s = 1, .fast = true}, 1, &on_flat);
    assert_float_equal(motion.camera.position_m[2], 250, 1e-9);
    viewer_motion_step(&motion, &(struct viewer_push){.up_s = -1}, 1, &on_flat);
    assert_float_equal(motion.camera.position_m[2], 230, 1e-9);
}

static void two_keys_are_no_faster_than_one(void **state)
{
    (void)state;
    struct viewer_motion motion = at(0, 0, 200, VIEWER_FLY);
    viewer_motion_step(&motion, &(struct viewer_push){.forward_s = 1, .right_s = 1, .up_s = 1}, 1, &on_flat);
    const double *p = motion.camera.position_m;
    assert_float_equal(p[0], 20 / sqrt(3), 1e-9);
    assert_float_equal(p[1], 20 / sqrt(3), 1e-9);
    assert_float_equal(p[2], 200 + 20 / sqrt(3), 1e-9);
    motion = at(0, 0, 100 + VIEWER_EYE_M, VIEWER_WALK);
    viewer_motion_step(&motion, &(struct viewer_push){.forward_s = 1, .right_s = -1, .up_s = 1}, 1, &on_flat);
    assert_float_equal(hypot(p[0], p[1]), viewer_motion_speed_mps(&motion), 1e-9);
}

static void flying_stays_above_the_ground(void **state)
{
    (void)state;
    struct viewer_motion motion = at(0, 0, 105, VIEWER_FLY);
    viewer_motion_step(&motion, &(struct viewer_push){.up_s = -10}, 10, &on_flat);
    assert_float_equal(motion.camera.position_m[2], 100 + VIEWER_FLY_CLEARANCE_M, 1e-9);
}

static void walking_follows_the_ground(void **state)
{
    (void)state;
    struct viewer_motion motion = at(0, 0, VIEWER_EYE_M, VIEWER_WALK);
    viewer_motion_step(&motion, &(struct viewer_push){0}, 0.02, &on_slope);
    for (int i = 0; i < 200; i++) { /* up, then down again */
        double way_s = i < 100 ? 0.1 : -0.1;
        viewer_motion_step(&motion, &(struct viewer_push){.forward_s = way_s}, 0.1, &on_slope);
        const double *p = motion.camera.position_m;
        assert_float_equal(p[2], slope(NULL, p[0], p[1]) + VIEWER_EYE_M, 1e-9);
        assert_true(motion.grounded);
    }
    assert_float_equal(motion.camera.position_m[1], 0, 1e-9);
}

static void walking_looks_up_without_rising(void **state)
{
    (void)state;
    struct viewer_motion motion = at(0, 0, 100 + VIEWER_EYE_M, VIEWER_WALK);
    motion.camera.pitch_rad = 1.4;
    viewer_motion_step(&motion, &(struct viewer_push){.forward_s = 1, .up_s = 1}, 1, &on_flat);
    assert_float_equal(motion.camera.position_m[1], 2, 1e-9);
    assert_float_equal(motion.camera.position_m[2], 100 + VIEWER_EYE_M, 1e-9);
}

static void falls_from_a_cliff(void **state)
{
    (void)state;
    struct viewer_motion motion = at(0, 9.9, 50 + VIEWER_EYE_M, VIEWER_WALK);
    viewer_motion_step(&motion, &(struct viewer_push){0}, 0.01, &on_cliff);
    viewer_motion_step(&motion, &(struct viewer_push){.forward_s = 0.1}, 0.01, &on_cliff);
    double time_s = 0.01, last_m = 50 + VIEWER_EYE_M;
    while (!motion.grounded && time_s < 10) {
        viewer_motion_step(&motion, &(struct viewer_push){0}, 0.01, &on_cliff);
        assert_true(motion.camera.position_m[2] < last_m);
        last_m = motion.camera.position_m[2];
        time_s += 0.01;
    }
    assert_float_equal(time_s, sqrt(2 * 50 / 9.81), 0.05);
    assert_float_equal(last_m, VIEWER_EYE_M, 1e-9);
    assert_float_equal(motion.fall_mps, 0, 0);
}

static void landing_does_not_fall(void **state)
{
    (void)state;
    struct viewer_motion motion = at(0, 50, 80, VIEWER_WALK);
    viewer_motion_land(&motion, &on_slope);
    assert_true(motion.grounded);
    assert_float_equal(motion.camera.position_m[2], 15 + VIEWER_EYE_M, 1e-9);
}

static void flying_ends_where_nothing_is_drawn(void **state)
{
    (void)state;
    struct viewer_motion motion = at(0, 0, 200, VIEWER_FLY);
    motion.camera.yaw_rad = -M_PI / 4;
    viewer_motion_step(&motion, &(struct viewer_push){.forward_s = 1e6, .up_s = 1e6}, 1, &on_flat);
    for (int i = 0; i < 3; i++)
        assert_true(fabs(motion.camera.position_m[i]) < WD_MOST_PLACE_M);
}

static void one_long_step_lands(void **state)
{
    (void)state;
    struct viewer_motion motion = at(0, 20, 80, VIEWER_WALK);
    for (int i = 0; i < 10; i++)
        viewer_motion_step(&motion, &(struct viewer_push){0}, 5, &on_cliff);
    assert_float_equal(motion.camera.position_m[2], VIEWER_EYE_M, 1e-9);
}

static void looking_stops_short_of_straight_up(void **state)
{
    (void)state;
    struct viewer_motion motion = at(0, 0, 200, VIEWER_FLY);
    viewer_motion_step(&motion, &(struct viewer_push){.yaw_rad = 7, .pitch_rad = 9}, 0, &on_flat);
    assert_true(motion.camera.pitch_rad < M_PI / 2);
    assert_float_equal(motion.camera.yaw_rad, 7 - 2 * M_PI, 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flies_where_it_looks),
        cmocka_unit_test(two_keys_are_no_faster_than_one),
        cmocka_unit_test(flying_stays_above_the_ground),
        cmocka_unit_test(walking_follows_the_ground),
        cmocka_unit_test(walking_looks_up_without_rising),
        cmocka_unit_test(falls_from_a_cliff),
        cmocka_unit_test(landing_does_not_fall),
        cmocka_unit_test(flying_ends_where_nothing_is_drawn),
        cmocka_unit_test(one_long_step_lands),
        cmocka_unit_test(looking_stops_short_of_straight_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
