/* Leaves close to the eye are drawn as twigs, and shade one another as these do. */
#include <stdio.h>

#include "suite.h"
#include "weald/compare.h"

static struct suite suite;

/* A beech 4 m off, before the sun, without the sky. */
static const char *write_beech(void)
{
    char text[2048];
    snprintf(text, sizeof text,
             "{\"name\": \"twigs\", \"variants\": 1, \"terrain\": {\"kind\": \"flat\", \"size_m\": [60, 60]},\n"
             " \"species\": {\"beech\": \"%s/species/beech.json\"},\n"
             " \"inventories\": [{\"file\": \"twigs.csv\", \"frame\": \"local\"}],\n"
             " \"sun\": {\"azimuth_deg\": 0, \"elevation_deg\": 50}, \"sky\": {\"strength\": 0.0001},\n"
             " \"wind\": {\"speed_mps\": 0},\n"
             " \"cameras\": [{\"name\": \"at\", \"position_m\": [30, 26, 5.5], \"look_at_m\": [30, 30, 5.5],\n"
             "               \"fov_deg\": 6}]}",
             suite.root);
    assert_true(suite_write(&suite, "twigs.csv", "x_m,y_m,species,height_m\n30,30,beech,9\n"));
    assert_true(suite_write(&suite, "twigs.json", text));
    return suite_path(&suite, "twigs.json");
}

/* Against the sun: +22 %, and +55 by the shadows of the leaves that stand for the twigs. */
static void twigs_throw_their_own_shadows(void **state)
{
    (void)state;
    struct wd_forest *forest = suite_forest(&suite, write_beech());
    struct wd_picture drawn = {0}, traced = {0};
    struct wd_comparison found;
    assert_non_null(forest);
    assert_int_equal(wd_renderer_set_forest(suite.renderer, forest), WD_OK);
    struct wd_render_params render = suite_params(forest, "at");
    render.width = 64;
    render.height = 48;
    render.samples = 8;
    render.method = "continuum";
    render.layers = WD_LAYER_COLOR | WD_LAYER_TREE_ID;
    assert_int_equal(wd_renderer_render(suite.renderer, &render, &drawn), WD_OK);
    suite_trace(&suite, forest, &render, 64, &traced);
    assert_int_equal(wd_picture_compare(&found, &traced, &drawn, NULL, &suite.log), WD_OK);
    print_message("light of a beech 4 m off: %+.1f %%\n", found.tree_bias_pct);
    assert_true(found.tree_bias_pct > -35 && found.tree_bias_pct < 35);
    wd_picture_finish(&drawn);
    wd_picture_finish(&traced);
    assert_int_equal(wd_renderer_set_forest(suite.renderer, suite.forest), WD_OK);
    wd_forest_destroy(&forest);
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
