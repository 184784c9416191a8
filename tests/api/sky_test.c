/* Environment maps from files: what is drawn under them, and what is said of bad ones. */
#include "suite.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "output/exr.h"

enum { WIDTH = 64, HEIGHT = 32 };

static struct suite suite;

/* A map of one radiance above the horizon and black below, but for one value of the last texel. */
static const char *write_map_with_sun(const char *name, const char *const channels[3],
                                      uint32_t width, float odd, float sun)
{
    static float rgb[3][WIDTH * HEIGHT];
    const char *path = suite_path(&suite, name);
    for (uint32_t at = 0; at < width * HEIGHT; at++)
        for (int k = 0; k < 3; k++)
            rgb[k][at] = at < width * HEIGHT / 2 ? 0.5f + 0.25f * (float)k : 0;
    rgb[1][width * HEIGHT - 1] = odd;
    for (int k = 0; k < 3; k++)
        rgb[k][width * HEIGHT / 4] += sun;
    const struct wd_exr_channel planes[3] = {{channels[0], WD_EXR_FLOAT, rgb[0], 1},
                                             {channels[1], WD_EXR_FLOAT, rgb[1], 1},
                                             {channels[2], WD_EXR_FLOAT, rgb[2], 1}};
    const struct wd_exr_params params = {width, HEIGHT, planes, 3, NULL, 0};
    assert_true(wd_exr_write(path, &params, &suite.log));
    return path;
}

static const char *write_map(const char *name, const char *const channels[3], uint32_t width,
                             float odd)
{
    return write_map_with_sun(name, channels, width, odd, 0);
}

static const char *const RGB[3] = {"R", "G", "B"};

static enum wd_result open_forest(struct wd_forest **forest, const char *map, const char *setting)
{
    char file[256];
    snprintf(file, sizeof file, "sky.file=%s", map);
    const char *const settings[] = {file, setting, NULL};
    const struct wd_forest_params params = {
        .scene_path = suite.small_path, .settings = settings, .log = suite.log};
    return wd_forest_create(forest, &params);
}

/* Mean of the sky's pixels in the picture's upper half, where the map is of one radiance, and of the
 * rest. Between trees sky shows below the horizon, too. */
struct means {
    double sky[3], rest[3], skies, rests;
};

static struct means means_of(const struct wd_picture *picture)
{
    struct means means = {0};
    for (size_t at = 0; at < (size_t)picture->width * picture->height; at++) {
        bool sky = isinf(picture->depth_m[at]);
        if (sky && at >= (size_t)picture->width * picture->height / 2)
            continue;
        for (size_t k = 0; k < 3; k++)
            (sky ? means.sky : means.rest)[k] += (double)picture->color[3 * at + k];
        *(sky ? &means.skies : &means.rests) += 1;
    }
    for (int k = 0; k < 3; k++) {
        means.sky[k] /= fmax(means.skies, 1);
        means.rest[k] /= fmax(means.rests, 1);
    }
    return means;
}

static struct means drawn(const char *map, const char *camera, const char *setting)
{
    struct wd_forest *forest = NULL;
    struct wd_picture picture = {0};
    assert_int_equal(open_forest(&forest, map, setting), WD_OK);
    assert_int_equal(wd_renderer_set_forest(suite.renderer, forest), WD_OK);
    struct wd_render_params render = suite_params(forest, camera);
    render.layers = WD_LAYER_COLOR | WD_LAYER_DEPTH;
    assert_int_equal(wd_renderer_render(suite.renderer, &render, &picture), WD_OK);
    struct means means = means_of(&picture);
    assert_int_equal(wd_renderer_set_forest(suite.renderer, suite.forest), WD_OK);
    wd_forest_destroy(&forest);
    wd_picture_finish(&picture);
    return means;
}

static struct means traced(const char *map, const char *setting)
{
    struct wd_forest *forest = NULL;
    struct wd_picture picture = {0};
    assert_int_equal(open_forest(&forest, map, setting), WD_OK);
    struct wd_render_params render = suite_params(forest, "over");
    render.layers = WD_LAYER_COLOR | WD_LAYER_DEPTH;
    suite_trace(&suite, forest, &render, 8, &picture);
    struct means means = means_of(&picture);
    wd_forest_destroy(&forest);
    wd_picture_finish(&picture);
    return means;
}

/* The sky is the map's, and twice the light is twice as bright. */
static void the_map_is_the_sky(void **state)
{
    (void)state;
    const char *map = write_map("even.exr", RGB, WIDTH, 0);
    struct means once = drawn(map, "walk", "sky.sun=file"),
                 twice = drawn(map, "walk", "sky.strength=2");
    assert_true(once.skies > 100 && once.rests > 100);
    for (int k = 0; k < 3; k++) {
        assert_float_equal(once.sky[k], 0.5 + 0.25 * k, 0.01);
        assert_true(once.rest[k] > 0.001);
        assert_float_equal(twice.rest[k], 2 * once.rest[k], 0.01 * once.rest[k]);
    }
}

static void drawn_as_traced(void **state)
{
    (void)state;
    const char *map = write_map("even.exr", RGB, WIDTH, 0);
    struct means drawn_means = drawn(map, "over", "fog.visibility_m=1e7");
    struct means traced_means = traced(map, "fog.visibility_m=1e7");
    for (int k = 0; k < 3; k++) {
        assert_float_equal(drawn_means.rest[k], traced_means.rest[k], 0.25 * traced_means.rest[k]);
    }
}

static void expect_refused(const char *map, const char *setting, const char *said)
{
    struct wd_forest *forest = NULL;
    suite_clear(&suite);
    assert_int_equal(open_forest(&forest, map, setting), WD_ERROR_INPUT);
    assert_null(forest);
    if (!suite_logged(&suite, said) || !suite_logged(&suite, "sky"))
        fail_msg("not said: \"%s\" in: %s", said, suite.messages);
    suite_clear(&suite);
}

static void bad_maps_are_refused(void **state)
{
    (void)state;
    static const char *const gray[3] = {"Y", "G", "B"};
    const char *good = write_map("even.exr", RGB, WIDTH, 0);
    expect_refused("/nowhere/map.exr", "sky.turn_deg=0", "sky.file: /nowhere/map.exr");
    expect_refused(suite.small_path, "sky.turn_deg=0", "is not an EXR");
    expect_refused(write_map("tall.exr", RGB, HEIGHT, 0), "sky.turn_deg=0", "found 32 x 32 pixels");
    expect_refused(write_map("gray.exr", gray, WIDTH, 0), "sky.turn_deg=0", "no R of half or float");
    expect_refused(write_map("nan.exr", RGB, WIDTH, NAN), "sky.turn_deg=0",
                   "found nan in channel G at column 63, row 31");
    expect_refused(write_map("inf.exr", RGB, WIDTH, INFINITY), "sky.turn_deg=0", "found inf");
    expect_refused(write_map("less.exr", RGB, WIDTH, -1), "sky.turn_deg=0", "found -1");
    expect_refused(good, "sky.cover=0.5", "beside a \"file\"");
    expect_refused(good, "sky.sun=moon", "sun");
}

/* The sky without the sun is the same, the file is of the same name. */
static void another_sun_is_another_forest(void **state)
{
    (void)state;
    uint64_t keys[2];
    for (int i = 0; i < 2; i++) {
        struct wd_forest *forest = NULL;
        const char *map = write_map_with_sun("sun.exr", RGB, WIDTH, 0, i ? 2000 : 1000);
        assert_int_equal(open_forest(&forest, map, "sky.sun=file"), WD_OK);
        keys[i] = wd_forest_key(forest);
        wd_forest_destroy(&forest);
    }
    assert_true(keys[0] != keys[1]);
}

/* --- a sun that stands elsewhere ------------------------------------------------------------ */

static const struct wd_sun EVENING = {250, 8};

static void expect_alike(const struct wd_picture *a, const struct wd_picture *b)
{
    assert_memory_equal(a->color, b->color, (size_t)a->width * a->height * 3 * sizeof *a->color);
}

/* What is drawn and traced under a sun in place of the scene's is what a scene that has it there shows. */
static void a_sun_of_a_picture_is_that_of_a_scene(void **state)
{
    (void)state;
    static const char *const settings[] = {"sun.azimuth_deg=250", "sun.elevation_deg=8", NULL};
    const struct wd_forest_params evening = {.scene_path = suite.small_path, .settings = settings, .log = suite.log};
    struct wd_forest *there = NULL;
    assert_int_equal(wd_forest_create(&there, &evening), WD_OK);
    struct wd_render_params params = suite_params(suite.forest, "walk");
    params.layers = WD_LAYER_COLOR;
    assert_int_equal(wd_renderer_set_forest(suite.renderer, there), WD_OK);
    struct wd_picture wanted = suite_render(&suite, &params), traced = {0};
    suite_trace(&suite, there, &params, 1, &traced);
    assert_int_equal(wd_renderer_set_forest(suite.renderer, suite.forest), WD_OK);
    struct wd_picture noon = suite_render(&suite, &params);
    params.sun = &EVENING;
    struct wd_picture found = suite_render(&suite, &params), found_traced = {0};
    suite_trace(&suite, suite.forest, &params, 1, &found_traced);
    assert_memory_not_equal(noon.color, wanted.color, (size_t)noon.width * noon.height * 3 * sizeof *noon.color);
    expect_alike(&found, &wanted);
    expect_alike(&found_traced, &traced);
    assert_non_null(strstr(found.about, "\"azimuth_deg\":250.0,\"elevation_deg\":8.0"));
    wd_picture_finish(&wanted);
    wd_picture_finish(&traced);
    wd_picture_finish(&noon);
    wd_picture_finish(&found);
    wd_picture_finish(&found_traced);
    wd_forest_destroy(&there);
}

/* Frames that are gathered in a live view have one sun. */
static void a_sun_that_moves_begins_anew(void **state)
{
    (void)state;
    struct wd_render_params params = suite_params(suite.forest, "walk");
    struct wd_picture pictures[2];
    params.layers = WD_LAYER_COLOR;
    params.accumulation = WD_ACCUMULATE;
    for (int many = 0; many < 2; many++) {
        params.view = WD_VIEW_ALBEDO; /* forgets what was gathered */
        for (int i = 0; i < (many ? 5 : 1); i++) {
            struct wd_picture before = suite_render(&suite, &params);
            params.view = WD_VIEW_LIT;
            wd_picture_finish(&before);
        }
        params.view = WD_VIEW_LIT;
        params.sun = &EVENING;
        pictures[many] = suite_render(&suite, &params);
        params.sun = NULL;
    }
    expect_alike(&pictures[0], &pictures[1]);
    wd_picture_finish(&pictures[0]);
    wd_picture_finish(&pictures[1]);
}

static void impossible_suns_are_refused(void **state)
{
    (void)state;
    static const struct {
        struct wd_sun sun;
        const char *said;
    } cases[] = {{{0, 91}, "sun.elevation_deg is 91"}, {{0, NAN}, "sun.elevation_deg"}, {{INFINITY, 0}, "sun.azimuth_deg"}};
    struct wd_render_params params = suite_params(suite.forest, "walk");
    struct wd_picture picture;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        params.sun = &cases[i].sun;
        suite_clear(&suite);
        assert_int_equal(wd_renderer_render(suite.renderer, &params, &picture), WD_ERROR_INPUT);
        assert_true(suite_logged(&suite, cases[i].said));
    }
    struct wd_forest *mapped = NULL;
    assert_int_equal(open_forest(&mapped, write_map("good.exr", RGB, WIDTH, 0), "sky.turn_deg=0"), WD_OK);
    assert_int_equal(wd_renderer_set_forest(suite.renderer, mapped), WD_OK);
    params.sun = &EVENING;
    suite_clear(&suite);
    assert_false(wd_forest_sun_moves(mapped));
    assert_int_equal(wd_renderer_render(suite.renderer, &params, &picture), WD_ERROR_INPUT);
    assert_true(suite_logged(&suite, "under a sky map"));
    assert_int_equal(wd_renderer_set_forest(suite.renderer, suite.forest), WD_OK);
    wd_forest_destroy(&mapped);
}

/* By the clock where date and place are known; on its circle of the day anywhere. */
static void the_sun_goes_with_the_hours(void **state)
{
    (void)state;
    static const char *const settings[] = {"time.date=2026-06-21", "time.latitude_deg=48", "time.longitude_deg=11", NULL};
    const struct wd_forest_params params = {.scene_path = suite.small_path, .settings = settings, .log = suite.log};
    struct wd_forest *placed = NULL;
    struct wd_sun morning, later, midnight;
    suite_clear(&suite);
    assert_int_equal(wd_forest_sun_at(suite.forest, 9, &morning), WD_ERROR_INPUT);
    assert_true(suite_logged(&suite, "latitude_deg"));
    assert_int_equal(wd_forest_create(&placed, &params), WD_OK);
    assert_int_equal(wd_forest_sun_at(placed, 49, &morning), WD_ERROR_INPUT);
    assert_int_equal(wd_forest_sun_at(placed, 24, &midnight), WD_OK);
    assert_true(midnight.elevation_deg < -15);
    assert_int_equal(wd_forest_sun_at(placed, 9, &morning), WD_OK);
    for (double hours = -2; hours <= 6; hours += 2) {
        struct wd_sun circling = wd_forest_sun_later(placed, &morning, hours);
        assert_int_equal(wd_forest_sun_at(placed, 9 + hours, &later), WD_OK);
        assert_true(fabs(circling.elevation_deg - later.elevation_deg) < 0.1);
        assert_true(fabs(circling.azimuth_deg - later.azimuth_deg) < 0.1);
    }
    struct wd_sun own = wd_forest_sun(suite.forest), day_later = wd_forest_sun_later(suite.forest, &own, 24);
    assert_true(fabs(own.azimuth_deg - day_later.azimuth_deg) < 1e-6 && own.elevation_deg == 40);
    wd_forest_destroy(&placed);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_map_is_the_sky),
        cmocka_unit_test(drawn_as_traced),
        cmocka_unit_test(bad_maps_are_refused),
        cmocka_unit_test(another_sun_is_another_forest),
        cmocka_unit_test(a_sun_of_a_picture_is_that_of_a_scene),
        cmocka_unit_test(a_sun_that_moves_begins_anew),
        cmocka_unit_test(impossible_suns_are_refused),
        cmocka_unit_test(the_sun_goes_with_the_hours),
    };
    if (argc < 2 || !suite_init(&suite, argv[1]))
        return 1;
    int failed = cmocka_run_group_tests_name("sky", tests, NULL, NULL);
    suite_finish(&suite);
    return failed;
}
