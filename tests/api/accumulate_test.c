/* Samples of frames that follow each other: their mean stands still where nothing moves, is nearer the
 * truth than one sample where something does, and leaves no trail behind trees.
 *   test-accumulate ROOT   (the folder of the sources) */
#include "suite.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PIXELS = PICTURE_WIDTH * PICTURE_HEIGHT, FRAMES = 16 };

static struct wd_render_params params_of(struct suite *suite, const char *camera)
{
    struct wd_render_params params = suite_params(suite->forest, camera);
    params.method = "continuum";
    params.layers = WD_LAYER_COLOR | WD_LAYER_TREE_ID;
    return params;
}

/* Root mean square difference over the truth's mean, of pixels that `mask` names; NULL: all. */
static double error_of(const struct wd_picture *picture, const struct wd_picture *truth,
                       const uint8_t *mask)
{
    double squares = 0.0, sum = 0.0;
    size_t count = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        if (mask && !mask[i])
            continue;
        for (size_t k = 3 * i; k < 3 * i + 3; k++) {
            double off = (double)picture->color[k] - (double)truth->color[k];
            squares += off * off;
            sum += (double)truth->color[k];
        }
        count += 3;
    }
    assert_true(count > 150);
    return sqrt(squares / (double)count) / (sum / (double)count);
}

/* The camera's way, and the wind's. */
struct motion {
    const char *camera;
    double step_m[3], step_s;
};

static struct wd_render_params frame_of(struct suite *suite, const struct motion *motion, int frame)
{
    struct wd_render_params params = params_of(suite, motion->camera);
    for (int k = 0; k < 3; k++)
        params.camera.position_m[k] += motion->step_m[k] * frame;
    params.time_s = 1.0 + motion->step_s * frame;
    return params;
}

struct outcome {
    struct wd_picture gathered, single, truth, before;
};

/* FRAMES frames gathered; the last of them by itself, and as a multi-sample picture. */
static void run_motion(struct suite *suite, const struct motion *motion, struct outcome *outcome)
{
    struct wd_render_params params;
    for (int frame = 0; frame < FRAMES; frame++) {
        params = frame_of(suite, motion, frame);
        params.accumulation = WD_ACCUMULATE;
        if (frame > 0)
            wd_picture_finish(&outcome->gathered);
        outcome->gathered = suite_render(suite, &params);
    }
    params = frame_of(suite, motion, FRAMES - 1);
    outcome->single = suite_render(suite, &params);
    params.samples = 64;
    outcome->truth = suite_render(suite, &params);
    params = frame_of(suite, motion, FRAMES - 2);
    outcome->before = suite_render(suite, &params);
}

static void finish_outcome(struct outcome *outcome)
{
    wd_picture_finish(&outcome->gathered);
    wd_picture_finish(&outcome->single);
    wd_picture_finish(&outcome->truth);
    wd_picture_finish(&outcome->before);
}

static void a_still_view_comes_to_many_samples(void **state)
{
    struct suite *suite = *state;
    const struct motion none = {.camera = "over"};
    struct outcome found;
    run_motion(suite, &none, &found);
    double gathered = error_of(&found.gathered, &found.truth, NULL);
    double single = error_of(&found.single, &found.truth, NULL);
    struct wd_render_params params = frame_of(suite, &none, 0);
    params.samples = FRAMES;
    struct wd_picture many = suite_render(suite, &params);
    double known = error_of(&many, &found.truth, NULL);
    print_message("still: one sample %.3f, %d gathered %.3f, %d in one picture %.3f\n", single, FRAMES,
                  gathered, FRAMES, known);
    assert_true(gathered < 0.5 * single && gathered < 1.4 * known);
    wd_picture_finish(&many);
    finish_outcome(&found);
}

/* Pixels where another thing was seen in the frame before: what came out from behind trees. */
static void mark_uncovered(const struct outcome *found, uint8_t mask[PIXELS])
{
    for (size_t i = 0; i < PIXELS; i++)
        mask[i] = found->single.tree_id[i] != found->before.tree_id[i];
}

static void check_motion(struct suite *suite, const char *name, const struct motion *motion)
{
    static uint8_t mask[PIXELS];
    struct outcome found;
    run_motion(suite, motion, &found);
    mark_uncovered(&found, mask);
    double gathered = error_of(&found.gathered, &found.truth, NULL);
    double single = error_of(&found.single, &found.truth, NULL);
    double trail = error_of(&found.gathered, &found.truth, mask);
    double single_there = error_of(&found.single, &found.truth, mask);
    print_message("%s: one sample %.3f, gathered %.3f; where it changed %.3f, gathered %.3f\n", name,
                  single, gathered, single_there, trail);
    assert_true(gathered < 0.8 * single);
    assert_true(trail < single_there); /* older pictures show through nowhere */
    finish_outcome(&found);
}

static void moving_cameras_leave_no_trail(void **state)
{
    const struct motion ahead = {.camera = "over", .step_m = {0.0, 0.5, 0.0}};
    const struct motion aside = {.camera = "over", .step_m = {0.3, 0.0, 0.0}};
    check_motion(*state, "ahead", &ahead);
    check_motion(*state, "aside", &aside);
}

static void swaying_trees_leave_no_trail(void **state)
{
    const struct motion wind = {.camera = "walk", .step_s = 0.4};
    check_motion(*state, "wind", &wind);
}

/* What was gathered of one view, method or size is not laid under another. */
static void nothing_is_kept_of_something_else(void **state)
{
    struct suite *suite = *state;
    struct wd_render_params params = params_of(suite, "over");
    params.accumulation = WD_ACCUMULATE;
    struct wd_picture first = suite_render(suite, &params);
    params.method = "octree";
    struct wd_picture other = suite_render(suite, &params);
    wd_picture_finish(&other);
    params.method = "continuum";
    struct wd_picture again = suite_render(suite, &params);
    double off = error_of(&again, &first, NULL);
    print_message("begun anew: %.4f\n", off);
    assert_true(off < 0.02);
    wd_picture_finish(&first);
    wd_picture_finish(&again);
}

/* Software devices let a shader see 128 MB of a buffer. */
static void windows_of_4k_have_room(void **state)
{
    struct suite *suite = *state;
    struct wd_render_params params = params_of(suite, "over");
    params.accumulation = WD_ACCUMULATE;
    params.width = 4096;
    params.height = 2160;
    params.camera.pitch_rad = 1.5; /* the sky */
    params.layers = WD_LAYER_DISPLAY;
    struct wd_picture picture = suite_render(suite, &params);
    wd_picture_finish(&picture);
}

int main(int argc, char **argv)
{
    static struct suite suite;
    if (!suite_init(&suite, argc > 1 ? argv[1] : "."))
        return 1;
    if (!suite_write_variant(&suite, "windy.json", "\"sun\":", "\"wind\": {\"speed_mps\": 12, \"gust\": 0.8}, \"sun\":"))
        return 1;
    struct wd_forest *windy = suite_forest(&suite, suite_path(&suite, "windy.json"));
    wd_forest_destroy(&suite.forest);
    suite.forest = windy;
    if (!windy || wd_renderer_set_forest(suite.renderer, windy) != WD_OK)
        return 1;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(a_still_view_comes_to_many_samples, &suite),
        cmocka_unit_test_prestate(moving_cameras_leave_no_trail, &suite),
        cmocka_unit_test_prestate(swaying_trees_leave_no_trail, &suite),
        cmocka_unit_test_prestate(nothing_is_kept_of_something_else, &suite),
        cmocka_unit_test_prestate(windows_of_4k_have_room, &suite),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_finish(&suite);
    return failed;
}
