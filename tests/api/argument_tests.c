/* Arguments that cannot be: each is refused with a message that names it. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "parts.h"
#include "weald/compare.h"
#include "weald/reference.h"
#include "weald/tree.h"
#include "weald/vulkan.h"

static const double DEGREE = 3.14159265358979323846 / 180;

#define assert_input(suite, call, part)                                                            \
    do {                                                                                           \
        suite_clear(suite);                                                                        \
        assert_int_equal(call, WD_ERROR_INPUT);                                                    \
        assert_true(suite_logged(suite, part));                                                    \
    } while (0)

/* --- pictures ---------------------------------------------------------------------------- */

static void assert_refused(struct suite *suite, const struct wd_render_params *params, const char *part)
{
    struct wd_picture picture;
    assert_input(suite, wd_renderer_render(suite->renderer, params, &picture), part);
    assert_true(picture.width == 0 && !picture.display);
}

static void cameras_are_finite(void **state)
{
    struct suite *suite = *state;
    struct wd_render_params params = suite_params(suite->forest, "over");
    const struct wd_camera good = params.camera;
    params.camera.yaw_rad = INFINITY;
    assert_refused(suite, &params, "camera.yaw_rad is inf");
    params.camera = good;
    params.camera.pitch_rad = NAN;
    assert_refused(suite, &params, "camera.pitch_rad nan");
    params.camera = good;
    struct wd_camera previous = good;
    params.previous_camera = &previous;
    previous.position_m[1] = NAN;
    assert_refused(suite, &params, "previous_camera.position_m is");
    previous = good;
    previous.pitch_rad = -INFINITY;
    assert_refused(suite, &params, "previous_camera.yaw_rad");
    previous = good;
    previous.fov_rad = 0;
    assert_refused(suite, &params, "previous_camera.fov_rad is 0");
}

static void fields_of_view_have_bounds(void **state)
{
    struct suite *suite = *state;
    struct wd_render_params params = suite_params(suite->forest, "over");
    const double wrong[] = {0, -1, 1e-9, 1e-4, 0.099 * DEGREE, 179.1 * DEGREE, 4, NAN};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        params.camera.fov_rad = wrong[i];
        assert_refused(suite, &params, "0.00175 to 3.12414 radians (0.1 to 179 degrees)");
    }
}

/* Scene files have the same bounds, and what they allow can be drawn. */
static void scenes_fields_of_view_are_alike(void **state)
{
    struct suite *suite = *state;
    static const struct {
        const char *setting;
        bool possible;
    } cases[] = {{"cameras.0.fov_deg=0.1", true},
                 {"cameras.0.fov_deg=0.09", false},
                 {"cameras.0.fov_deg=179.5", false}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const char *const settings[] = {cases[i].setting, NULL};
        const struct wd_forest_params params = {
            .scene_path = suite->small_path, .settings = settings, .log = suite->log};
        struct wd_forest *forest;
        suite_clear(suite);
        enum wd_result result = wd_forest_create(&forest, &params);
        assert_int_equal(result, cases[i].possible ? WD_OK : WD_ERROR_INPUT);
        if (!cases[i].possible) {
            assert_true(suite_logged(suite, "fov_deg"));
            continue;
        }
        struct wd_render_params render = suite_params(forest, NULL);
        render.width = render.height = 4;
        struct wd_picture picture = suite_render(suite, &render);
        wd_picture_finish(&picture);
        wd_forest_destroy(&forest);
    }
}

static void times_are_finite(void **state)
{
    struct suite *suite = *state;
    const double wrong[] = {NAN, INFINITY, -INFINITY, 1e300};
    struct wd_render_params params = suite_params(suite->forest, "over");
    struct wd_camera camera;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        params.time_s = wrong[i];
        assert_refused(suite, &params, "time_s is");
        params.time_s = 0;
        params.previous_time_s = wrong[i];
        assert_refused(suite, &params, "previous_time_s is");
        params.previous_time_s = 0;
    }
    assert_input(suite, wd_forest_get_path_camera(suite->forest, "fly", NAN, &camera, NULL),
                 "time_s is nan");
}

static void choices_are_known(void **state)
{
    struct suite *suite = *state;
    const struct wd_render_params good = suite_params(suite->forest, "over");
    struct wd_render_params params = good;
    params.view = (enum wd_view_mode)99;
    assert_refused(suite, &params, "view is 99: 0 to 5 are possible");
    params = good;
    params.layers = WD_LAYER_COLOR | 1u << 20;
    assert_refused(suite, &params, "layers has the unknown bits 0x100000");
    params = good;
    params.accumulation = 7;
    assert_refused(suite, &params, "accumulation is 7");
    params = good;
    params.timing = 7;
    assert_refused(suite, &params, "timing is 7");
}

/* A live picture has no time before it: what is not used may be anything. */
static void what_is_not_used_is_not_asked_for(void **state)
{
    struct suite *suite = *state;
    struct wd_render_params params = suite_params(suite->forest, "over");
    params.width = params.height = 8;
    params.accumulation = WD_ACCUMULATE;
    params.previous_time_s = NAN;
    struct wd_picture picture = suite_render(suite, &params);
    wd_picture_finish(&picture);
}

/* --- names ------------------------------------------------------------------------------- */

static void unknown_names_list_all(void **state)
{
    struct suite *suite = *state;
    struct wd_camera camera;
    assert_input(suite, wd_forest_get_camera(suite->forest, "zzz", &camera),
                 "no camera \"zzz\"; there are: over, walk");
    assert_input(suite, wd_forest_get_camera(suite->forest, "wlak", &camera),
                 "did you mean \"walk\"; there are: over, walk");
    assert_input(suite, wd_forest_get_path_camera(suite->forest, "zzz", 0, &camera, NULL),
                 "no path \"zzz\"; there are: fly");
    struct wd_render_params params = suite_params(suite->forest, "over");
    params.method = "octre";
    assert_refused(suite, &params, "no method \"octre\", did you mean \"octree\"; there are: ");
}

/* Of many the first, how many more there are, and the one that was meant. */
static void unknown_names_of_many_list_few(void **state)
{
    struct suite *suite = *state;
    char text[4096] = "{\"name\": \"over\"";
    struct wd_camera camera;
    for (int i = 0; i < 40; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text),
                 ", \"position_m\": [9, 9, -9]}, {\"name\": \"camera_%02d\"", i);
    assert_true(suite_write_variant(suite, "many.json", "{\"name\": \"over\"", text));
    suite_clear(suite);
    struct wd_forest *forest = suite_forest(suite, suite_path(suite, "many.json"));
    assert_non_null(forest);
    assert_true(suite_logged(suite, "camera \"camera_03\" stands") && !suite_logged(suite, "camera \"camera_04\" stands"));
    assert_true(suite_logged(suite, "35 more cameras and keys of paths stand below the ground"));
    assert_input(suite, wd_forest_get_camera(forest, "camra_37", &camera),
                 "did you mean \"camera_37\"; there are: over, camera_00, camera_01, camera_02, camera_03, camera_04, "
                 "camera_05, camera_06, camera_07, camera_08 and 32 more\n");
    wd_forest_destroy(&forest);
}

static void odd_places_of_cameras_are_told(void **state)
{
    struct suite *suite = *state;
    suite_clear(suite);
    struct wd_forest *forest = suite_forest(suite, suite->small_path);
    assert_string_equal(suite->messages, "");
    wd_forest_destroy(&forest);
    assert_true(suite_write_variant(suite, "odd.json", "\"position_m\": [150, 120, 1.7]", "\"position_m\": [150, 120, -30]"));
    forest = suite_forest(suite, suite_path(suite, "odd.json"));
    assert_true(suite_logged(suite, "camera \"walk\" stands at (150, 120, ") && suite_logged(suite, "30 m below the ground, "));
    wd_forest_destroy(&forest);
    assert_true(suite_write_variant(suite, "odd.json", "{\"position_m\": [150, 0, 50]", "{\"position_m\": [150, 1250, 50]"));
    suite_clear(suite);
    assert_int_equal(wd_file_check(suite_path(suite, "odd.json"), NULL, &suite->log), WD_OK);
    assert_string_equal(suite->messages, "");
    assert_true(suite_write_variant(suite, "odd.json", "{\"position_m\": [150, 0, 50]", "{\"position_m\": [150, 1350, 50]"));
    assert_int_equal(wd_file_check(suite_path(suite, "odd.json"), NULL, &suite->log), WD_OK);
    assert_true(suite_logged(suite, "key 1 of path \"fly\" stands at (150, 1350, ") &&
                suite_logged(suite, "1050 m outside the ground of 300 x 300 m"));
}

/* --- what is not given ------------------------------------------------------------------- */

static void nothing_is_made_of_nothing(void **state)
{
    struct suite *suite = *state;
    const struct wd_log *log = &suite->log;
    const struct wd_specimen_params no_source = {.log = *log};
    const struct wd_forest_params no_scene = {.log = *log};
    const struct wd_film_params no_path = {.width = 8, .height = 8};
    const struct wd_reference_params reference_params = {.log = *log};
    const struct wd_renderer_params renderer_params = {.gpu = "software", .log = *log};
    const struct wd_picture picture = {0};
    uint64_t frames;
    struct wd_specimen *specimen;
    struct wd_forest *forest;
    struct wd_film *film;
    struct wd_reference *reference;
    struct wd_renderer *renderer;
    assert_input(suite, wd_specimen_create(&specimen, &no_source),
                 "wd_specimen_create: params->source is NULL");
    assert_input(suite, wd_forest_create(&forest, &no_scene),
                 "wd_forest_create: params->scene_path is NULL");
    assert_input(suite, wd_film_open(&film, &no_path, log), "wd_film_open: params->path is NULL");
    assert_input(suite, wd_film_open(&film, NULL, log), "wd_film_open: params is NULL");
    assert_input(suite, wd_reference_create(&reference, NULL, &reference_params),
                 "wd_reference_create: forest is NULL");
    assert_input(suite, wd_film_add_kept(NULL, &frames), "");
    assert_input(suite, wd_film_add(NULL, &picture), "");
    wd_picture_finish(NULL);
    assert_input(suite, wd_renderer_create_vulkan(&renderer, NULL, &renderer_params),
                 "wd_renderer_create_vulkan: handles is NULL");
    assert_input(suite, wd_renderer_create_presenting(&renderer, NULL, 1, &renderer_params),
                 "wd_renderer_create_presenting: instance_extensions is NULL");
    assert_true(!specimen && !forest && !film && !reference && !renderer);
}

static void nothing_is_written_of_nothing(void **state)
{
    struct suite *suite = *state;
    const struct wd_log *log = &suite->log;
    uint8_t pixel[4] = {0};
    struct wd_picture picture = {.width = 1, .height = 1, .display = pixel}, read;
    struct wd_comparison comparison;
    struct wd_render_params params = suite_params(suite->forest, NULL);
    assert_input(suite, wd_picture_write(&picture, NULL, log), "wd_picture_write: path is NULL");
    assert_input(suite, wd_picture_write(NULL, "a.png", log), "wd_picture_write: picture is NULL");
    assert_input(suite, wd_picture_read_exr(&read, NULL, log), "wd_picture_read_exr: path is NULL");
    assert_input(suite, wd_picture_compare(&comparison, NULL, &picture, NULL, log), "reference is NULL");
    float color[3] = {0, NAN, 0};
    uint32_t tree = 0;
    struct wd_picture broken = {.width = 1, .height = 1, .color = color, .tree_id = &tree}, empty = broken;
    empty.width = 0;
    assert_input(suite, wd_picture_compare(&comparison, &broken, &broken, NULL, log),
                 "the reference has a colour that is no finite number, in column 0 of row 0");
    assert_input(suite, wd_picture_compare(&comparison, &empty, &empty, NULL, log), "without pixels");
    assert_input(suite, wd_forest_write(suite->forest, NULL, 0, NULL, log),
                 "wd_forest_write: path is NULL");
    assert_input(suite, wd_forest_check_output(suite->forest, NULL, 0, log),
                 "wd_forest_check_output: path is NULL");
    assert_input(suite, wd_file_check(NULL, NULL, log), "wd_file_check: path is NULL");
    assert_input(suite, wd_renderer_render(suite->renderer, NULL, &read), "params is NULL");
    assert_input(suite, wd_renderer_draw(suite->renderer, &params, NULL), "target is NULL");
    assert_null(wd_schema_text(NULL));
}

/* However many there are to be, asked at once: those that are there are looked at, links too. */
static void frames_do_not_replace_sources(void **state)
{
    struct suite *suite = *state;
    const char *pattern = suite_path(suite, "kept-%d.png"), *link = suite_path(suite, "kept-7.png");
    const uint64_t many = UINT64_C(1) << 40;
    assert_int_equal(wd_forest_check_output(suite->forest, pattern, many, &suite->log), WD_OK);
    assert_int_equal(symlink(suite->small_path, link), 0);
    assert_input(suite, wd_forest_check_output(suite->forest, pattern, many, &suite->log),
                 "kept-7.png: is the scene file of");
    assert_int_equal(wd_forest_check_output(suite->forest, pattern, 7, &suite->log), WD_OK);
    assert_int_equal(unlink(link), 0);
}

/* --- specimens --------------------------------------------------------------------------- */

static void rows_have_a_tree_and_a_shape(void **state)
{
    struct suite *suite = *state;
    char source[1100];
    snprintf(source, sizeof source, "%s/species/beech.json", suite->root);
    const struct wd_specimen_params params = {.source = source, .height_m = 2, .log = suite->log};
    struct wd_specimen *specimen;
    struct wd_forest *forest;
    const double aspects[] = {0, -1, NAN, INFINITY, 1e-5, 1e5}, distances[] = {-5, NAN, INFINITY, 1e7};
    assert_int_equal(wd_specimen_create(&specimen, &params), WD_OK);
    const struct wd_specimen *row[2] = {specimen, NULL};
    const char *path = suite_path(suite, "none.glb");
    assert_input(suite, wd_specimens_write(row, 0, path, &suite->log), "count is 0");
    assert_input(suite, wd_specimens_write(NULL, 1, path, &suite->log), "specimens is NULL");
    assert_input(suite, wd_specimens_write(row, 2, path, &suite->log), "specimens[1] is NULL");
    assert_input(suite, wd_specimens_write(row, 1, NULL, &suite->log), "path is NULL");
    assert_null(fopen(path, "r"));
    assert_input(suite, wd_forest_create_specimens(&forest, row, 0, 1, 0, &suite->log), "count is 0");
    for (size_t i = 0; i < sizeof aspects / sizeof *aspects; i++)
        assert_input(suite, wd_forest_create_specimens(&forest, row, 1, aspects[i], 0, &suite->log),
                     "aspect is");
    for (size_t i = 0; i < sizeof distances / sizeof *distances; i++)
        assert_input(suite, wd_forest_create_specimens(&forest, row, 1, 1, distances[i], &suite->log),
                     "distance_m is");
    assert_null(forest);
    wd_specimen_destroy(&specimen);
}

int argument_tests(struct suite *suite)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(cameras_are_finite, suite),
        cmocka_unit_test_prestate(fields_of_view_have_bounds, suite),
        cmocka_unit_test_prestate(scenes_fields_of_view_are_alike, suite),
        cmocka_unit_test_prestate(times_are_finite, suite),
        cmocka_unit_test_prestate(choices_are_known, suite),
        cmocka_unit_test_prestate(what_is_not_used_is_not_asked_for, suite),
        cmocka_unit_test_prestate(unknown_names_list_all, suite),
        cmocka_unit_test_prestate(unknown_names_of_many_list_few, suite),
        cmocka_unit_test_prestate(odd_places_of_cameras_are_told, suite),
        cmocka_unit_test_prestate(nothing_is_made_of_nothing, suite),
        cmocka_unit_test_prestate(nothing_is_written_of_nothing, suite),
        cmocka_unit_test_prestate(frames_do_not_replace_sources, suite),
        cmocka_unit_test_prestate(rows_have_a_tree_and_a_shape, suite),
    };
    return cmocka_run_group_tests_name("arguments", tests, NULL, NULL);
}
