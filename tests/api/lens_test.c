/* What lens and shutter do to a picture: they spread light, and lose or add none. */
#include "suite.h"

#include <math.h>
#include <stdlib.h>

enum { SAMPLES = 24 };

static struct suite suite;
static struct wd_picture sharp; /* as small.json says */

/* The picture that small.json gives with one more setting (or NULL). */
static struct wd_picture shot(const char *setting, const char *other,
                              const struct wd_camera *previous)
{
    const char *const settings[] = {setting ? setting : "seed=11", other ? other : "seed=11", NULL};
    const struct wd_forest_params params = {
        .scene_path = suite.small_path, .settings = settings, .log = suite.log};
    struct wd_forest *forest = NULL;
    struct wd_picture picture = {0};
    assert_int_equal(wd_forest_create(&forest, &params), WD_OK);
    assert_int_equal(wd_renderer_set_forest(suite.renderer, forest), WD_OK);
    struct wd_render_params render = suite_params(forest, "walk");
    render.samples = SAMPLES;
    render.method = "continuum";
    render.layers = WD_LAYER_COLOR | WD_LAYER_DISPLAY;
    render.previous_camera = previous;
    assert_int_equal(wd_renderer_render(suite.renderer, &render, &picture), WD_OK);
    assert_int_equal(wd_renderer_set_forest(suite.renderer, suite.forest), WD_OK);
    wd_forest_destroy(&forest);
    return picture;
}

static double green(const struct wd_picture *picture, uint32_t x, uint32_t y)
{
    return (double)picture->color[3 * (y * picture->width + x) + 1];
}

static double mean(const struct wd_picture *picture)
{
    double sum = 0;
    for (uint32_t y = 0; y < picture->height; y++)
        for (uint32_t x = 0; x < picture->width; x++)
            sum += green(picture, x, y);
    return sum / (picture->width * picture->height);
}

/* Mean difference of neighbours: across (1, 0) or down (0, 1). */
static double detail(const struct wd_picture *picture, uint32_t dx, uint32_t dy)
{
    double sum = 0;
    for (uint32_t y = 0; y + dy < picture->height; y++)
        for (uint32_t x = 0; x + dx < picture->width; x++)
            sum += fabs(green(picture, x + dx, y + dy) - green(picture, x, y));
    return sum / (picture->width * picture->height);
}

static double display_detail(const struct wd_picture *picture)
{
    double sum = 0;
    for (size_t i = 0; i + 1 < (size_t)picture->width * picture->height; i++)
        sum += abs(picture->display[4 * i + 5] - picture->display[4 * i + 1]);
    return sum;
}

static void wide_apertures_blur(void **state)
{
    (void)state;
    struct wd_picture wide = shot("lens.f_number=0.02", "lens.focus_m=3", NULL);
    assert_true(detail(&wide, 1, 0) < 0.9 * detail(&sharp, 1, 0));
    assert_true(detail(&wide, 0, 1) < 0.9 * detail(&sharp, 0, 1));
    assert_float_equal(mean(&wide), mean(&sharp), 0.1 * mean(&sharp));
    wd_picture_finish(&wide);
}

static void open_shutters_blur_along_the_motion(void **state)
{
    (void)state;
    struct wd_camera previous;
    assert_int_equal(wd_forest_get_camera(suite.forest, "walk", &previous), WD_OK);
    previous.yaw_rad -= 0.15;
    struct wd_picture moving = shot("lens.shutter=1", NULL, &previous);
    double across = detail(&moving, 1, 0) / detail(&sharp, 1, 0);
    double down = detail(&moving, 0, 1) / detail(&sharp, 0, 1);
    assert_true(across < 0.85 && across < down);
    assert_float_equal(mean(&moving), mean(&sharp), 0.1 * mean(&sharp));
    wd_picture_finish(&moving);
}

static void bloom_softens_what_is_shown(void **state)
{
    (void)state;
    struct wd_picture soft = shot("lens.bloom=0.5", NULL, NULL);
    assert_true(display_detail(&soft) < 0.8 * display_detail(&sharp));
    size_t bytes = 3 * sizeof *sharp.color * sharp.width * sharp.height;
    assert_memory_equal(sharp.color, soft.color, bytes); /* radiance is the scene's own */
    wd_picture_finish(&soft);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wide_apertures_blur),
        cmocka_unit_test(open_shutters_blur_along_the_motion),
        cmocka_unit_test(bloom_softens_what_is_shown),
    };
    if (argc < 2 || !suite_init(&suite, argv[1]))
        return 1;
    sharp = shot(NULL, NULL, NULL);
    int failed = cmocka_run_group_tests_name("lens", tests, NULL, NULL);
    wd_picture_finish(&sharp);
    suite_finish(&suite);
    return failed;
}
