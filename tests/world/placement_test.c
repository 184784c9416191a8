#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "small_scene.h"
#include "world/placement.h"

/* Terrain and one prepared layer of a small scene. */
struct stage {
    struct small_scene small;
    struct wd_terrain terrain;
    struct wd_placement_params params;
    struct wd_placement placement;
    struct wd_tree_list list;
};

static void stage_open(struct stage *stage)
{
    struct wd_scene *scene = &stage->small.scene;
    assert_true(wd_terrain_init(&stage->terrain, scene, 7, 0, 0, NULL, NULL));
    stage->params = (struct wd_placement_params){
        .scene = scene, .terrain = &stage->terrain, .seed = 7, .threads = 1, .max_trees = 100000000};
    assert_true(wd_placement_init(&stage->placement, &stage->params, 0));
}

static void stage_close(struct stage *stage)
{
    wd_tree_list_finish(&stage->list);
    wd_placement_finish(&stage->placement);
    wd_terrain_finish(&stage->terrain);
}

static void stage_plant(struct stage *stage)
{
    stage_open(stage);
    assert_true(wd_placement_fill(&stage->placement, &stage->params, &stage->list));
}

static void test_one_tree_a_cell(void **state)
{
    (void)state;
    struct stage stage = {0};
    small_scene_init(&stage.small);
    struct wd_scene_layer *layer = small_scene_layer(&stage.small);
    layer->jitter = 0.8;
    stage_plant(&stage);
    assert_int_equal(stage.list.count, 100 * 75);
    uint8_t *planted = wd_alloc(100 * 75);
    for (size_t i = 0; i < stage.list.count; i++) {
        const struct wd_tree *tree = &stage.list.trees[i];
        int32_t x = tree->x_mm % 4000, y = tree->y_mm % 4000;
        assert_int_equal(tree->id, i + 1);
        assert_in_range(x, 400, 3600);
        assert_in_range(y, 400, 3600);
        assert_int_equal(tree->z_mm, 100000);
        assert_int_equal(planted[tree->y_mm / 4000 * 100 + tree->x_mm / 4000]++, 0);
    }
    free(planted);
    stage_close(&stage);
}

/* Positions within the cell are even: no bin of 10 x 10 strays by more than 5 sigma. */
static void test_jitter_is_even(void **state)
{
    (void)state;
    struct stage stage = {0};
    small_scene_init(&stage.small);
    stage.small.scene.terrain.size_m[0] = stage.small.scene.terrain.size_m[1] = 1600.0;
    small_scene_layer(&stage.small);
    stage_plant(&stage);
    unsigned bins[100] = {0};
    for (size_t i = 0; i < stage.list.count; i++)
        bins[stage.list.trees[i].y_mm % 4000 / 400 * 10 + stage.list.trees[i].x_mm % 4000 / 400]++;
    double mean = (double)stage.list.count / 100.0;
    for (int i = 0; i < 100; i++)
        assert_true(fabs(bins[i] - mean) < 5.0 * sqrt(mean));
    stage_close(&stage);
}

static void test_shares_are_exact(void **state)
{
    (void)state;
    struct stage stage = {0};
    small_scene_init(&stage.small);
    small_scene_layer(&stage.small);
    stage.small.shares[0][0].share = 1.0;
    stage.small.shares[0][1].share = 0.0;
    stage.small.shares[0][2].share = 3.0;
    stage_open(&stage);
    const uint32_t *picks = stage.placement.table + stage.placement.input.layer.pick_first;
    assert_int_equal(stage.placement.input.layer.pick_size, 2); /* a share of 0 never comes */
    assert_int_equal(picks[WD_PICK_THRESHOLD], 0x40000000);
    assert_int_equal(picks[WD_PICK_SPECIES], 0);
    assert_int_equal(picks[WD_PLACE_PICK_WORDS + WD_PICK_SPECIES], 2);
    assert_true(wd_placement_fill(&stage.placement, &stage.params, &stage.list));
    double first = 0.0, count = (double)stage.list.count;
    for (size_t i = 0; i < stage.list.count; i++)
        first += WD_TREE_SPECIES(stage.list.trees[i]) == 0;
    assert_true(fabs(first / count - 0.25) < 5.0 * sqrt(0.25 * 0.75 / count));
    stage_close(&stage);
}

/* One layer's trees do not depend on what other layers there are (row I3). */
static void test_layers_do_not_shadow(void **state)
{
    (void)state;
    struct stage alone = {0}, beside = {0};
    small_scene_init(&alone.small);
    small_scene_init(&beside.small);
    small_scene_layer(&alone.small)->density = 0.3;
    small_scene_layer(&beside.small)->density = 0.3;
    small_scene_layer(&beside.small)->spacing_m = 3.0;
    stage_plant(&alone);
    stage_plant(&beside);
    assert_int_equal(alone.list.count, beside.list.count);
    assert_memory_equal(alone.list.trees, beside.list.trees,
                        alone.list.count * sizeof *alone.list.trees);
    double share = (double)alone.list.count / 7500.0;
    assert_true(fabs(share - 0.3) < 5.0 * sqrt(0.3 * 0.7 / 7500.0));
    stage_close(&alone);
    stage_close(&beside);
}

static void test_sizes(void **state)
{
    (void)state;
    struct stage stage = {0};
    small_scene_init(&stage.small);
    struct wd_scene_layer *layer = small_scene_layer(&stage.small);
    layer->aspect[0] = layer->aspect[1] = 1.5f;
    stage_plant(&stage);
    uint32_t least = UINT32_MAX, most = 0;
    for (size_t i = 0; i < stage.list.count; i++) {
        const struct wd_tree *tree = &stage.list.trees[i];
        uint32_t height_cm = tree->size & 0xffff;
        const struct wd_species *species = &stage.small.species[WD_TREE_SPECIES(*tree)];
        double crown_cm = 1.5 * wd_crown_cm(species, height_cm);
        least = height_cm < least ? height_cm : least;
        most = height_cm > most ? height_cm : most;
        if (i < 200) /* the table's steps cost less than a centimetre or a percent */
            assert_true(fabs((tree->size >> 16) - crown_cm) < 1.0 + 0.01 * crown_cm);
        assert_true(WD_TREE_VARIANT(*tree) < 6);
        assert_in_range(WD_TREE_TINT(*tree), 64, 192);
    }
    assert_in_range(least, 1000, 1003);
    assert_in_range(most, 1997, 2000);
    stage_close(&stage);
}

static void test_crowns_beyond_the_tables(void **state)
{
    (void)state;
    struct small_scene small;
    small_scene_init(&small);
    const struct wd_species *oak = &small.species[0];
    /* higher than the curve's limit, lower than breast height: in proportion, never absurd */
    assert_true(wd_crown_cm(oak, 6000.0) < 2.5 * wd_crown_cm(oak, 2900.0));
    assert_true(wd_crown_cm(oak, 30.0) < 40.0);
    double before = 0.0;
    for (double height_cm = 10.0; height_cm < 6000.0; height_cm += 10.0) {
        double crown_cm = wd_crown_cm(oak, height_cm);
        assert_true(crown_cm >= before);
        before = crown_cm;
    }
}

/* Counts of a Poisson layer have the mean and the variance of the law, and its distribution. */
static void check_poisson(double density, double spread)
{
    struct stage stage = {0};
    small_scene_init(&stage.small);
    stage.small.scene.terrain.size_m[0] = stage.small.scene.terrain.size_m[1] = 2000.0;
    struct wd_scene_layer *layer = small_scene_layer(&stage.small);
    layer->placement = WD_PLACE_POISSON;
    layer->spacing_m = 20.0;
    layer->density = density;
    layer->jitter = spread;
    stage_plant(&stage);
    uint32_t *counts = wd_alloc_array(10000, sizeof *counts);
    for (size_t i = 0; i < stage.list.count; i++)
        counts[stage.list.trees[i].y_mm / 20000 * 100 + stage.list.trees[i].x_mm / 20000]++;
    double mean = (double)stage.list.count / 10000.0, variance = 0.0, empty = 0.0;
    for (int i = 0; i < 10000; i++) {
        variance += (counts[i] - mean) * (counts[i] - mean) / 9999.0;
        empty += counts[i] == 0;
    }
    double none = 10000.0 * exp(-density);
    assert_true(fabs(mean - density) < 5.0 * sqrt(density / 10000.0));
    assert_true(fabs(variance - density) < 0.08 * density);
    assert_true(fabs(empty - none) < 5.0 * sqrt(none) + 1.0);
    free(counts);
    stage_close(&stage);
}

static void test_poisson_counts(void **state)
{
    (void)state;
    check_poisson(0.5, 1.0);
    check_poisson(4.0, 0.7);
    check_poisson(50.0, 1.0);
}

/* Sub-cells of one square are never taken twice, and exactly as many as there are trees. */
static void test_poisson_pattern(void **state)
{
    (void)state;
    for (uint32_t count = 1; count <= 90; count++) {
        struct wd_place_cell cell = {.key = count * 77, .count = count, .side = 1};
        while (cell.side * cell.side < count)
            cell.side++;
        uint32_t from = 0;
        for (uint32_t i = 0; i < count; i++) {
            uint32_t sub_cell = wd_place_sub_cell(cell, from, i);
            assert_true(sub_cell >= from && sub_cell < cell.side * cell.side);
            from = sub_cell + 1;
        }
    }
}

static void test_too_dense(void **state)
{
    (void)state;
    struct stage stage = {0};
    small_scene_init(&stage.small);
    struct wd_scene_layer *layer = small_scene_layer(&stage.small);
    layer->placement = WD_PLACE_POISSON;
    layer->density = 65.0;
    assert_true(wd_terrain_init(&stage.terrain, &stage.small.scene, 7, 0, 0, NULL, NULL));
    stage.params = (struct wd_placement_params){.scene = &stage.small.scene,
                                                .terrain = &stage.terrain};
    assert_false(wd_placement_init(&stage.placement, &stage.params, 0));
    wd_terrain_finish(&stage.terrain);
}

static void test_rules_of_slope_and_altitude(void **state)
{
    (void)state;
    struct stage stage = {0};
    small_scene_init(&stage.small);
    small_scene_hills(&stage.small);
    struct wd_scene_layer *layer = small_scene_layer(&stage.small);
    layer->slope_deg[0] = 5.0f;
    layer->slope_deg[1] = 25.0f;
    layer->slope_fade_deg = 4.0;
    layer->altitude_m[0] = 150.0;
    layer->altitude_m[1] = 300.0;
    layer->altitude_fade_m = 30.0;
    stage_plant(&stage);
    assert_in_range(stage.list.count, 20000, 240000);
    double low = tan(5.0 * 3.14159265 / 180.0), high = tan(25.0 * 3.14159265 / 180.0);
    const struct wd_ground_input *ground = &stage.placement.input.ground;
    for (size_t i = 0; i < stage.list.count; i++) {
        const struct wd_tree *tree = &stage.list.trees[i];
        struct wd_ground_place place = wd_ground_locate(ground, tree->x_mm, tree->y_mm);
        float slope = wd_ground_slope_squared(ground, place);
        assert_true(slope > low * low - 1e-4 && slope < high * high + 1e-4);
        assert_in_range(tree->z_mm, 150000, 300000);
    }
    stage_close(&stage);
}

/* The soft edge: half of the trees stand at half the fade. */
static void test_soft_edge(void **state)
{
    (void)state;
    struct stage stage = {0};
    small_scene_init(&stage.small);
    struct wd_scene_layer *layer = small_scene_layer(&stage.small);
    layer->altitude_m[0] = 95.0;
    layer->altitude_m[1] = 200.0;
    layer->altitude_fade_m = 10.0;
    stage_plant(&stage); /* the ground is at 100 */
    double share = (double)stage.list.count / 7500.0;
    assert_true(fabs(share - 0.5) < 5.0 * sqrt(0.25 / 7500.0));
    stage_close(&stage);
}

static void test_level_ground_needs_no_slope(void **state)
{
    (void)state;
    struct stage stage = {0};
    small_scene_init(&stage.small);
    struct wd_scene_layer *layer = small_scene_layer(&stage.small);
    layer->slope_deg[1] = 30.0f;
    layer->slope_fade_deg = 10.0;
    stage_plant(&stage);
    assert_int_equal(stage.list.count, 7500);
    stage_close(&stage);
}

static void test_patches(void **state)
{
    (void)state;
    struct stage stage = {0};
    small_scene_init(&stage.small);
    stage.small.scene.terrain.size_m[0] = stage.small.scene.terrain.size_m[1] = 2000.0;
    struct wd_scene_layer *layer = small_scene_layer(&stage.small);
    layer->patchiness = 1.0;
    layer->patch_size_m = 100.0;
    stage_plant(&stage);
    /* squares of 20 m: groves are full, clearings empty, and there are many of both */
    unsigned counts[10000] = {0}, full = 0, empty = 0;
    for (size_t i = 0; i < stage.list.count; i++)
        counts[stage.list.trees[i].y_mm / 20000 * 100 + stage.list.trees[i].x_mm / 20000]++;
    for (int i = 0; i < 10000; i++) {
        full += counts[i] >= 24;
        empty += counts[i] <= 1;
    }
    assert_in_range(full, 2000, 6000);
    assert_in_range(empty, 1500, 6000);
    stage_close(&stage);
}

static void test_not_under_water(void **state)
{
    (void)state;
    struct stage stage = {0};
    small_scene_init(&stage.small);
    small_scene_hills(&stage.small);
    small_scene_layer(&stage.small);
    stage.small.scene.water.enabled = true;
    stage.small.scene.water.level_m = 200.0;
    stage_plant(&stage);
    assert_in_range(stage.list.count, 1000, 249000);
    for (size_t i = 0; i < stage.list.count; i++)
        assert_true(stage.list.trees[i].z_mm >= 200000);
    stage_close(&stage);
}

/* On an edge between a hole and ground either side may be meant. */
static bool contains_nearly(const struct wd_terrain *terrain, const struct wd_tree *tree)
{
    double x_m = tree->x_mm * 0.001, y_m = tree->y_mm * 0.001;
    return wd_terrain_contains(terrain, x_m, y_m) ||
           wd_terrain_contains(terrain, x_m + 5e-4, y_m - 5e-4) ||
           wd_terrain_contains(terrain, x_m - 5e-4, y_m + 5e-4) ||
           wd_terrain_contains(terrain, x_m + 5e-4, y_m + 4e-4) ||
           wd_terrain_contains(terrain, x_m - 5e-4, y_m - 4e-4);
}

static void test_not_in_holes(void **state)
{
    (void)state;
    struct stage stage = {0};
    small_scene_init(&stage.small);
    small_scene_hills(&stage.small);
    small_scene_layer(&stage.small);
    assert_true(wd_terrain_init(&stage.terrain, &stage.small.scene, 7, 0, 0, NULL, NULL));
    stage.terrain.hole = wd_alloc((size_t)stage.terrain.width * stage.terrain.height);
    for (uint32_t i = 0; i < stage.terrain.width * stage.terrain.height; i++)
        stage.terrain.hole[i] = wd_hash1(i) % 4 == 0;
    stage.params = (struct wd_placement_params){.scene = &stage.small.scene, .seed = 7,
        .terrain = &stage.terrain, .threads = 1, .max_trees = 100000000};
    assert_true(wd_placement_init(&stage.placement, &stage.params, 0));
    assert_true(wd_placement_fill(&stage.placement, &stage.params, &stage.list));
    assert_in_range(stage.list.count, 50000, 200000);
    for (size_t i = 0; i < stage.list.count; i++)
        assert_true(contains_nearly(&stage.terrain, &stage.list.trees[i]));
    stage_close(&stage);
}

/* Trees stand on the drawn ground: the terrain's own height to a millimetre. */
static void test_on_the_ground(void **state)
{
    (void)state;
    struct stage stage = {0};
    small_scene_init(&stage.small);
    small_scene_hills(&stage.small);
    stage.small.scene.terrain.cell_m = 7.3;
    small_scene_layer(&stage.small);
    stage_plant(&stage);
    assert_true(stage.list.count > 200000);
    for (size_t i = 0; i < stage.list.count; i++) {
        const struct wd_tree *tree = &stage.list.trees[i];
        float height_m = wd_terrain_height(&stage.terrain, tree->x_mm * 0.001, tree->y_mm * 0.001);
        assert_true(fabs(height_m - tree->z_mm * 0.001) < 0.001);
    }
    stage_close(&stage);
}

static void test_axis(void **state)
{
    (void)state;
    const double cells_mm[] = {2.0, 3.0, 999.0, 1000.0, 10149.84, 30000.0, 92123.456, 4.2e7, 1.9e9};
    for (size_t k = 0; k < sizeof cells_mm / sizeof *cells_mm; k++) {
        struct wd_axis axis = wd_axis_of(cells_mm[k]);
        assert_true(axis.shift <= 31);
        for (uint32_t i = 0; i < 20000; i++) {
            uint32_t mm = wd_hash2((uint32_t)k, i) >> 1;
            double cells = wd_axis_cell(axis, mm) + wd_axis_share(axis, mm) / 16777216.0;
            /* a part in 2^31 and one step of the share */
            assert_true(fabs(cells * cells_mm[k] - mm) < mm * 1e-9 + cells_mm[k] * 1.2e-7);
        }
        for (uint32_t i = 0; i < 1000 && i * cells_mm[k] < 2e9; i++)
            if (cells_mm[k] == floor(cells_mm[k]))
                assert_int_equal(wd_axis_cell(axis, (uint32_t)(i * cells_mm[k])), i);
    }
}

static void test_too_many(void **state)
{
    (void)state;
    struct stage stage = {0};
    small_scene_init(&stage.small);
    small_scene_layer(&stage.small);
    stage_open(&stage);
    stage.params.max_trees = 7499;
    assert_false(wd_placement_fill(&stage.placement, &stage.params, &stage.list));
    stage_close(&stage);
}

/* A tree is drawn by a variant about as high as itself; any of them where heights say nothing. */
static void variants_stand_for_heights(void **state)
{
    (void)state;
    uint32_t seen[8] = {0};
    for (uint32_t i = 0; i < 4000; i++) {
        uint32_t random = wd_hash1(i);
        assert_int_equal(wd_place_variant(random, 8, 0, 1000, 800), 0);
        assert_true(wd_place_variant(random, 8, 65535, 1000, 800) >= 6);
        assert_int_equal(wd_place_variant(random, 1, 1400, 1000, 800), 0);
        uint32_t near = wd_place_variant(random, 8, 1450, 1000, 800); /* the middle of the fifth */
        assert_true(near >= 3 && near <= 5);
        seen[near]++;
    }
    assert_true(seen[3] > 800 && seen[4] > 1800 && seen[5] > 800);
    for (uint32_t i = 0; i < 4000; i++)
        seen[wd_place_variant(wd_hash1(i), 8, 1450, 1000, 0)]++;
    for (int i = 0; i < 8; i++)
        assert_true(seen[i] > 350);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_axis),
        cmocka_unit_test(test_one_tree_a_cell),
        cmocka_unit_test(test_jitter_is_even),
        cmocka_unit_test(test_shares_are_exact),
        cmocka_unit_test(test_layers_do_not_shadow),
        cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_crowns_beyond_the_tables),
        cmocka_unit_test(test_poisson_counts),
        cmocka_unit_test(test_poisson_pattern),
        cmocka_unit_test(test_too_dense),
        cmocka_unit_test(test_rules_of_slope_and_altitude),
        cmocka_unit_test(test_soft_edge),
        cmocka_unit_test(test_level_ground_needs_no_slope),
        cmocka_unit_test(test_patches),
        cmocka_unit_test(test_not_under_water),
        cmocka_unit_test(test_not_in_holes),
        cmocka_unit_test(test_on_the_ground),
        cmocka_unit_test(test_too_many),
        cmocka_unit_test(variants_stand_for_heights),
    };
    return cmocka_run_group_tests_name("placement", tests, NULL, NULL);
}
