/* Leaves close to the eye are drawn as twigs, and shade one another as these do. */
#include <stdio.h>

#include "suite.h"
#include "weald/compare.h"
#include "weald/reference.h"

enum { WIDTH = 64, HEIGHT = 48 };

static struct suite suite;

/* A beech `away_m` off, before the sun, without the sky. */
static const char *write_beech(double away_m)
{
    char text[2048];
    snprintf(text, sizeof text,
             "{\"name\": \"twigs\", \"variants\": 1, \"terrain\": {\"kind\": \"flat\", \"size_m\": [60, 60]},\n"
             " \"species\": {\"beech\": \"%s/species/beech.json\"},\n"
             " \"inventories\": [{\"file\": \"twigs.csv\", \"frame\": \"local\"}],\n"
             " \"sun\": {\"azimuth_deg\": 0, \"elevation_deg\": 50}, \"sky\": {\"strength\": 0.0001},\n"
             " \"wind\": {\"speed_mps\": 0},\n"
             " \"cameras\": [{\"name\": \"at\", \"position_m\": [30, %g, 5.5], \"look_at_m\": [30, 30, 5.5],\n"
             "               \"fov_deg\": 6}]}",
             suite.root, 30 - away_m);
    assert_true(suite_write(&suite, "twigs.csv", "x_m,y_m,species,height_m\n30,30,beech,9\n"));
    assert_true(suite_write(&suite, "twigs.json", text));
    return suite_path(&suite, "twigs.json");
}

static void trace(const struct wd_forest *forest, const struct wd_camera *camera, struct wd_picture *picture)
{
    const struct wd_reference_params params = {.log = suite.log};
    const struct wd_reference_picture_params trace = {.camera = *camera,
                                                      .width = WIDTH,
                                                      .height = HEIGHT,
                                                      .samples = 64,
                                                      .layers = WD_LAYER_COLOR | WD_LAYER_TREE_ID};
    struct wd_reference *reference = NULL;
    assert_int_equal(wd_reference_create(&reference, forest, &params), WD_OK);
    assert_int_equal(wd_reference_render(reference, &trace, picture), WD_OK);
    wd_reference_destroy(&reference);
}

/* Light of the drawn picture over that of the path-traced one, less 1, in percent. */
static void expect_light(double away_m, double most_pct)
{
    struct wd_forest *forest = suite_forest(&suite, write_beech(away_m));
    struct wd_picture drawn = {0}, traced = {0};
    struct wd_comparison found;
    assert_non_null(forest);
    assert_int_equal(wd_renderer_set_forest(suite.renderer, forest), WD_OK);
    struct wd_render_params render = suite_params(forest, "at");
    render.width = WIDTH;
    render.height = HEIGHT;
    render.samples = 8;
    render.method = "continuum";
    render.layers = WD_LAYER_COLOR | WD_LAYER_TREE_ID;
    assert_int_equal(wd_renderer_render(suite.renderer, &render, &drawn), WD_OK);
    trace(forest, &render.camera, &traced);
    assert_int_equal(wd_picture_compare(&found, &traced, &drawn, NULL, &suite.log), WD_OK);
    print_message("a beech %g m off: FLIP %.3f, light %+.1f %%\n", away_m, found.flip, found.tree_bias_pct);
    assert_true(found.tree_bias_pct > -most_pct && found.tree_bias_pct < most_pct);
    wd_picture_finish(&drawn);
    wd_picture_finish(&traced);
    assert_int_equal(wd_renderer_set_forest(suite.renderer, suite.forest), WD_OK);
    wd_forest_destroy(&forest);
}

/* Against the sun: +22 %, and +55 by the shadows of the leaves that stand for the twigs. */
static void twigs_throw_their_own_shadows(void **state)
{
    (void)state;
    expect_light(4, 35);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(twigs_throw_their_own_shadows),
    };
    if (argc < 2 || !suite_init(&suite, argv[1]))
        return 1;
    int failed = cmocka_run_group_tests_name("twig_shade", tests, NULL, NULL);
    suite_finish(&suite);
    return failed;
}
