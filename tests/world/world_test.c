#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/clock.h"
#include "small_scene.h"
#include "world/world.h"

/* Hash of the scene below. Every compiler, optimisation level and number of threads must give it;
 * it changes only with the placement itself, on purpose. */
static const uint64_t known_hash = UINT64_C(0xccc34e1c06aea0e9);

/* Hills with a grid layer, a Poisson layer and every rule but maps. */
static void make_scene(struct small_scene *small)
{
    small_scene_init(small);
    small_scene_hills(small);
    struct wd_scene_layer *grid = small_scene_layer(small);
    grid->slope_deg[1] = 32.0f;
    grid->slope_fade_deg = 10.0;
    grid->altitude_m[0] = 120.0;
    grid->altitude_m[1] = 360.0;
    grid->altitude_fade_m = 50.0;
    grid->patchiness = 0.5;
    grid->patch_size_m = 120.0;
    small->shares[0][1].share = 2.5;
    struct wd_scene_layer *poisson = small_scene_layer(small);
    poisson->placement = WD_PLACE_POISSON;
    poisson->spacing_m = 25.0;
    poisson->density = 6.5;
    poisson->jitter = 0.6;
}

static void check_tables(const struct wd_world *world, const struct wd_scene *scene)
{
    uint64_t total = 0;
    for (size_t id = 1; id <= world->tree_count; id++)
        assert_int_equal(world->trees[world->tree_of_id[id]].id, id);
    for (size_t i = 0; i < scene->species_file_count; i++)
        total += world->species_counts[i];
    assert_int_equal(total, world->tree_count);
    /* ids follow the order of placement: the first layer's come first */
    for (size_t id = 2; id <= world->tree_count; id++)
        assert_true(world->layer_of_tree[world->tree_of_id[id]] >=
                    world->layer_of_tree[world->tree_of_id[id - 1]]);
    assert_int_equal(world->octree.octants[0].end, world->tree_count);
}

static void test_any_number_of_threads(void **state)
{
    (void)state;
    const unsigned threads[] = {1, 2, 7, 16};
    struct small_scene small;
    make_scene(&small);
    for (int i = 0; i < 4; i++) {
        struct wd_world world;
        const struct wd_world_params params = {.threads = threads[i]};
        assert_true(wd_world_init(&world, &small.scene, &params));
        uint64_t hash = wd_world_hash(&world);
        if (hash != known_hash)
            fail_msg("%u threads: hash %016" PRIx64, threads[i], hash);
        check_tables(&world, &small.scene);
        wd_world_finish(&world);
    }
}

static void test_seed(void **state)
{
    (void)state;
    struct small_scene small;
    make_scene(&small);
    struct wd_world world;
    const struct wd_world_params params = {.seed = 8, .has_seed = true};
    assert_true(wd_world_init(&world, &small.scene, &params));
    assert_int_equal(world.seed, 8);
    assert_true(wd_world_hash(&world) != known_hash);
    uint64_t hash = wd_world_hash(&world);
    wd_world_finish(&world);
    small.scene.seed = 8;
    assert_true(wd_world_init(&world, &small.scene, &(struct wd_world_params){0}));
    assert_true(wd_world_hash(&world) == hash);
    wd_world_finish(&world);
}

static uint64_t hash_on_demand(void (*change)(struct wd_scene_layer *layer))
{
    struct small_scene small;
    struct wd_world world;
    make_scene(&small);
    small.scene.planting = WD_PLANTING_ON_DEMAND;
    change(&small.layers[0]);
    assert_true(wd_world_init(&world, &small.scene, &(struct wd_world_params){0}));
    assert_int_equal(world.demand.count, 1); /* the grid */
    uint64_t hash = wd_world_hash(&world);
    wd_world_finish(&world);
    return hash;
}

/* Each changes one rule. */
static void no_other(struct wd_scene_layer *layer) { (void)layer; }
static void other_altitude(struct wd_scene_layer *layer) { layer->altitude_m[1] = 300.0; }
static void other_slope(struct wd_scene_layer *layer) { layer->slope_deg[1] = 25.0f; }
static void other_jitter(struct wd_scene_layer *layer) { layer->jitter = 0.5; }
static void other_aspect(struct wd_scene_layer *layer) { layer->aspect[1] = 1.5f; }
static void other_tint(struct wd_scene_layer *layer) { layer->tint = 0.25; }
static void other_groves(struct wd_scene_layer *layer) { layer->patch_size_m = 90.0; }

/* None of its trees is there to be hashed. */
static void test_rules_on_demand(void **state)
{
    (void)state;
    void (*const changes[])(struct wd_scene_layer *) = {
        no_other, other_altitude, other_slope, other_jitter, other_aspect, other_tint, other_groves};
    enum { CHANGES = sizeof changes / sizeof *changes };
    uint64_t hashes[CHANGES];
    for (int i = 0; i < CHANGES; i++) {
        hashes[i] = hash_on_demand(changes[i]);
        for (int k = 0; k < i; k++)
            assert_true(hashes[i] != hashes[k]);
        assert_true(hash_on_demand(changes[i]) == hashes[i]);
    }
}

static void test_empty(void **state)
{
    (void)state;
    struct small_scene small;
    small_scene_init(&small);
    struct wd_world world;
    assert_true(wd_world_init(&world, &small.scene, &(struct wd_world_params){0}));
    assert_int_equal(world.tree_count, 0);
    assert_int_equal(world.octree.count, 0);
    assert_true(world.cover_width >= 100 && world.cover_height >= 75);
    for (uint32_t i = 0; i < world.cover_width * world.cover_height; i++)
        assert_int_equal(world.cover[i], 0);
    wd_world_hash(&world);
    wd_world_finish(&world);
    wd_world_finish(&world);
}

/* Oaks of a layer that fades, spruces of one that does not: the ground is to have the oaks' colour, as far as they cover it. */
static void test_far_sward(void **state)
{
    (void)state;
    struct small_scene small;
    small_scene_init(&small);
    small.species[0].leaf.color[0] = 0.5f;
    small.species[0].leaf.transmittance[0] = 0.25f; /* a quarter is absorbed */
    small.species[1].leaf.color[0] = 0.9f;
    for (int i = 0; i < 2; i++) {
        struct wd_scene_layer *layer = small_scene_layer(&small);
        layer->species += i;
        layer->species_count = 1;
        layer->height_m[0] = layer->height_m[1] = 1.0f;
        layer->fade_far_m[0] = i ? 0 : 30;
        layer->fade_far_m[1] = i ? 0 : 60;
    }
    struct wd_world world;
    assert_true(wd_world_init(&world, &small.scene, &(struct wd_world_params){0}));
    assert_true(world.tree_count > 1000);
    double areas[2] = {0};
    for (size_t i = 0; i < world.tree_count; i++)
        areas[world.layer_of_tree[i]] += pow(world.trees[i].size >> 16, 2);
    assert_true(areas[0] > 0 && areas[1] > 0);
    assert_float_equal(world.far_sward.share, areas[0] / (areas[0] + areas[1]), 1e-6);
    assert_float_equal(world.far_sward.albedo[0], 1.0 / 3, 1e-5); /* (1 - sqrt 1/4) / (1 + sqrt 1/4) */
    assert_float_equal(world.far_sward.albedo[1], 0, 1e-6);
    assert_float_equal(world.far_sward.fade_m[0], 30, 0);
    assert_float_equal(world.far_sward.fade_m[1], 60, 0);
    wd_world_finish(&world);
    small.layers[0].fade_far_m[1] = 0;
    assert_true(wd_world_init(&world, &small.scene, &(struct wd_world_params){0}));
    assert_float_equal(world.far_sward.share, 0, 0);
    assert_float_equal(world.far_sward.fade_m[1], 0, 0);
    wd_world_finish(&world);
}

/* One tree with a wide crown in the middle: the cover is its disc. */
static void test_cover(void **state)
{
    (void)state;
    struct small_scene small;
    small_scene_init(&small);
    struct wd_scene_layer *layer = small_scene_layer(&small);
    layer->spacing_m = 400.0;
    layer->jitter = 0.0;
    layer->aspect[0] = layer->aspect[1] = 8.0f;
    small.scene.terrain.size_m[1] = 400.0;
    struct wd_world world;
    assert_true(wd_world_init(&world, &small.scene, &(struct wd_world_params){0}));
    assert_int_equal(world.tree_count, 1);
    double radius_m = (world.trees[0].size >> 16) * 0.005, covered_m2 = 0.0;
    for (uint32_t j = 0; j < world.cover_height; j++)
        for (uint32_t i = 0; i < world.cover_width; i++) {
            double x_m = (i + 0.5) * world.cover_cell_m - 200.0;
            double y_m = (j + 0.5) * world.cover_cell_m - 200.0;
            double far_m = radius_m + world.cover_cell_m;
            uint8_t cover = world.cover[j * world.cover_width + i];
            if (x_m * x_m + y_m * y_m > far_m * far_m)
                assert_int_equal(cover, 0);
            covered_m2 += cover / 255.0 * world.cover_cell_m * world.cover_cell_m;
        }
    double disc_m2 = 3.14159265 * radius_m * radius_m;
    assert_true(covered_m2 > 0.95 * disc_m2 && covered_m2 < 1.05 * disc_m2);
    wd_world_finish(&world);
}

static void test_dense_cover(void **state)
{
    (void)state;
    struct small_scene small;
    small_scene_init(&small);
    small_scene_layer(&small)->spacing_m = 2.0; /* crowns of some 4 m */
    struct wd_world world;
    assert_true(wd_world_init(&world, &small.scene, &(struct wd_world_params){0}));
    double sum = 0.0;
    for (uint32_t j = 2; j < 73; j++)
        for (uint32_t i = 2; i < 98; i++)
            sum += world.cover[j * world.cover_width + i];
    assert_true(sum / (71 * 96) > 230.0);
    wd_world_finish(&world);
}

static bool stop_at(void *user, const char *stage, uint64_t done, uint64_t total)
{
    (void)stage;
    assert_true(done <= total);
    return --*(int *)user > 0;
}

/* Stopped at any report, nothing is left. */
static void test_interruption(void **state)
{
    (void)state;
    struct small_scene small;
    make_scene(&small);
    bool made = false;
    for (int reports = 1; !made; reports++) {
        int left = reports;
        const struct wd_progress progress = {stop_at, &left};
        const struct wd_world_params params = {.progress = &progress, .threads = 2};
        struct wd_world world;
        made = wd_world_init(&world, &small.scene, &params);
        if (!made) {
            const struct wd_world nothing = {0};
            assert_memory_equal(&world, &nothing, sizeof world);
        }
        wd_world_finish(&world);
        assert_in_range(reports, 1, 10000);
    }
}

struct capture {
    char text[2000];
};

static void keep_errors(void *user, enum wd_log_level level, const char *message)
{
    struct capture *capture = user;
    if (level == WD_LOG_ERROR)
        snprintf(capture->text, sizeof capture->text, "%s", message);
}

static void expect_error(const struct small_scene *small, uint64_t max_trees, const char *part)
{
    struct capture capture = {""};
    const struct wd_log sink = {keep_errors, &capture};
    const struct wd_world_params params = {.max_trees = max_trees, .log = &sink};
    struct wd_world world;
    assert_false(wd_world_init(&world, &small->scene, &params));
    if (!strstr(capture.text, part))
        fail_msg("\"%s\" is not in \"%s\"", part, capture.text);
}

static void test_errors(void **state)
{
    (void)state;
    struct small_scene small;
    make_scene(&small);
    expect_error(&small, 1000, "more than 1000 trees");
    small.shares[1][2].name = "elm";
    expect_error(&small, 0, "\"elm\" is not in the scene");
    make_scene(&small);
    small.layers[0].spacing_m = 0.0;
    expect_error(&small, 0, "spacing_m");
    make_scene(&small);
    small.shares[0][0].share = small.shares[0][1].share = small.shares[0][2].share = 0.0;
    expect_error(&small, 0, "share above 0");
    make_scene(&small);
    small.layers[1].placement = WD_PLACE_CANOPY;
    expect_error(&small, 0, "canopy.file");
}

static void test_million(void **state)
{
    (void)state;
    struct small_scene small;
    small_scene_init(&small);
    small.scene.terrain.size_m[0] = small.scene.terrain.size_m[1] = 4000.0;
    small_scene_layer(&small);
    struct wd_world world;
    double start_s = wd_clock_s();
    assert_true(wd_world_init(&world, &small.scene, &(struct wd_world_params){0}));
    print_message("a world of %zu trees: %.3f s\n", world.tree_count, wd_clock_s() - start_s);
    assert_int_equal(world.tree_count, 1000000);
    check_tables(&world, &small.scene);
    wd_world_finish(&world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_any_number_of_threads),
        cmocka_unit_test(test_seed),
        cmocka_unit_test(test_rules_on_demand),
        cmocka_unit_test(test_empty),
        cmocka_unit_test(test_far_sward),
        cmocka_unit_test(test_cover),
        cmocka_unit_test(test_dense_cover),
        cmocka_unit_test(test_interruption),
        cmocka_unit_test(test_errors),
        cmocka_unit_test(test_million),
    };
    return cmocka_run_group_tests_name("world", tests, NULL, NULL);
}
