/* What is told of a forest: its trees, ground and water, cameras and paths, and what it is made by. */
#include "../base/comma_locale.h"
#include "parts.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "weald/tree.h"

static void the_forest_counts_its_trees(void **state)
{
    struct suite *suite = *state;
    struct wd_forest_info info;
    wd_forest_get_info(suite->forest, &info);
    assert_string_equal(info.name, "small");
    assert_true(info.tree_count > 1200 && info.tree_count < 1800);
    assert_true(info.species_count == 2 && info.layer_count == 2 && info.inventory_count == 0);
    assert_int_equal(info.seed, 11);
    uint64_t counted[2] = {0}, sum = 0;
    for (uint32_t id = 1; id <= info.tree_count; id++) {
        struct wd_tree_info tree;
        assert_true(wd_forest_get_tree(suite->forest, id, &tree));
        assert_true(tree.id == id && tree.species < 2);
        counted[tree.species]++;
        double ground = wd_forest_ground_m(suite->forest, tree.position_m[0], tree.position_m[1]);
        assert_true(fabs(ground - tree.position_m[2]) < 0.5);
        assert_true(tree.height_m >= 8.9 && tree.height_m <= 20.1);
    }
    for (uint32_t i = 0; i < 2; i++) {
        struct wd_species_info species;
        assert_true(wd_forest_get_species(suite->forest, i, &species));
        assert_int_equal(species.tree_count, counted[i]);
        sum += species.tree_count;
    }
    assert_int_equal(sum, info.tree_count);
}

static void water_stands_over_what_lies_below_its_level(void **state)
{
    struct suite *suite = *state;
    const char *const settings[] = {"water.enabled=true", "water.level_m=12", NULL};
    const struct wd_forest_params params = {.scene_path = suite->small_path, .settings = settings, .log = suite->log};
    struct wd_forest *forest;
    int under = 0, open = 0;
    assert_int_equal(wd_forest_create(&forest, &params), WD_OK);
    for (int i = 0; i < 100; i++) {
        double x_m = 20 * (i % 10), y_m = 20 * (i / 10), ground_m = wd_forest_ground_m(forest, x_m, y_m);
        assert_true(wd_forest_water_m(suite->forest, x_m, y_m) == -(double)INFINITY);
        assert_true(wd_forest_water_m(forest, x_m, y_m) == (ground_m < 12 ? 12 : -(double)INFINITY));
        under += ground_m < 12;
        open += ground_m > 12;
    }
    assert_true(under > 0 && open > 0);
    wd_forest_destroy(&forest);
}

static void the_library_tells_its_version(void **state)
{
    (void)state;
    int major, minor, patch, length = 0;
    assert_int_equal(sscanf(wd_version(), "%d.%d.%d%n", &major, &minor, &patch, &length), 3);
    assert_int_equal(wd_version()[length], '\0');
}

static void there_is_nothing_beyond_the_last(void **state)
{
    struct suite *suite = *state;
    struct wd_forest_info info;
    struct wd_tree_info tree;
    struct wd_species_info species;
    struct wd_inventory_info inventory;
    wd_forest_get_info(suite->forest, &info);
    assert_false(wd_forest_get_tree(suite->forest, 0, &tree));
    assert_false(wd_forest_get_tree(suite->forest, (uint32_t)info.tree_count + 1, &tree));
    assert_false(wd_forest_get_species(suite->forest, 2, &species));
    assert_false(wd_forest_get_inventory(suite->forest, 0, &inventory));
    assert_null(wd_forest_camera_name(suite->forest, 2));
    assert_null(wd_forest_path_name(suite->forest, 1));
}

static void cameras_and_paths_go_by_name(void **state)
{
    struct suite *suite = *state;
    struct wd_camera camera, first;
    double duration_s;
    assert_string_equal(wd_forest_camera_name(suite->forest, 1), "walk");
    assert_int_equal(wd_forest_get_camera(suite->forest, NULL, &first), WD_OK);
    assert_int_equal(wd_forest_get_camera(suite->forest, "over", &camera), WD_OK);
    assert_memory_equal(&camera, &first, sizeof camera);
    assert_true(fabs(camera.yaw_rad) < 1e-9 && camera.pitch_rad < -0.1);
    assert_int_equal(wd_forest_get_path_camera(suite->forest, "fly", 99, &camera, &duration_s), WD_OK);
    assert_true(duration_s == 4.0 && fabs(camera.position_m[1]) < 1e-9);
    assert_true(fabs(camera.yaw_rad - 20.0 / 57.29577951308232) < 1e-9);
}

/* Zooming in and out again, and looking up: curves through such keys would lead beyond what there is. */
static void paths_stay_within_their_keys(void **state)
{
    struct suite *suite = *state;
    const char *const settings[] = {
        "paths=[{\"name\": \"zoom\", \"duration_s\": 3, \"keys\": ["
        "{\"position_m\": [0, 0, 9], \"fov_deg\": 100, \"pitch_deg\": 0},"
        "{\"position_m\": [1, 0, 9], \"fov_deg\": 10, \"pitch_deg\": 89},"
        "{\"position_m\": [2, 0, 9], \"fov_deg\": 10, \"pitch_deg\": 89},"
        "{\"position_m\": [3, 0, 9], \"fov_deg\": 100, \"pitch_deg\": 0}]}]", NULL};
    const struct wd_forest_params params = {
        .scene_path = suite->small_path, .settings = settings, .log = suite->log};
    const double degree = 3.14159265358979323846 / 180;
    struct wd_forest *forest;
    struct wd_camera camera;
    assert_int_equal(wd_forest_create(&forest, &params), WD_OK);
    for (int i = 0; i <= 30; i++) {
        assert_int_equal(wd_forest_get_path_camera(forest, "zoom", 0.1 * i, &camera, NULL), WD_OK);
        assert_true(camera.fov_rad > 9.999 * degree && camera.fov_rad < 100.001 * degree);
        assert_true(fabs(camera.pitch_rad) < 90.001 * degree);
    }
    wd_forest_destroy(&forest);
}

static void unknown_cameras_are_named(void **state)
{
    struct suite *suite = *state;
    struct wd_camera camera;
    suite_clear(suite);
    assert_int_equal(wd_forest_get_camera(suite->forest, "wlak", &camera), WD_ERROR_INPUT);
    assert_true(suite_logged(suite, "wlak") && suite_logged(suite, "walk"));
    suite_clear(suite);
    assert_int_equal(wd_forest_get_path_camera(suite->forest, "swim", 0, &camera, NULL), WD_ERROR_INPUT);
    assert_true(suite_logged(suite, "swim") && suite_logged(suite, "fly"));
}

static void seeds_are_whole_numbers(void **state)
{
    struct suite *suite = *state;
    const char *const wrong[] = {"", "-1", " 1", "1x", "0x10", "1.5", "4294967296",
                                 "99999999999999999999999"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        const struct wd_forest_params params = {
            .scene_path = suite->small_path, .seed = wrong[i], .log = suite->log};
        struct wd_forest *forest = suite->forest;
        char quoted[64];
        snprintf(quoted, sizeof quoted, "seed \"%s\"", wrong[i]);
        suite_clear(suite);
        assert_int_equal(wd_forest_create(&forest, &params), WD_ERROR_INPUT);
        assert_null(forest);
        assert_true(suite_logged(suite, quoted));
    }
}

static uint64_t hash_of(struct suite *suite, const char *seed, unsigned threads)
{
    const struct wd_forest_params params = {.scene_path = suite->small_path, .seed = seed,
                                            .threads = threads, .log = suite->log};
    struct wd_forest *forest;
    struct wd_forest_info info;
    assert_int_equal(wd_forest_create(&forest, &params), WD_OK);
    wd_forest_get_info(forest, &info);
    wd_forest_destroy(&forest);
    assert_null(forest);
    return info.hash;
}

static void a_seed_is_a_world(void **state)
{
    struct suite *suite = *state;
    uint64_t own = hash_of(suite, NULL, 1);
    assert_true(own == hash_of(suite, "11", 3));
    assert_true(own != hash_of(suite, "4294967295", 1));
}

static void too_many_trees_are_refused(void **state)
{
    struct suite *suite = *state;
    const struct wd_forest_params params = {
        .scene_path = suite->small_path, .max_trees = 100, .log = suite->log};
    struct wd_forest *forest;
    suite_clear(suite);
    assert_int_equal(wd_forest_create(&forest, &params), WD_ERROR_INPUT);
    assert_true(suite_logged(suite, "100"));
}

/* A list of trees, and what a tree is cut to, in a program that writes numbers with commas. */
static void files_have_points_in_numbers(void **state)
{
    struct suite *suite = *state;
    const char *path = suite_path(suite, "trees.csv");
    char line[256], source[1100];
    const struct wd_specimen_params params = {
        .source = source, .clip = "1.5x0.6x1.8", .log = suite->log};
    struct wd_specimen *specimen;
    locale_t comma = comma_locale();
    snprintf(source, sizeof source, "%s/species/beech.json", suite->root);
    if (!comma) {
        print_message("there is no locale with decimal commas: skipped\n");
        skip();
    }
    locale_t before = uselocale(comma);
    enum wd_result listed = wd_forest_write(suite->forest, path, 0, NULL, &suite->log);
    enum wd_result cut = wd_specimen_create(&specimen, &params);
    uselocale(before);
    freelocale(comma);
    wd_specimen_destroy(&specimen);
    assert_true(listed == WD_OK && cut == WD_OK);
    FILE *file = fopen(path, "r");
    assert_true(fgets(line, sizeof line, file) && fgets(line, sizeof line, file));
    fclose(file);
    unsigned commas = 0;
    for (const char *at = line; *at; at++)
        commas += *at == ',';
    assert_int_equal(commas, 8);
}

/* A forest's file is stopped in each of its stages; neither it nor a temporary of it is left. */
static bool not_at_stage(void *user, const char *stage, uint64_t done, uint64_t total)
{
    (void)done, (void)total;
    return strcmp(stage, user) != 0;
}

static void stopped_exports_leave_nothing(void **state)
{
    struct suite *suite = *state;
    char stages[][24] = {"growing trees", "placing trees", "making ground", "writing trees", "writing the file"};
    char *path = strdup(suite_path(suite, "stopped.glb"));
    for (size_t i = 0; i < sizeof stages / sizeof *stages; i++) {
        const struct wd_progress progress = {not_at_stage, stages[i]};
        assert_int_equal(wd_forest_write(suite->forest, path, 0, &progress, &suite->log), WD_ERROR_INTERRUPTED);
        DIR *folder = opendir(suite->scratch);
        for (struct dirent *entry; (entry = readdir(folder));)
            assert_null(strstr(entry->d_name, "stopped.glb"));
        closedir(folder);
    }
    free(path);
}

int forest_tests(struct suite *suite)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(the_forest_counts_its_trees, suite),
        cmocka_unit_test_prestate(water_stands_over_what_lies_below_its_level, suite),
        cmocka_unit_test(the_library_tells_its_version),
        cmocka_unit_test_prestate(there_is_nothing_beyond_the_last, suite),
        cmocka_unit_test_prestate(cameras_and_paths_go_by_name, suite),
        cmocka_unit_test_prestate(paths_stay_within_their_keys, suite),
        cmocka_unit_test_prestate(unknown_cameras_are_named, suite),
        cmocka_unit_test_prestate(seeds_are_whole_numbers, suite),
        cmocka_unit_test_prestate(a_seed_is_a_world, suite),
        cmocka_unit_test_prestate(too_many_trees_are_refused, suite),
        cmocka_unit_test_prestate(files_have_points_in_numbers, suite),
        cmocka_unit_test_prestate(stopped_exports_leave_nothing, suite),
    };
    return cmocka_run_group_tests_name("forests", tests, NULL, NULL);
}
