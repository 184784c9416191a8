/* Waters of a map: where they lie, how high, and that nothing grows in them. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "logged.h"
#include "small_scene.h"
#include "shared/river.h"
#include "world/river.h"
#include "world/world.h"

static const char *const path = "river_test.asc";
static struct logged logged;
static const struct wd_log log_kept = {logged_sink, &logged};

/* Over the ground of the hills, 2 km square, in cells of 10 m; row 0 in the north. */
static void write_map(double value(double x_m, double y_m))
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "ncols 200\nnrows 200\nxllcorner 0\nyllcorner 0\ncellsize 10\n");
    for (int row = 0; row < 200; row++)
        for (int column = 0; column < 200; column++)
            fprintf(file, "%g%c", value(10 * column + 5, 1995 - 10 * row),
                    column < 199 ? ' ' : '\n');
    assert_int_equal(fclose(file), 0);
}

static double winding_m(double y_m)
{
    return 1000 + 150 * sin(y_m / 200);
}

static double river(double x_m, double y_m)
{
    return fabs(x_m - winding_m(y_m)) < 35 ? 1 : 0;
}

static double pond(double x_m, double y_m)
{
    return hypot(x_m - 600, y_m - 1400) < 120 ? 1 : 0;
}

/* Its cells on the shore in part. */
static double soft_pond(double x_m, double y_m)
{
    return fmin(fmax(0.5 + (120 - hypot(x_m - 600, y_m - 1400)) / 10, 0), 1);
}

static double nothing(double x_m, double y_m)
{
    (void)x_m, (void)y_m;
    return 0;
}

static double everything(double x_m, double y_m)
{
    return 1 - nothing(x_m, y_m);
}

static void scene_of(struct small_scene *small, double value(double x_m, double y_m))
{
    small_scene_init(small);
    small_scene_hills(small);
    small->scene.path = NULL;
    small->scene.terrain.valley = 0.8;
    small->scene.water.map = (struct wd_scene_map){
        .file = path, .crs = "local", .band = 1, .value_range = {0, 1}};
    small->scene.water.depth_m = 2;
    write_map(value);
}

static void make(struct wd_terrain *terrain, double value(double x_m, double y_m))
{
    struct small_scene small;
    scene_of(&small, value);
    assert_true(wd_terrain_init(terrain, &small.scene, 7, 0, 0, NULL, NULL));
    assert_true(wd_rivers_init(terrain, &small.scene, &log_kept));
}

static void a_river_falls_with_its_valley_between_its_banks(void **state)
{
    (void)state;
    struct wd_terrain terrain;
    make(&terrain, river);
    float lowest_m = INFINITY, highest_m = -INFINITY;
    bool rises = false, falls = false;
    float before_m = wd_river_level(&terrain, winding_m(100), 100);
    for (double y_m = 100; y_m < 1900; y_m += 20) {
        double x_m = winding_m(y_m);
        float level_m = wd_river_level(&terrain, x_m, y_m);
        assert_true(wd_river_covers(&terrain, x_m, y_m));
        assert_true(level_m - wd_terrain_height(&terrain, x_m, y_m) > 0.5f);
        assert_false(wd_river_covers(&terrain, x_m - 90, y_m));
        assert_false(wd_river_covers(&terrain, x_m + 90, y_m));
        /* level from bank to bank, but for its fall along a bend */
        assert_true(fabsf(wd_river_level(&terrain, x_m - 20, y_m) -
                          wd_river_level(&terrain, x_m + 20, y_m)) < 3);
        rises |= level_m > before_m + 0.02f;
        falls |= level_m < before_m - 0.02f;
        lowest_m = fminf(lowest_m, level_m);
        highest_m = fmaxf(highest_m, level_m);
        before_m = level_m;
    }
    assert_true(highest_m > lowest_m + 1);
    print_message("falls %.1f m, from %.1f m%s\n", (double)(highest_m - lowest_m), (double)highest_m,
                  rises && falls ? ", from both ends" : "");
    wd_terrain_finish(&terrain);
}

static void no_water_stands_above_its_shore(void **state)
{
    (void)state;
    struct wd_terrain terrain;
    make(&terrain, river);
    for (uint32_t j = 2; j + 2 < terrain.height; j++)
        for (uint32_t i = 2; i + 2 < terrain.width; i++) {
            double x_m = i * terrain.cell_m, y_m = j * terrain.cell_m;
            if (fabs(x_m - winding_m(y_m)) > 75)
                assert_false(wd_river_covers(&terrain, x_m, y_m));
        }
    wd_terrain_finish(&terrain);
}

static void a_pond_is_nearly_level(void **state)
{
    (void)state;
    struct wd_terrain terrain;
    struct small_scene small;
    scene_of(&small, pond);
    small.scene.terrain.relief_m = 12;
    assert_true(wd_terrain_init(&terrain, &small.scene, 7, 0, 0, NULL, NULL));
    assert_true(wd_rivers_init(&terrain, &small.scene, &log_kept));
    float middle_m = wd_river_level(&terrain, 600, 1400);
    for (int k = 0; k < 16; k++) {
        double x_m = 600 + 70 * cos(k * 0.3927), y_m = 1400 + 70 * sin(k * 0.3927);
        assert_true(wd_river_covers(&terrain, x_m, y_m));
        assert_true(fabsf(wd_river_level(&terrain, x_m, y_m) - middle_m) < 1);
    }
    assert_false(wd_river_covers(&terrain, 900, 1400));
    assert_float_equal(wd_river_level(&terrain, 1500, 300), WD_NO_WATER_M, 1);
    wd_terrain_finish(&terrain);
}

/* How far from the middle of the pond the water ends. */
static double shore_m(const struct wd_terrain *terrain, double angle)
{
    double from_m = 80, to_m = 160;
    while (to_m - from_m > 0.01) {
        double middle_m = 0.5 * (from_m + to_m);
        if (wd_river_covers(terrain, 600 + middle_m * cos(angle), 1400 + middle_m * sin(angle)))
            from_m = middle_m;
        else
            to_m = middle_m;
    }
    return from_m;
}

/* By wet and dry samples, 10 m apart, it ran 6.8 m beside the map's in root mean square. */
static void a_shore_runs_as_on_the_map(void **state)
{
    (void)state;
    struct wd_terrain terrain;
    make(&terrain, soft_pond);
    double squares = 0, farthest_m = 0;
    for (int k = 0; k < 360; k++) {
        double off_m = shore_m(&terrain, k * 0.0174533) - 120;
        squares += off_m * off_m / 360;
        farthest_m = fmax(farthest_m, fabs(off_m));
    }
    print_message("the shore is %.2f m beside the map's, at most %.2f m\n", sqrt(squares), farthest_m);
    assert_true(sqrt(squares) < 0.4);
    assert_true(farthest_m < 1);
    wd_terrain_finish(&terrain);
}

/* Beside the shore, too, where beds go by the way there. */
static void no_bed_is_dug_deeper_than_asked(void **state)
{
    (void)state;
    const double depths_m[] = {0.1, 0.5, 2};
    for (int k = 0; k < 3; k++) {
        struct wd_terrain terrain, before;
        struct small_scene small;
        scene_of(&small, soft_pond);
        small.scene.water.depth_m = depths_m[k];
        assert_true(wd_terrain_init(&before, &small.scene, 7, 0, 0, NULL, NULL));
        assert_true(wd_terrain_init(&terrain, &small.scene, 7, 0, 0, NULL, NULL));
        assert_true(wd_rivers_init(&terrain, &small.scene, &log_kept));
        size_t count = (size_t)terrain.width * terrain.height, dug = 0;
        for (size_t i = 0; i < count; i++) {
            float bed_m = fminf(before.height_m[i], terrain.water_m[i] - (float)depths_m[k]);
            dug += terrain.height_m[i] < before.height_m[i];
            assert_true(terrain.height_m[i] == before.height_m[i] || terrain.height_m[i] > bed_m - 1e-3f);
        }
        assert_true(dug > 0);
        wd_terrain_finish(&terrain);
        wd_terrain_finish(&before);
    }
}

/* Water that rises or falls a metre in twenty away from an eye 3 m over it, half a metre deep; the eye looks so far down. */
static void check_fall(double rise, double down)
{
    double bed_m = 3.5 / (down + rise), at_m = 3 / (down + rise);
    float end_m = (float)(-down * bed_m), surface_m = (float)(-3 + rise * bed_m);
    double nearer_m = bed_m * (double)wd_river_share(end_m, surface_m);
    float share = wd_river_share_between(end_m, surface_m, (float)(-3 + rise * nearer_m));
    assert_float_equal(share * bed_m, at_m, 0.1 * (bed_m - at_m));
}

/* By the height over the place before, rays to water that falls toward the eye met it as far off as its bed: traced
 * pictures showed dry beds. */
static void rays_meet_water_that_falls_toward_the_eye(void **state)
{
    (void)state;
    check_fall(0.05, 0.03);
    check_fall(0.05, 0.3);
    check_fall(0, 0.03);
    check_fall(-0.005, 0.1);
}

static void trees_keep_out_of_the_water(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world world;
    scene_of(&small, river);
    small_scene_layer(&small)->spacing_m = 8;
    assert_true(wd_world_init(&world, &small.scene, &(struct wd_world_params){0}));
    assert_in_range(world.tree_count, 40000, 62500);
    for (size_t i = 0; i < world.tree_count; i++)
        assert_false(wd_river_covers(&world.terrain, world.trees[i].x_mm * 1e-3,
                                     world.trees[i].y_mm * 1e-3) &&
                     fabs(world.trees[i].x_mm * 1e-3 - winding_m(world.trees[i].y_mm * 1e-3)) < 20);
    wd_world_finish(&world);
}

static void refuse(double value(double x_m, double y_m), const char *part)
{
    struct small_scene small;
    struct wd_terrain terrain;
    scene_of(&small, value);
    memset(&logged, 0, sizeof logged);
    assert_true(wd_terrain_init(&terrain, &small.scene, 7, 0, 0, NULL, NULL));
    assert_false(wd_rivers_init(&terrain, &small.scene, &log_kept));
    assert_int_equal(logged.errors, 1);
    assert_non_null(strstr(logged.text, part));
    wd_terrain_finish(&terrain);
}

static void useless_maps_are_refused(void **state)
{
    (void)state;
    refuse(nothing, "no water");
    refuse(everything, "must stay dry");
}

static int forget(void **state)
{
    (void)state;
    return unlink(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_river_falls_with_its_valley_between_its_banks),
        cmocka_unit_test(no_water_stands_above_its_shore),
        cmocka_unit_test(a_pond_is_nearly_level),
        cmocka_unit_test(rays_meet_water_that_falls_toward_the_eye),
        cmocka_unit_test(a_shore_runs_as_on_the_map),
        cmocka_unit_test(no_bed_is_dug_deeper_than_asked),
        cmocka_unit_test(trees_keep_out_of_the_water),
        cmocka_unit_test(useless_maps_are_refused),
    };
    return cmocka_run_group_tests_name("river", tests, NULL, forget);
}
