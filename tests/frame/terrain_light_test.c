/* A bare landscape through terrain, light and post on the software device, with validation. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "picture.h"

enum { WIDTH = 320, HEIGHT = 240, CELLS = 512 };

static int setup(void **state)
{
    struct picture_test *test = wd_alloc(sizeof *test);
    *state = test;
    return picture_init(test, WIDTH, HEIGHT, CELLS, 8, 700) ? 0 : 1;
}

static int teardown(void **state)
{
    struct picture_test *test = *state;
    picture_finish(test);
    free(test);
    return 0;
}

static double extent(const struct picture_test *test)
{
    return wd_terrain_extent_x_m(&test->world.terrain);
}

/* Pixels of sky with ground above them: with a level camera a column is a vertical plane, and over
 * ground that is a function of place no ray above one that misses it can meet it. */
static unsigned cracks(const float *depth)
{
    unsigned count = 0;
    for (unsigned x = 0; x < WIDTH; x++) {
        for (unsigned y = 0, ground = 0; y < HEIGHT; y++) {
            ground |= depth[y * WIDTH + x] > 0;
            count += ground && depth[y * WIDTH + x] <= 0;
        }
    }
    return count;
}

static void test_no_cracks(void **state)
{
    struct picture_test *test = *state;
    for (int i = 0; i < 16; i++) {
        double share = 0.1 + 0.8 * fmod(i * 0.618, 1), across = 0.1 + 0.8 * fmod(i * 0.382, 1);
        double above_m = i % 4 == 0 ? 1.7 : 40.0 * (i % 4);
        struct wd_camera camera = picture_camera(test, share * extent(test), across * extent(test),
                                                 above_m, i * 67.0, 0);
        assert_true(picture_draw(test, &camera));
        assert_true(test->terrain.triangles <= 60000);
        float *depth = picture_depth(test);
        assert_int_equal(cracks(depth), 0);
        free(depth);
    }
}

static void test_ground_fills_the_view_down(void **state)
{
    struct picture_test *test = *state;
    for (int i = 0; i < 6; i++) {
        struct wd_camera camera = picture_camera(test, 0.5 * extent(test), 0.5 * extent(test),
                                                 150.0 * (i + 1), i * 50.0, -75);
        assert_true(picture_draw(test, &camera));
        float *depth = picture_depth(test);
        for (unsigned k = 0; k < WIDTH * HEIGHT; k++)
            assert_true(depth[k] > 0);
        free(depth);
    }
}

/* Near the camera the mesh is the terrain itself, to the millimetre. */
static void test_near_ground_is_exact(void **state)
{
    struct picture_test *test = *state;
    struct wd_camera camera =
        picture_camera(test, 0.37 * extent(test), 0.61 * extent(test), 6, 30, -40);
    assert_true(picture_draw(test, &camera));
    float *depth = picture_depth(test);
    unsigned checked = 0;
    for (unsigned y = HEIGHT / 2; y < HEIGHT; y += 7) {
        for (unsigned x = 3; x < WIDTH; x += 11) {
            double axis_m = test->uniforms.near_m / depth[y * WIDTH + x], rel[3];
            float clip[2] = {(x + 0.5f) / WIDTH * 2 - 1, (y + 0.5f) / HEIGHT * 2 - 1};
            for (int k = 0; k < 3; k++)
                rel[k] = axis_m * (test->uniforms.rel_from_clip[0][k] * clip[0] +
                                   test->uniforms.rel_from_clip[1][k] * clip[1] +
                                   test->uniforms.rel_from_clip[3][k]);
            double ground_m = wd_terrain_height(&test->world.terrain,
                                                camera.position_m[0] + rel[0],
                                                camera.position_m[1] + rel[1]);
            assert_float_equal(camera.position_m[2] + rel[2], ground_m, 0.003);
            checked++;
        }
    }
    assert_true(checked > 400);
    free(depth);
}

static void test_same_twice(void **state)
{
    struct picture_test *test = *state;
    struct wd_camera camera =
        picture_camera(test, 0.5 * extent(test), 0.4 * extent(test), 30, 0, -8);
    assert_true(picture_draw(test, &camera));
    uint8_t *first = picture_display(test);
    assert_true(picture_draw(test, &camera));
    uint8_t *second = picture_display(test);
    assert_memory_equal(first, second, (size_t)4 * WIDTH * HEIGHT);
    free(first);
    free(second);
}

struct mean {
    double red, green, blue;
};

static struct mean mean_of(const uint8_t *rgba, unsigned from_row, unsigned to_row)
{
    struct mean mean = {0};
    for (unsigned i = from_row * WIDTH; i < to_row * WIDTH; i++) {
        mean.red += rgba[4 * i];
        mean.green += rgba[4 * i + 1];
        mean.blue += rgba[4 * i + 2];
    }
    double count = (double)(to_row - from_row) * WIDTH;
    return (struct mean){mean.red / count, mean.green / count, mean.blue / count};
}

/* Exposure finds its way from noon to moonlight: the sky stays blue, meadows green, nothing is
 * black or burnt by day, and night is darker than day. */
static void test_exposure_over_the_day(void **state)
{
    struct picture_test *test = *state;
    const double elevations[] = {65, 20, 3, -5, -35};
    double noon = 0;
    for (int i = 0; i < 5; i++) {
        test->scene.sun.elevation_deg = elevations[i];
        test->scene.sun.azimuth_deg = 180;
        struct wd_camera camera =
            picture_camera(test, 0.5 * extent(test), 0.3 * extent(test), 30, 0, 0);
        assert_true(picture_draw(test, &camera));
        uint8_t *rgba = picture_display(test);
        struct mean all = mean_of(rgba, 0, HEIGHT), sky = mean_of(rgba, 0, HEIGHT / 4);
        struct mean ground = mean_of(rgba, 3 * HEIGHT / 4, HEIGHT);
        if (elevations[i] > 15) {
            assert_true(all.green > 70 && all.green < 190);
            assert_true(sky.blue > sky.red + 15);
            assert_true(ground.green > ground.blue + 15);
        }
        if (elevations[i] < -20) {
            assert_true(all.green > 4 && all.green < 0.5 * noon);
            assert_true(sky.blue > sky.red);
        }
        noon = i == 0 ? all.green : noon;
        free(rgba);
    }
    test->scene.sun.elevation_deg = 45;
}

static void test_low_sun_leaves_slopes_in_shadow(void **state)
{
    struct picture_test *test = *state;
    double lit[2];
    test->view_mode = WD_MODE_SHADOW;
    for (int i = 0; i < 2; i++) {
        test->scene.sun.elevation_deg = i ? 60 : 3;
        struct wd_camera camera =
            picture_camera(test, 0.5 * extent(test), 0.5 * extent(test), 700, 0, -80);
        assert_true(picture_draw(test, &camera));
        uint8_t *rgba = picture_display(test);
        lit[i] = mean_of(rgba, 0, HEIGHT).green;
        free(rgba);
    }
    test->view_mode = WD_MODE_LIT;
    test->scene.sun.elevation_deg = 45;
    assert_true(lit[1] > 160); /* groves stand for their shadows */
    assert_true(lit[0] < 0.8 * lit[1]);
}

static void test_water_lies_level(void **state)
{
    struct picture_test *test = *state;
    struct wd_camera camera =
        picture_camera(test, 0.5 * extent(test), 0.5 * extent(test), 900, 0, -89);
    assert_true(picture_draw(test, &camera));
    uint8_t *dry = picture_display(test);
    test->scene.water.enabled = true;
    test->scene.water.level_m = test->world.terrain.max_m + 1;
    assert_true(picture_draw(test, &camera));
    uint8_t *wet = picture_display(test);
    test->scene.water.enabled = false;
    struct mean ground = mean_of(dry, 0, HEIGHT), water = mean_of(wet, 0, HEIGHT);
    assert_true(ground.green > ground.blue + 10);
    assert_true(water.blue > water.red + 10);
    free(dry);
    free(wet);
}

/* Cut-out ground lets the sky through, and only there. */
static void test_holes(void **state)
{
    struct picture_test *test = *state;
    struct wd_terrain *terrain = &test->world.terrain;
    struct wd_camera camera =
        picture_camera(test, 0.5 * extent(test), 0.5 * extent(test), 300, 0, -89.99);
    terrain->hole = wd_alloc_array((size_t)terrain->width * terrain->height, 1);
    for (uint32_t j = CELLS / 2 - 4; j <= CELLS / 2 + 4; j++)
        memset(terrain->hole + (size_t)j * terrain->width + CELLS / 2 - 4, 1, 9);
    wd_ground_finish(&test->forest.ground, &test->gpu);
    assert_true(wd_ground_init(&test->forest.ground, &test->gpu, &test->world, &test->log));
    assert_true(picture_draw(test, &camera));
    float *depth = picture_depth(test);
    unsigned sky = 0;
    for (unsigned i = 0; i < WIDTH * HEIGHT; i++)
        sky += depth[i] <= 0;
    /* 9 x 9 samples leave a hole of 10 x 10 cells, less what of its corner triangles is whole */
    double pixel_m = 300 / test->view.pixels_per_radian, hole_m2 = 99 * 8.0 * 8.0;
    assert_true(depth[HEIGHT / 2 * WIDTH + WIDTH / 2] <= 0);
    assert_float_equal(sky * pixel_m * pixel_m / hole_m2, 1, 0.15);
    free(depth);
    free(terrain->hole);
    terrain->hole = NULL;
    wd_ground_finish(&test->forest.ground, &test->gpu);
    assert_true(wd_ground_init(&test->forest.ground, &test->gpu, &test->world, &test->log));
}

/* What the eye turned by, in pixels. */
static void test_velocity(void **state)
{
    struct picture_test *test = *state;
    struct wd_camera camera =
        picture_camera(test, 0.5 * extent(test), 0.5 * extent(test), 20, 0, -3);
    struct wd_camera turned = camera, still = camera;
    turned.yaw_rad -= 0.02;
    float *at_rest = picture_velocity(test, &camera, &still);
    float *turning = picture_velocity(test, &camera, &turned);
    for (unsigned i = 0; i < 2 * WIDTH * HEIGHT; i++)
        assert_float_equal(at_rest[i], 0, 1e-3);
    /* the camera has turned right: things move left by f tan(angle) in the middle */
    const float *middle = turning + 2 * (HEIGHT / 2 * WIDTH + WIDTH / 2);
    assert_float_equal(middle[0], -0.02 * test->view.pixels_per_radian, 0.1);
    assert_float_equal(middle[1], 0, 0.1);
    free(at_rest);
    free(turning);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_no_cracks),
        cmocka_unit_test(test_ground_fills_the_view_down),
        cmocka_unit_test(test_near_ground_is_exact),
        cmocka_unit_test(test_same_twice),
        cmocka_unit_test(test_exposure_over_the_day),
        cmocka_unit_test(test_low_sun_leaves_slopes_in_shadow),
        cmocka_unit_test(test_water_lies_level),
        cmocka_unit_test(test_holes),
        cmocka_unit_test(test_velocity),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
