/* Whatever a renderer drew before, a picture is that of one that drew nothing. What it keeps from picture to picture
 * (shadow maps, the sky of crowns, what the view before hid) must fit or be found anew.
 *   test-order ROOT   (the folder of the sources) */
#include "suite.h"

#include <string.h>

enum { PIXELS = PICTURE_WIDTH * PICTURE_HEIGHT };

/* Shadow maps are as wide for one sample as for four, and nothing moves: they are kept wherever they may be. */
static const char *const settings[] = {"quality.shadow_size=2048", "wind.speed_mps=0", NULL};

static const struct shot {
    const char *camera, *method;
    uint32_t samples;
    double max_error_px;
    double aside_m; /* of the camera, east and south */
} shots[] = {
    {"over", "continuum", 1, 0, 0}, {"over", "continuum", 4, 0, 0}, {"over", "octree", 1, 0, 0},
    {"walk", "continuum", 1, 0, 0}, {"over", "continuum", 4, 6, 0}, {"walk", "continuum", 1, 0, 100},
    {"walk", "continuum", 1, 0, -100},
};
enum { SHOTS = sizeof shots / sizeof *shots };

static struct wd_picture take(struct suite *suite, const struct shot *shot)
{
    struct wd_render_params params = suite_params(suite->forest, shot->camera);
    params.camera.position_m[0] += shot->aside_m;
    params.camera.position_m[1] -= shot->aside_m;
    params.camera.position_m[2] += shot->aside_m != 0 ? 25 : 0; /* the ground may be higher there */
    params.method = shot->method;
    params.samples = shot->samples;
    params.max_error_px = shot->max_error_px;
    params.layers = WD_LAYER_COLOR | WD_LAYER_TREE_ID;
    return suite_render(suite, &params);
}

static void expect_as_alone(struct suite *suite, int shot, int before, const struct wd_picture *alone)
{
    struct wd_picture picture = take(suite, &shots[shot]);
    if (memcmp(picture.color, alone->color, PIXELS * 3 * sizeof *picture.color) != 0 ||
        memcmp(picture.tree_id, alone->tree_id, PIXELS * sizeof *picture.tree_id) != 0)
        fail_msg("shot %d after shot %d is not what it is alone", shot, before);
    wd_picture_finish(&picture);
}

/* Samples more and fewer, an error bound before and after, another method, other places, some so far apart that one's ground
 * is kept where the other's was. */
static const int order[] = {0, 1, 0, 4, 1, 4, 0, 2, 1, 3, 0, 5, 6, 5};

static void what_was_drawn_before_leaves_no_trace(void **state)
{
    struct suite *suite = *state;
    struct wd_picture alone[SHOTS];
    for (int i = 0; i < SHOTS; i++) {
        assert_int_equal(wd_renderer_set_forest(suite->renderer, suite->forest), WD_OK);
        alone[i] = take(suite, &shots[i]);
    }
    expect_as_alone(suite, order[0], SHOTS - 1, &alone[order[0]]);
    for (size_t i = 1; i < sizeof order / sizeof *order; i++)
        expect_as_alone(suite, order[i], order[i - 1], &alone[order[i]]);
    for (int i = 0; i < SHOTS; i++)
        wd_picture_finish(&alone[i]);
}

int main(int argc, char **argv)
{
    static struct suite suite;
    if (!suite_init(&suite, argc > 1 ? argv[1] : "."))
        return 1;
    const struct wd_forest_params params = {
        .scene_path = suite.small_path, .settings = settings, .log = suite.log};
    wd_forest_destroy(&suite.forest);
    if (wd_forest_create(&suite.forest, &params) != WD_OK)
        return 1;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(what_was_drawn_before_leaves_no_trace, &suite),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_finish(&suite);
    return failed;
}
