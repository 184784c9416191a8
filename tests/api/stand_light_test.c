/* Light on the floor of a dark stand, under a sun between its leaves. */
#include <math.h>
#include <stdio.h>

#include "suite.h"
#include "weald/reference.h"

enum { PLACES = 8 };

static struct suite suite;

static struct wd_render_params looking_down(const struct wd_forest *forest, int place)
{
    double x = 300 + 400 * fmod(0.5 + 0.7548776662 * place, 1); /* spread evenly (Roberts 2018) */
    double y = 300 + 400 * fmod(0.5 + 0.5698402910 * place, 1);
    return (struct wd_render_params){
        .camera = {.position_m = {x, y, wd_forest_ground_m(forest, x, y) + 1.7},
                   .pitch_rad = -1.309, .fov_rad = 1.222},
        .width = 48, .height = 36, .samples = 4, .method = "continuum", .layers = WD_LAYER_COLOR};
}

static void add(double sums[3], const struct wd_picture *picture)
{
    for (size_t i = 0; i < (size_t)3 * picture->width * picture->height; i++)
        sums[i % 3] += (double)picture->color[i];
}

/* 1.00 to 1.02 of the traced; 1.31 in red if leaves scatter the sun down as an even layer does and the sky about the
 * sun comes by as short a way as in lighter stands. */
static void a_dark_floor_is_as_bright_as_traced(void **state)
{
    (void)state;
    char scene[1280];
    snprintf(scene, sizeof scene, "%s/scenes/bench75k.json", suite.root);
    struct wd_forest *forest = suite_forest(&suite, scene);
    const struct wd_reference_params params = {.log = suite.log};
    struct wd_reference *reference = NULL;
    double drawn[3] = {0}, traced[3] = {0};
    assert_non_null(forest);
    assert_int_equal(wd_renderer_set_forest(suite.renderer, forest), WD_OK);
    assert_int_equal(wd_reference_create(&reference, forest, &params), WD_OK);
    for (int i = 0; i < PLACES; i++) {
        const struct wd_render_params render = looking_down(forest, i);
        struct wd_picture picture = {0}, truth = {0};
        assert_int_equal(wd_renderer_render(suite.renderer, &render, &picture), WD_OK);
        const struct wd_reference_picture_params trace = {.camera = render.camera, .width = render.width,
                                                          .height = render.height, .samples = 32,
                                                          .layers = render.layers};
        assert_int_equal(wd_reference_render(reference, &trace, &truth), WD_OK);
        add(drawn, &picture);
        add(traced, &truth);
        wd_picture_finish(&picture);
        wd_picture_finish(&truth);
    }
    for (int k = 0; k < 3; k++) {
        print_message("floor of a dark stand, %s: %.2f of the traced\n",
                      k == 0 ? "red" : k == 1 ? "green" : "blue", drawn[k] / traced[k]);
        assert_true(drawn[k] > 0.85 * traced[k] && drawn[k] < 1.15 * traced[k]);
    }
    wd_reference_destroy(&reference);
    assert_int_equal(wd_renderer_set_forest(suite.renderer, suite.forest), WD_OK);
    wd_forest_destroy(&forest);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_dark_floor_is_as_bright_as_traced),
    };
    if (argc < 2 || !suite_init(&suite, argv[1]))
        return 1;
    int failed = cmocka_run_group_tests_name("stand_light", tests, NULL, NULL);
    suite_finish(&suite);
    return failed;
}
