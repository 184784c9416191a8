/* Probability and canopy rasters, through the same reader as any map. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/memory.h"
#include "logged.h"
#include "small_scene.h"
#include "world/world.h"

static const char *const path = "placement_raster_test.asc";

/* An ESRI grid over the flat ground of the small scene, 400 x 300 m; row 0 in the north. */
static void write_grid(uint32_t columns, uint32_t rows,
                       double value(uint32_t column, uint32_t row))
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "ncols %u\nnrows %u\nxllcorner 0\nyllcorner 0\ncellsize %g\nNODATA_value -9999\n",
            columns, rows, 400.0 / columns);
    for (uint32_t row = 0; row < rows; row++)
        for (uint32_t column = 0; column < columns; column++)
            fprintf(file, "%g%c", value(column, row), column + 1 < columns ? ' ' : '\n');
    assert_int_equal(fclose(file), 0);
}

static void open_world(struct small_scene *small, struct wd_world *world)
{
    small->scene.path = NULL;
    assert_true(wd_world_init(world, &small->scene, &(struct wd_world_params){0}));
}

/* Rows from north to south: water (11), forest (41), farm (81), no data. */
static double land_cover(uint32_t column, uint32_t row)
{
    (void)column;
    static const double classes[] = {11, 41, 81, -9999};
    return classes[row / 3];
}

static void test_classes(void **state)
{
    (void)state;
    static int64_t classes[] = {41, 81};
    static double density[] = {1.0, 0.25};
    struct small_scene small;
    struct wd_world world;
    small_scene_init(&small);
    struct wd_scene_layer *layer = small_scene_layer(&small);
    layer->map.file = path;
    layer->map.crs = "local";
    layer->map.classes = classes;
    layer->map.class_count = 2;
    layer->map.class_density = density;
    layer->map.class_density_count = 2;
    write_grid(16, 12, land_cover);
    open_world(&small, &world);
    unsigned forest = 0, farm = 0;
    for (size_t i = 0; i < world.tree_count; i++) {
        assert_true(world.trees[i].y_mm >= 75000 && world.trees[i].y_mm <= 225000);
        forest += world.trees[i].y_mm >= 150000;
        farm += world.trees[i].y_mm < 150000;
    }
    /* 75 of 300 m in cells of 4 m: some cells lie across the edges */
    assert_in_range(forest, 1800, 1950);
    assert_in_range(farm, 400, 540);
    wd_world_finish(&world);
}

/* From 0 in the west to 200 in the east. */
static double slanted(uint32_t column, uint32_t row)
{
    (void)row;
    return (column + 0.5) * 200.0 / 16.0;
}

static void test_values(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world world;
    small_scene_init(&small);
    struct wd_scene_layer *layer = small_scene_layer(&small);
    layer->map.file = path;
    layer->map.crs = "local";
    layer->map.value_range[0] = 150.0f; /* falls: dense in the west */
    layer->map.value_range[1] = 50.0f;
    write_grid(16, 12, slanted);
    open_world(&small, &world);
    unsigned quarters[4] = {0};
    for (size_t i = 0; i < world.tree_count; i++)
        quarters[world.trees[i].x_mm * 4 / 400001]++;
    assert_in_range(quarters[0], 1830, 1875);
    assert_in_range(quarters[1], 1300, 1510); /* three quarters of 1875 */
    assert_in_range(quarters[2], 380, 560);
    assert_in_range(quarters[3], 0, 30);
    wd_world_finish(&world);
}

/* The hash of a world knows the maps of layers that are planted on demand. */
static void test_hash_on_demand(void **state)
{
    (void)state;
    uint64_t hashes[2];
    for (int i = 0; i < 2; i++) {
        struct small_scene small;
        struct wd_world world;
        small_scene_init(&small);
        small.scene.planting = WD_PLANTING_ON_DEMAND;
        struct wd_scene_layer *layer = small_scene_layer(&small);
        layer->map.file = path;
        layer->map.crs = "local";
        layer->map.value_range[1] = 200.0f;
        write_grid(16, 12, i ? land_cover : slanted);
        open_world(&small, &world);
        assert_int_equal(world.demand.count, 1);
        hashes[i] = wd_world_hash(&world);
        wd_world_finish(&world);
    }
    assert_true(hashes[0] != hashes[1]);
}

/* Three round crowns on grass of 0.5 m. */
static const double peaks[3][3] = {{100, 150, 30}, {110, 150, 22}, {300, 60, 12}};
static double canopy(uint32_t column, uint32_t row)
{
    double x_m = column + 0.5, y_m = 300.0 - row - 0.5, height_m = 0.5;
    for (int i = 0; i < 3; i++) {
        double dx = x_m - peaks[i][0], dy = y_m - peaks[i][1];
        height_m = fmax(height_m, peaks[i][2] - 0.5 * (dx * dx + dy * dy));
    }
    return height_m;
}

static void test_canopy(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world world;
    small_scene_init(&small);
    struct wd_scene_layer *layer = small_scene_layer(&small);
    layer->placement = WD_PLACE_CANOPY;
    layer->canopy.file = path;
    layer->canopy.crs = "local";
    layer->canopy.band = 1;
    layer->spacing_m = 3.0;
    layer->jitter = 0.0;
    write_grid(400, 300, canopy);
    open_world(&small, &world);
    assert_int_equal(world.tree_count, 3);
    for (uint32_t id = 1; id <= 3; id++) { /* the highest comes first */
        const struct wd_tree *tree = &world.trees[world.tree_of_id[id]];
        assert_true(fabs(tree->x_mm * 0.001 - peaks[id - 1][0]) <= 0.51);
        assert_true(fabs(tree->y_mm * 0.001 - peaks[id - 1][1]) <= 0.51);
        assert_true(fabs((tree->size & 0xffff) - (peaks[id - 1][2] - 0.25) * 100.0) <= 1.0);
        assert_int_equal(tree->z_mm, 100000);
    }
    wd_world_finish(&world);

    layer->spacing_m = 12.0; /* the second is 10 m from the first */
    open_world(&small, &world);
    assert_int_equal(world.tree_count, 2);
    wd_world_finish(&world);
}

static double in_decimetres(uint32_t column, uint32_t row)
{
    return 10.0 * canopy(column, row);
}

/* Closed forest of 10 and 20 m with gaps. */
static double dense_in_decimetres(uint32_t column, uint32_t row)
{
    return 100.0 * ((column / 4 + row / 4) % 3);
}

static double above_the_sea(uint32_t column, uint32_t row)
{
    return 400.0 + canopy(column, row);
}

static double with_a_bird(uint32_t column, uint32_t row)
{
    return column == 3 && row == 3 ? 130.0 : canopy(column, row);
}

static double of_grass(uint32_t column, uint32_t row)
{
    return 0.01 * (column + row) / 7.0;
}

/* What is said of a canopy is said by a check, too. */
static void test_heights_of_no_trees(void **state)
{
    (void)state;
    static const struct {
        double (*height)(uint32_t column, uint32_t row);
        int errors, warnings;
        size_t trees;
        const char *said;
    } cases[] = {
        {canopy, 0, 0, 3, "layer: 3 trees"},
        {in_decimetres, 0, 1, 3, "of its cells from 2 m up are over 120 m, up to 297.5 m, and no tree is."},
        {dense_in_decimetres, 1, 0, 0, ": 50 % of its cells from 2 m up are over 120 m, up to 200 m, and no tree is."},
        {above_the_sea, 1, 0, 0, "placement_raster_test.asc: 100 % of its cells from 2 m up are over 120 m"},
        {with_a_bird, 0, 1, 3, "are over 120 m, up to 130 m"},
        {of_grass, 0, 1, 0, "has no top of 2 to 120 m on the terrain: no tree stands; its heights are 0 to 0.9971 m"},
    };
    for (size_t i = 0; i < 2 * (sizeof cases / sizeof *cases); i++) {
        bool check = i % 2;
        struct small_scene small;
        struct wd_world world;
        struct logged logged = {0};
        const struct wd_log log = {logged_sink, &logged};
        const struct wd_world_params params = {.log = &log};
        small_scene_init(&small);
        struct wd_scene_layer *layer = small_scene_layer(&small);
        layer->placement = WD_PLACE_CANOPY;
        layer->canopy = (struct wd_scene_map){.file = path, .crs = "local", .band = 1};
        write_grid(400, 300, cases[i / 2].height);
        small.scene.path = NULL;
        bool ok = check ? wd_world_check(&world, &small.scene, &params) : wd_world_init(&world, &small.scene, &params);
        if (ok != !cases[i / 2].errors || (!strstr(logged.text, cases[i / 2].said) && (!check || i > 1)))
            fail_msg("\"%s\" does not say \"%s\"", logged.text, cases[i / 2].said);
        assert_true(logged.errors == cases[i / 2].errors && logged.warnings == cases[i / 2].warnings);
        assert_true(!ok || check || world.tree_count == cases[i / 2].trees);
        if (ok)
            wd_world_finish(&world);
    }
}

/* Tops that the scene's own rules leave out are counted. */
static void test_tops_left_out(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world world;
    struct logged logged = {0};
    const struct wd_log log = {logged_sink, &logged};
    small_scene_init(&small);
    struct wd_scene_layer *layer = small_scene_layer(&small);
    layer->placement = WD_PLACE_CANOPY;
    layer->canopy = (struct wd_scene_map){.file = path, .crs = "local", .band = 1};
    layer->altitude_m[0] = 200.0; /* the ground lies at 100 m */
    write_grid(400, 300, canopy);
    small.scene.path = NULL;
    assert_true(wd_world_init(&world, &small.scene, &(struct wd_world_params){.log = &log}));
    assert_int_equal(world.tree_count, 0);
    assert_non_null(strstr(logged.text, "layer: 3 of 3 tops left out by the layer's rules"));
    wd_world_finish(&world);
}

/* Tree tops of the lidar data against those that ForestTools found in it. */
static void test_quesnel_canopy(void **state)
{
    (void)state;
    char *file = wd_format("%s/terrain/quesnel_chm_2m_utm10n.tif", WD_TEST_DATA);
    if (access(file, R_OK) != 0) {
        print_message("%s is not here: skipped\n", file);
        free(file);
        skip();
    }
    struct small_scene small;
    struct wd_world world;
    small_scene_init(&small);
    small.scene.terrain.size_m[0] = 1492.0;
    small.scene.terrain.size_m[1] = 1316.0;
    struct wd_scene_layer *layer = small_scene_layer(&small);
    layer->placement = WD_PLACE_CANOPY;
    layer->canopy.file = file;
    layer->canopy.crs = "local";
    layer->canopy.band = 1;
    layer->spacing_m = 2.0;
    open_world(&small, &world);
    print_message("quesnel: %zu tops, ForestTools found 24465 trees\n", world.tree_count);
    assert_in_range(world.tree_count, 18000, 32000);
    wd_world_finish(&world);
    free(file);
}

/* Nothing grows by such a map, which is said; the layer, which has no name, is called once. */
static void test_map_of_nothing(void **state)
{
    (void)state;
    static int64_t classes[] = {777};
    struct small_scene small;
    struct wd_world world;
    struct logged logged = {0};
    const struct wd_log log = {logged_sink, &logged};
    small_scene_init(&small);
    struct wd_scene_layer *layer = small_scene_layer(&small);
    layer->name = "layer 1"; /* as the scene calls it */
    layer->map.file = path;
    layer->map.crs = "local";
    layer->map.classes = classes;
    layer->map.class_count = 1;
    write_grid(16, 12, land_cover);
    small.scene.path = NULL;
    assert_true(wd_world_init(&world, &small.scene, &(struct wd_world_params){.log = &log}));
    assert_true(world.tree_count == 0 && logged.warnings == 1);
    assert_non_null(strstr(logged.text, "layer 1: placement_raster_test.asc has no pixel on the terrain that is of"));
    assert_null(strstr(logged.text, "layer layer"));
    wd_world_finish(&world);
}

static void test_missing_map(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world world;
    small_scene_init(&small);
    small.scene.path = NULL;
    small_scene_layer(&small)->map.file = "no_such_map.tif";
    assert_false(wd_world_init(&world, &small.scene, &(struct wd_world_params){0}));
}

static int remove_file(void **state)
{
    (void)state;
    unlink(path);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_classes),
        cmocka_unit_test(test_values),
        cmocka_unit_test(test_hash_on_demand),
        cmocka_unit_test(test_canopy),
        cmocka_unit_test(test_heights_of_no_trees),
        cmocka_unit_test(test_tops_left_out),
        cmocka_unit_test(test_quesnel_canopy),
        cmocka_unit_test(test_map_of_nothing),
        cmocka_unit_test(test_missing_map),
    };
    return cmocka_run_group_tests_name("placement-raster", tests, NULL, remove_file);
}
