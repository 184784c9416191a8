/* The path tracer through the public interface: it sees what the renderer draws; bad input. */
#include <glob.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "../../bench/agreement.h"
#include "suite.h"

static struct suite *suite_of(void **state)
{
    return *state;
}

static void test_agreement(void **state)
{
    struct suite *suite = suite_of(state);
    struct bench_agreement a;
    assert_true(bench_agreement_measure(&a, suite->small_path, "walk", "software"));
    print_message("%llu inner pixels, ids %.2f%%, normals %.2f deg, depth %.2f mm, albedo %+.2f%%, "
                  "ground %+.2f%%\n",
                  (unsigned long long)a.inner_pixels, a.id_pct, a.normal_deg, a.depth_mm,
                  a.albedo_pct, a.ground_albedo_pct);
    assert_true(a.inner_pixels > 20000);
    assert_true(a.id_pct >= 99.0);
    assert_true(a.normal_deg < 3.0);
    assert_true(a.depth_mm < 20.0);
    assert_true(fabs(a.albedo_pct) < 8.0);
    assert_true(fabs(a.ground_albedo_pct) < 3.0);
}

/* Of the suite's forest, for all tests: one traces pictures, the other ends half-way. */
static struct wd_reference *reference, *stopping;

static bool open_reference(struct wd_reference **opened, struct suite *suite,
                           bool (*report)(void *, const char *, uint64_t, uint64_t))
{
    const struct wd_reference_params params = {.progress = {report, suite}, .log = suite->log};
    return wd_reference_create(opened, suite->forest, &params) == WD_OK;
}

static bool stop_half_way(void *user, const char *stage, uint64_t done, uint64_t total)
{
    (void)user, (void)stage;
    return done < total / 2;
}

static struct wd_reference_picture_params picture_params(struct suite *suite)
{
    struct wd_reference_picture_params params = {
        .width = 48, .height = 36, .samples = 8, .layers = WD_LAYER_COLOR};
    assert_int_equal(wd_forest_get_camera(suite->forest, "walk", &params.camera), WD_OK);
    return params;
}

/* Without colour and display no path is traced; a checkpoint that lies there stays. */
static void layers_need_no_paths(void **state)
{
    struct suite *suite = suite_of(state);
    struct wd_reference_picture_params params = picture_params(suite);
    const size_t pixels = (size_t)params.width * params.height;
    struct wd_picture lit, layers;
    struct wd_reference_stats lit_stats, stats;
    params.layers = WD_LAYER_COLOR | WD_LAYER_DEPTH | WD_LAYER_TREE_ID;
    assert_int_equal(wd_reference_render(reference, &params, &lit), WD_OK);
    wd_reference_get_stats(reference, &lit_stats);
    params.layers &= ~(uint32_t)WD_LAYER_COLOR;
    assert_true(suite_write(suite, "other.partial", "of another picture"));
    params.checkpoint = suite_path(suite, "other.partial");
    assert_int_equal(wd_reference_render(reference, &params, &layers), WD_OK);
    wd_reference_get_stats(reference, &stats);
    assert_null(layers.color);
    assert_memory_equal(layers.depth_m, lit.depth_m, pixels * sizeof *lit.depth_m);
    assert_memory_equal(layers.tree_id, lit.tree_id, pixels * sizeof *lit.tree_id);
    assert_true(stats.rays < lit_stats.rays / 8); /* of 8 samples */
    assert_int_equal(access(params.checkpoint, F_OK), 0);
    wd_picture_finish(&lit);
    wd_picture_finish(&layers);
}

/* Stopped and gone on with is the same as never stopped. */
static void test_resume(void **state)
{
    struct suite *suite = suite_of(state);
    struct wd_reference_picture_params params = picture_params(suite);
    struct wd_picture whole, resumed;
    struct wd_reference_stats stats;
    assert_int_equal(wd_reference_render(reference, &params, &whole), WD_OK);
    params.checkpoint = suite_path(suite, "picture.partial");
    assert_int_equal(wd_reference_render(stopping, &params, &resumed), WD_ERROR_INTERRUPTED);
    assert_int_equal(access(params.checkpoint, F_OK), 0);
    struct wd_reference_picture_params other = params;
    other.camera.yaw_rad += 0.1;
    suite_clear(suite);
    assert_int_equal(wd_reference_render(reference, &other, &resumed), WD_ERROR_INPUT);
    assert_true(suite_logged(suite, "another scene, camera"));
    assert_int_equal(wd_reference_render(reference, &params, &resumed), WD_OK);
    wd_reference_get_stats(reference, &stats);
    assert_true(stats.resumed_samples > 0);
    assert_int_equal(stats.self_hits, 0);
    assert_memory_equal(whole.color, resumed.color, (size_t)48 * 36 * 3 * sizeof(float));
    assert_int_not_equal(access(params.checkpoint, F_OK), 0);
    wd_picture_finish(&whole);
    wd_picture_finish(&resumed);
}

/* Fewer samples than a checkpoint has are refused, and it stays; as many as it has, or more, are taken. */
static void test_fewer_samples(void **state)
{
    struct suite *suite = suite_of(state);
    struct wd_reference_picture_params params = picture_params(suite), fewer;
    struct wd_picture whole, resumed;
    params.samples = 24;
    assert_int_equal(wd_reference_render(reference, &params, &whole), WD_OK);
    params.checkpoint = suite_path(suite, "longer.partial");
    assert_int_equal(wd_reference_render(stopping, &params, &resumed), WD_ERROR_INTERRUPTED);
    fewer = params;
    fewer.samples = 1;
    suite_clear(suite);
    assert_int_equal(wd_reference_render(reference, &fewer, &resumed), WD_ERROR_INPUT);
    assert_true(suite_logged(suite, "longer.partial") && suite_logged(suite, "1 are asked for"));
    assert_null(resumed.color);
    assert_int_equal(access(params.checkpoint, F_OK), 0);
    assert_int_equal(wd_reference_render(reference, &params, &resumed), WD_OK);
    assert_memory_equal(whole.color, resumed.color, (size_t)48 * 36 * 3 * sizeof(float));
    wd_picture_finish(&whole);
    wd_picture_finish(&resumed);
}

/* A checkpoint that cannot be written is told before paths are traced. */
static void test_no_folder(void **state)
{
    struct suite *suite = suite_of(state);
    struct wd_reference_picture_params params = picture_params(suite);
    struct wd_reference_stats stats;
    struct wd_picture picture;
    params.checkpoint = suite_path(suite, "none/picture.partial");
    suite_clear(suite);
    assert_int_equal(wd_reference_render(reference, &params, &picture), WD_ERROR_OUTPUT);
    assert_true(suite_logged(suite, "none/picture.partial"));
    assert_null(picture.color);
    wd_reference_get_stats(reference, &stats);
    assert_int_equal(stats.rays, 0);
}

/* Turned leaves on the same trees are another picture. */
static void test_other_leaves(void **state)
{
    struct suite *suite = suite_of(state);
    struct wd_reference_picture_params params = picture_params(suite);
    struct wd_reference *turned;
    struct wd_forest *autumn;
    struct wd_picture picture;
    const char *const settings[] = {"time.date=2026-09-25", NULL};
    const struct wd_forest_params forest_params = {
        .scene_path = suite->small_path, .settings = settings, .log = suite->log};
    const struct wd_reference_params reference_params = {.log = suite->log};
    params.checkpoint = suite_path(suite, "summer.partial");
    assert_int_equal(wd_reference_render(stopping, &params, &picture), WD_ERROR_INTERRUPTED);
    assert_int_equal(wd_forest_create(&autumn, &forest_params), WD_OK);
    assert_int_equal(wd_reference_create(&turned, autumn, &reference_params), WD_OK);
    suite_clear(suite);
    assert_int_equal(wd_reference_render(turned, &params, &picture), WD_ERROR_INPUT);
    assert_true(suite_logged(suite, "another scene, camera"));
    wd_reference_destroy(&turned);
    wd_reference_destroy(&turned);
    wd_forest_destroy(&autumn);
}

static void assert_refused(struct suite *suite, const struct wd_reference_picture_params *params, const char *part)
{
    struct wd_picture picture;
    suite_clear(suite);
    assert_int_equal(wd_reference_render(reference, params, &picture), WD_ERROR_INPUT);
    assert_true(suite_logged(suite, part));
    assert_true(picture.width == 0 && !picture.color);
}

/* Refused as by the renderer. */
static void refuse_numbers(struct suite *suite)
{
    const struct wd_reference_picture_params good = picture_params(suite);
    struct wd_reference_picture_params params = good;
    params.width = 0;
    assert_refused(suite, &params, "0 x 36");
    params = good;
    params.camera.fov_rad = 4;
    assert_refused(suite, &params, "camera.fov_rad is 4");
    params.camera.fov_rad = 1e-4;
    assert_refused(suite, &params, "camera.fov_rad is 0.0001");
    params = good;
    params.camera.position_m[1] = NAN;
    assert_refused(suite, &params, "camera.position_m is");
    params = good;
    params.camera.yaw_rad = NAN;
    assert_refused(suite, &params, "camera.yaw_rad is nan");
    params = good;
    params.samples = 1u << 30;
    assert_refused(suite, &params, "1073741824 samples");
    params = good;
    params.time_s = INFINITY;
    assert_refused(suite, &params, "time_s is inf");
    params = good;
    params.places = (enum wd_reference_places)9;
    assert_refused(suite, &params, "places is 9");
    assert_refused(suite, NULL, "params is NULL");
}

/* Layers that it lacks are refused by name; of all it makes those that it has. */
static void refuse_layers(struct suite *suite)
{
    struct wd_reference_picture_params params = picture_params(suite);
    struct wd_picture picture;
    params.layers = WD_LAYER_VELOCITY | WD_LAYER_DEPTH;
    assert_refused(suite, &params, "layers asks for velocity, which");
    params.layers = WD_LAYER_CRYPTOMATTE;
    assert_refused(suite, &params, "layers asks for cryptomatte, which");
    params.layers = WD_LAYER_ALL | WD_LAYER_CRYPTOMATTE;
    assert_refused(suite, &params, "layers asks for velocity and cryptomatte, which");
    params.layers = WD_LAYER_COLOR | 1u << 9;
    assert_refused(suite, &params, "layers has the unknown bits 0x200");
    params.layers = WD_LAYER_ALL;
    params.width = params.height = 4;
    params.samples = 1;
    assert_int_equal(wd_reference_render(reference, &params, &picture), WD_OK);
    assert_true(picture.display && picture.color && picture.depth_m && picture.normal && picture.albedo);
    assert_true(picture.species && picture.tree_id && !picture.velocity_px && !picture.rank_tree);
    wd_picture_finish(&picture);
}

/* The largest picture there is, with all layers: 13 GiB. */
static void refuse_what_no_memory_holds(struct suite *suite)
{
    struct wd_reference_picture_params params = picture_params(suite);
    struct wd_picture picture;
    struct rlimit before;
    params.width = params.height = 16384;
    params.layers = WD_LAYER_ALL;
    suite_clear(suite);
    if (!suite_shrink_memory(&before, UINT64_C(2) << 30))
        return;
    enum wd_result result = wd_reference_render(reference, &params, &picture);
    setrlimit(RLIMIT_AS, &before);
    assert_int_equal(result, WD_ERROR_MEMORY);
    assert_true(suite_logged(suite, "out of memory: a picture of 16384 x 16384 pixels wants"));
    assert_true(picture.width == 0 && !picture.color);
}

static void test_bad_input(void **state)
{
    struct suite *suite = suite_of(state);
    refuse_numbers(suite);
    refuse_layers(suite);
    refuse_what_no_memory_holds(suite);
}

static size_t textures_kept(struct suite *suite, const char *cache_dir)
{
    const struct wd_reference_params params = {.cache_dir = cache_dir, .log = suite->log};
    struct wd_reference *own;
    char pattern[1280];
    glob_t found;
    assert_int_equal(wd_reference_create(&own, suite->forest, &params), WD_OK);
    wd_reference_destroy(&own);
    snprintf(pattern, sizeof pattern, "%s/looks-*.bin", suite->scratch);
    assert_true(glob(pattern, 0, NULL, &found) != GLOB_ABORTED);
    size_t count = found.gl_pathc;
    globfree(&found);
    return count;
}

static void textures_are_kept_where_asked(void **state)
{
    struct suite *suite = suite_of(state);
    assert_int_equal(textures_kept(suite, ""), 0);
    assert_true(textures_kept(suite, suite->scratch) > 0);
}

int main(int argc, char **argv)
{
    static struct suite suite;
    if (argc != 2 || !suite_init(&suite, argv[1]) || !open_reference(&reference, &suite, NULL)
        || !open_reference(&stopping, &suite, stop_half_way))
        return 1;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(test_agreement, &suite),
        cmocka_unit_test_prestate(layers_need_no_paths, &suite),
        cmocka_unit_test_prestate(textures_are_kept_where_asked, &suite),
        cmocka_unit_test_prestate(test_resume, &suite),
        cmocka_unit_test_prestate(test_fewer_samples, &suite),
        cmocka_unit_test_prestate(test_no_folder, &suite),
        cmocka_unit_test_prestate(test_other_leaves, &suite),
        cmocka_unit_test_prestate(test_bad_input, &suite),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    wd_reference_destroy(&reference);
    wd_reference_destroy(&stopping);
    suite_finish(&suite);
    return failed;
}
