/* Grasses that close over the ground shade one another, tall ones, too, near and far. */
#include <stdio.h>

#include "suite.h"

enum { WIDTH = 64, HEIGHT = 48 };

static struct suite suite;

/* Values of a scene's keys. */
struct bed {
    const char *species, *size_m, *spacing_m, *height_m, *date, *light, *camera;
};

static const char *write_bed(const struct bed *bed)
{
    char text[2048];
    snprintf(text, sizeof text,
             "{\"name\": \"bed\", \"variants\": 2, \"terrain\": {\"kind\": \"flat\", \"size_m\": %s},\n"
             " \"species\": {\"grass\": \"%s/species/%s.json\"},\n"
             " \"layers\": [{\"species\": \"grass\", \"spacing_m\": %s, \"height_m\": %s}],\n"
             " \"time\": {\"date\": \"%s\"}, %s, \"wind\": {\"speed_mps\": 0},\n"
             " \"cameras\": [{\"name\": \"over\", %s}]}",
             bed->size_m, suite.root, bed->species, bed->spacing_m, bed->height_m, bed->date, bed->light, bed->camera);
    assert_true(suite_write(&suite, "bed.json", text));
    return suite_path(&suite, "bed.json");
}

static const char CLOUDS[] = "\"sky\": {\"cover\": 1}";

/* Grass as tall as reeds, under clouds, from above its edge. */
static struct bed reeds(const char *spacing_m)
{
    return (struct bed){"grass", "[16, 16]", spacing_m, "[0.9, 1.1]", "2024-07-10", CLOUDS,
                        "\"position_m\": [8, 2, 3], \"look_at_m\": [8, 8, 0.4], \"fov_deg\": 30"};
}

/* What a standing eye sees of a meadow from 16 m off to 45. */
static struct bed meadow(const char *light)
{
    return (struct bed){"meadow", "[16, 60]", "0.9", "[0.15, 0.35]", "2024-05-30", light,
                        "\"position_m\": [8, 3, 1.7], \"pitch_deg\": -4, \"fov_deg\": 4"};
}

static double mean_green(const struct wd_picture *picture)
{
    double sum = 0;
    for (size_t at = 0; at < (size_t)WIDTH * HEIGHT; at++)
        sum += (double)picture->color[3 * at + 1];
    return sum / (WIDTH * HEIGHT);
}

static double traced(const struct wd_forest *forest, const struct wd_render_params *render)
{
    struct wd_picture picture = {0};
    suite_trace(&suite, forest, render, 32, &picture);
    double mean = mean_green(&picture);
    wd_picture_finish(&picture);
    return mean;
}

/* Light of a method's picture over that of the path-traced one, less 1, in percent. */
static void expect_light(struct bed bed, const char *what, const char *method, double most_pct)
{
    struct wd_forest *forest = suite_forest(&suite, write_bed(&bed));
    struct wd_picture picture = {0};
    assert_non_null(forest);
    assert_int_equal(wd_renderer_set_forest(suite.renderer, forest), WD_OK);
    struct wd_render_params render = suite_params(forest, "over");
    render.width = WIDTH;
    render.height = HEIGHT;
    render.samples = 4;
    render.method = method;
    render.layers = WD_LAYER_COLOR;
    assert_int_equal(wd_renderer_render(suite.renderer, &render, &picture), WD_OK);
    double pct = 100 * (mean_green(&picture) / traced(forest, &render) - 1);
    print_message("%s, %s: %+.1f %%\n", what, method, pct);
    assert_true(pct > -most_pct && pct < most_pct);
    wd_picture_finish(&picture);
    assert_int_equal(wd_renderer_set_forest(suite.renderer, suite.forest), WD_OK);
    wd_forest_destroy(&forest);
}

/* Lit like plants that stand free, dense ones were 70 to 80 % too bright. */
static void dense_reeds_shade_one_another(void **state)
{
    (void)state;
    expect_light(reeds("0.45"), "reeds every 0.45 m", "continuum", 15);
    expect_light(reeds("0.45"), "reeds every 0.45 m", "octree", 20);
}

static void tufts_stand_free(void **state)
{
    (void)state;
    expect_light(reeds("1.5"), "reeds every 1.5 m", "continuum", 15);
}

/* -8 and +7 % (-11 and +24 % where discs have the light of the blades that they stand for, whatever stands beside
 * those). */
static void far_meadows_are_as_bright_as_traced(void **state)
{
    (void)state;
    expect_light(meadow(CLOUDS), "meadow under clouds", "continuum", 10);
    expect_light(meadow("\"sun\": {\"azimuth_deg\": 180, \"elevation_deg\": 35}"), "meadow in the sun",
                 "continuum", 15);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dense_reeds_shade_one_another),
        cmocka_unit_test(tufts_stand_free),
        cmocka_unit_test(far_meadows_are_as_bright_as_traced),
    };
    if (argc < 2 || !suite_init(&suite, argv[1]))
        return 1;
    int failed = cmocka_run_group_tests_name("sward", tests, NULL, NULL);
    suite_finish(&suite);
    return failed;
}
