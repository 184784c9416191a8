#include <math.h>
#include <sched.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <xxhash.h>

#include <cmocka.h>

#include "base/memory.h"
#include "logged.h"
#include "shared/grid.h"
#include "shared/hash.h"
#include "world/placement.h"
#include "world/terrain_parts.h"

static struct logged logged;
static const struct wd_log log_kept = {logged_sink, &logged};

static int forget_log(void **state)
{
    (void)state;
    memset(&logged, 0, sizeof logged);
    return 0;
}

static struct wd_scene hills(double x_m, double y_m, double cell_m, double roughness)
{
    struct wd_scene scene = {.path = ""};
    scene.terrain = (struct wd_scene_terrain){.kind = WD_TERRAIN_DIAMOND_SQUARE,
                                              .size_m = {x_m, y_m}, .cell_m = cell_m,
                                              .roughness = roughness, .nodata = NAN};
    return scene;
}

static struct wd_terrain made(const struct wd_scene *scene, uint32_t seed)
{
    struct wd_terrain terrain;
    assert_true(wd_terrain_init(&terrain, scene, seed, 0, 0, NULL, &log_kept));
    return terrain;
}

static uint64_t hash_of(const struct wd_terrain *terrain)
{
    return XXH64(terrain->height_m, (size_t)terrain->width * terrain->height * sizeof(float), 0);
}

/* A hand-made grid; wd_terrain_finish frees it. */
static struct wd_terrain grid(uint32_t width, uint32_t height, double cell_m, const float *height_m)
{
    struct wd_terrain terrain = {.width = width, .height = height, .cell_m = cell_m};
    terrain.height_m = wd_alloc_array((size_t)width * height, sizeof(float));
    memcpy(terrain.height_m, height_m, (size_t)width * height * sizeof(float));
    return terrain;
}

static void height_lies_on_two_triangles(void **state)
{
    (void)state;
    const float height_m[] = {0, 10, 20, 40}; /* SW, SE, NW, NE */
    struct wd_terrain terrain = grid(2, 2, 10, height_m);
    assert_float_equal(wd_terrain_height(&terrain, 0, 0), 0, 0);
    assert_float_equal(wd_terrain_height(&terrain, 10, 0), 10, 0);
    assert_float_equal(wd_terrain_height(&terrain, 0, 10), 20, 0);
    assert_float_equal(wd_terrain_height(&terrain, 10, 10), 40, 0);
    assert_float_equal(wd_terrain_height(&terrain, 5, 5), 20, 1e-6);
    assert_float_equal(wd_terrain_height(&terrain, 7.5, 2.5), 15, 1e-6);  /* 7.5 + 7.5 */
    assert_float_equal(wd_terrain_height(&terrain, 2.5, 7.5), 20, 1e-6);  /* 15 + 5 */
    assert_float_equal(wd_terrain_height(&terrain, -50, 3), 6, 1e-6);     /* clamped */
    assert_float_equal(wd_terrain_height(&terrain, 99, 99), 40, 0);
    assert_float_equal(wd_terrain_height(&terrain, NAN, 0), 0, 0);
    wd_terrain_finish(&terrain);
}

static float slope_squared(const struct wd_terrain *terrain, double x_m, double y_m)
{
    const struct wd_scene scene = {0};
    const struct wd_placement_params params = {.scene = &scene, .terrain = terrain};
    struct wd_ground_input ground;
    assert_true(wd_ground_input_init(&ground, &params));
    struct wd_ground_place place = wd_ground_locate(&ground, (int32_t)(x_m * 1000), (int32_t)(y_m * 1000));
    return wd_ground_slope_squared(&ground, place);
}

static void slope_is_of_central_differences(void **state)
{
    (void)state;
    float height_m[16];
    for (int k = 0; k < 16; k++)
        height_m[k] = 3 * (k % 4) + 4 * (k / 4);
    struct wd_terrain terrain = grid(4, 4, 10, height_m);
    for (double at = 0; at <= 30; at += 7.5)
        assert_float_equal(slope_squared(&terrain, at, 30 - at), 0.25, 1e-6);
    wd_terrain_finish(&terrain);
}

static void holes_and_outside_are_not_contained(void **state)
{
    (void)state;
    float height_m[9] = {0};
    struct wd_terrain terrain = grid(3, 3, 10, height_m);
    assert_true(wd_terrain_contains(&terrain, 0, 0));
    assert_true(wd_terrain_contains(&terrain, 20, 20));
    assert_false(wd_terrain_contains(&terrain, -0.001, 5));
    assert_false(wd_terrain_contains(&terrain, 5, 20.001));
    assert_false(wd_terrain_contains(&terrain, NAN, 5));
    terrain.hole = wd_alloc_array(9, 1);
    terrain.hole[1] = 1; /* the middle of the south side */
    assert_false(wd_terrain_contains(&terrain, 6, 3)); /* in the triangle below the diagonal */
    assert_true(wd_terrain_contains(&terrain, 3, 6));  /* above it */
    assert_false(wd_terrain_contains(&terrain, 11, 2));
    assert_true(wd_terrain_contains(&terrain, 15, 15));
    wd_terrain_finish(&terrain);
}

static void flat_ground_has_the_size_asked_for(void **state)
{
    (void)state;
    const double sizes[][2] = {{1000, 500}, {281.6352, 281.6352}, {50, 60}, {3, 7}, {1000, 333.3}};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        struct wd_scene scene = {.path = ""};
        scene.terrain.size_m[0] = sizes[i][0];
        scene.terrain.size_m[1] = sizes[i][1];
        scene.terrain.base_m = 12.5;
        struct wd_terrain terrain = made(&scene, 1);
        double slack_m = i == 4 ? 333.3 / 1024 : 1e-9 * sizes[i][0]; /* no common divisor */
        assert_float_equal(wd_terrain_extent_x_m(&terrain), sizes[i][0], slack_m);
        assert_float_equal(wd_terrain_extent_y_m(&terrain), sizes[i][1], slack_m);
        assert_float_equal(wd_terrain_height(&terrain, 1, 2), 12.5, 0);
        assert_float_equal(terrain.min_m, 12.5, 0);
        assert_float_equal(terrain.max_m, 12.5, 0);
        assert_float_equal(slope_squared(&terrain, 1, 2), 0, 0);
        wd_terrain_finish(&terrain);
    }
}

static void hills_are_of_any_size_with_the_relief_asked_for(void **state)
{
    (void)state;
    const double sizes[][3] = {{1000, 700, 4}, {4096, 4096, 4}, {333, 2000, 3}, {10, 10, 10},
                               {5000, 100, 5}};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        struct wd_scene scene = hills(sizes[i][0], sizes[i][1], sizes[i][2], 0.9);
        scene.terrain.relief_m = 250;
        scene.terrain.base_m = 100;
        struct wd_terrain terrain = made(&scene, 7);
        assert_float_equal(wd_terrain_extent_x_m(&terrain), sizes[i][0], 1e-9 * sizes[i][0]);
        assert_float_equal(wd_terrain_extent_y_m(&terrain), sizes[i][1], terrain.cell_m / 2 + 1e-9);
        assert_float_equal(terrain.max_m - terrain.min_m, 250, 1e-3);
        assert_float_equal(terrain.min_m, 100, 1e-3);
        wd_terrain_finish(&terrain);
    }
}

static double relief_of(double size_m, uint32_t seed)
{
    struct wd_scene scene = hills(size_m, size_m, size_m / 64, 0.9);
    struct wd_terrain terrain = made(&scene, seed);
    double relief_m = (double)terrain.max_m - terrain.min_m;
    wd_terrain_finish(&terrain);
    return relief_m;
}

/* R1: x is proportional to the root of the area. Cells are so large that no creep smooths. */
static void natural_relief_grows_with_the_root_of_the_area(void **state)
{
    (void)state;
    double small_m = relief_of(8000, 3), large_m = relief_of(32000, 3);
    assert_true(small_m > 0.02 * 8000 && small_m < 0.2 * 8000);
    assert_float_equal(large_m / small_m, 4, 1e-3);
}

/* Mean of squared second differences over that of first: rough ground has more. */
static double raggedness(double roughness)
{
    struct wd_scene scene = hills(2000, 2000, 40, roughness);
    struct wd_terrain terrain = made(&scene, 5);
    double first = 0, second = 0;
    for (uint32_t j = 0; j < terrain.height; j++) {
        const float *row = terrain.height_m + (size_t)j * terrain.width;
        for (uint32_t i = 1; i + 1 < terrain.width; i++) {
            first += pow(row[i + 1] - row[i - 1], 2);
            second += pow(row[i + 1] - 2 * row[i] + row[i - 1], 2);
        }
    }
    wd_terrain_finish(&terrain);
    return second / first;
}

static void roughness_is_the_y_of_the_seed(void **state)
{
    (void)state;
    double rough = raggedness(0.4), usual = raggedness(0.9), smooth = raggedness(1.5);
    assert_true(rough > 2 * usual && usual > 2 * smooth);
}

/* Creases of diamond-square stand on lattice lines: curvature there must be no greater than
 * between them. */
static void no_creases_on_lattice_lines(void **state)
{
    (void)state;
    struct wd_scene scene = hills(4096, 4096, 32, 1.0);
    double on = 0, off = 0;
    size_t on_count = 0, off_count = 0;
    for (uint32_t seed = 0; seed < 8; seed++) {
        struct wd_terrain terrain = made(&scene, seed);
        for (uint32_t j = 0; j < terrain.height; j++) {
            const float *row = terrain.height_m + (size_t)j * terrain.width;
            for (uint32_t i = 1; i + 1 < terrain.width; i++) {
                double bend = pow(row[i + 1] - 2 * row[i] + row[i - 1], 2);
                bool on_line = i % 32 == 0;
                *(on_line ? &on : &off) += bend;
                *(on_line ? &on_count : &off_count) += 1;
            }
        }
        wd_terrain_finish(&terrain);
    }
    assert_true(on / (double)on_count < 1.3 * off / (double)off_count);
}

static void valley_has_a_flat_floor_and_slopes_on_both_sides(void **state)
{
    (void)state;
    struct wd_scene scene = hills(8000, 8000, 20, 0.95);
    scene.terrain.relief_m = 450;
    scene.terrain.valley = 1;
    for (uint32_t seed = 1; seed < 6; seed++) {
        struct wd_terrain terrain = made(&scene, seed);
        for (uint32_t j = 0; j < terrain.height; j += 20) {
            const float *row = terrain.height_m + (size_t)j * terrain.width;
            uint32_t lowest = 0;
            float west_m = 0, east_m = 0;
            for (uint32_t i = 0; i < terrain.width; i++)
                lowest = row[i] < row[lowest] ? i : lowest;
            for (uint32_t i = 0; i < terrain.width; i++)
                *(i < lowest ? &west_m : &east_m) = fmaxf(i < lowest ? west_m : east_m, row[i]);
            assert_true(lowest > terrain.width / 4 && lowest < terrain.width * 3 / 4);
            assert_true(west_m > row[lowest] + 100 && east_m > row[lowest] + 100);
            assert_true(slope_squared(&terrain, lowest * 20.0, j * 20.0) < 0.05 * 0.05);
        }
        wd_terrain_finish(&terrain);
    }
}

static void same_seed_same_hills(void **state)
{
    (void)state;
    struct wd_scene scene = hills(1500, 1100, 5, 0.85);
    scene.terrain.relief_m = 200;
    scene.terrain.valley = 0.5;
    struct wd_terrain all = made(&scene, 42), other = made(&scene, 43);
    cpu_set_t before, one;
    assert_int_equal(sched_getaffinity(0, sizeof before, &before), 0);
    CPU_ZERO(&one);
    for (int cpu = 0; CPU_COUNT(&one) == 0; cpu++)
        if (CPU_ISSET(cpu, &before))
            CPU_SET(cpu, &one);
    assert_int_equal(sched_setaffinity(0, sizeof one, &one), 0);
    struct wd_terrain single = made(&scene, 42);
    assert_int_equal(sched_setaffinity(0, sizeof before, &before), 0);
    assert_true(hash_of(&all) == hash_of(&single));
    assert_true(hash_of(&all) != hash_of(&other));
    /* Any compiler, any optimisation. */
    assert_true(hash_of(&all) == UINT64_C(0xf507a2e438085525));
    wd_terrain_finish(&all);
    wd_terrain_finish(&other);
    wd_terrain_finish(&single);
}

static void too_many_samples_become_fewer(void **state)
{
    (void)state;
    struct wd_scene scene = hills(1e6, 2e6, 0.5, 0.9);
    struct wd_terrain terrain;
    assert_true(wd_terrain_init(&terrain, &scene, 1, 10000, 0, NULL, &log_kept));
    assert_true((uint64_t)terrain.width * terrain.height <= 10000);
    assert_true((uint64_t)terrain.width * terrain.height > 9000);
    assert_int_equal(logged.warnings, 1);
    wd_terrain_finish(&terrain);
}

static void assert_refused(const struct wd_scene *scene, const char *key)
{
    struct wd_terrain terrain;
    forget_log(NULL);
    assert_false(wd_terrain_init(&terrain, scene, 1, 0, 0, NULL, &log_kept));
    assert_null(terrain.height_m);
    assert_int_equal(logged.errors, 1);
    assert_non_null(strstr(logged.text, key));
}

static void senseless_sizes_are_refused(void **state)
{
    (void)state;
    const double bad[] = {0, -5, NAN, INFINITY};
    for (size_t i = 0; i < 4; i++) {
        struct wd_scene scene = hills(bad[i], 100, 1, 0.9);
        assert_refused(&scene, "terrain.size_m");
        scene.terrain.kind = WD_TERRAIN_FLAT;
        assert_refused(&scene, "terrain.size_m");
        if (i == 0)
            continue;
        scene = hills(100, 100, bad[i], 0.9);
        assert_refused(&scene, "terrain.cell_m");
        scene = hills(100, 100, 1, bad[i]);
        assert_refused(&scene, "terrain.roughness");
        scene = hills(100, 100, 1, 0.9);
        scene.terrain.relief_m = bad[i];
        assert_refused(&scene, "terrain.relief_m");
        scene.terrain.relief_m = 0;
        scene.terrain.valley = bad[i];
        assert_refused(&scene, "terrain.valley");
        scene.terrain.valley = 0;
        scene.terrain.base_m = bad[i];
        if (i > 1)
            assert_refused(&scene, "terrain.base_m");
    }
    struct wd_scene scene = hills(1e9, 0.001, 1, 0.9);
    assert_refused(&scene, "narrower");
    scene.terrain.kind = WD_TERRAIN_FLAT;
    assert_refused(&scene, "narrow");
}

static bool stop(void *user, const char *stage, uint64_t done, uint64_t total)
{
    (void)user;
    (void)stage;
    (void)done;
    (void)total;
    return false;
}

static void can_be_stopped(void **state)
{
    (void)state;
    struct wd_scene scene = hills(100, 100, 1, 0.9);
    const struct wd_progress progress = {stop, NULL};
    struct wd_terrain terrain;
    assert_false(wd_terrain_init(&terrain, &scene, 1, 0, 0, &progress, &log_kept));
    assert_null(terrain.height_m);
}

/* A plane with a third of it missing is filled close to the plane, never beyond its range. */
static void gaps_are_filled_smoothly(void **state)
{
    (void)state;
    enum { SIDE = 90 };
    static float values[SIDE * SIDE];
    for (int k = 0; k < SIDE * SIDE; k++)
        values[k] = 100 + k % SIDE + 0.5f * (k / SIDE);
    for (int j = 30; j < 60; j++)
        for (int i = 30; i < 60; i++)
            values[j * SIDE + i] = NAN;
    values[0] = values[5] = values[SIDE * SIDE - 1] = NAN;
    assert_int_equal(wd_fill_missing(values, SIDE, SIDE), 903);
    double worst = 0, steepest = 0;
    for (int k = 0; k < SIDE * SIDE; k++) {
        worst = fmax(worst, fabs(values[k] - (100 + k % SIDE + 0.5 * (k / SIDE))));
        if (k % SIDE)
            steepest = fmax(steepest, fabs(values[k] - values[k - 1]));
        assert_true(values[k] >= 100 && values[k] <= 100 + 89 * 1.5f);
    }
    assert_true(worst < 4);
    assert_true(steepest < 2.5);
}

static void nothing_known_stays_missing(void **state)
{
    (void)state;
    float values[6] = {NAN, NAN, NAN, NAN, NAN, NAN};
    assert_int_equal(wd_fill_missing(values, 3, 2), 6);
    assert_true(isnan(values[3]));
    values[2] = 8;
    assert_int_equal(wd_fill_missing(values, 3, 2), 5);
    for (int i = 0; i < 6; i++)
        assert_float_equal(values[i], 8, 1e-5);
}

static void smooth_sampling_is_exact_and_never_overshoots(void **state)
{
    (void)state;
    float values[36];
    for (uint32_t k = 0; k < 36; k++)
        values[k] = k % 6 < 3 ? 0 : 100; /* a cliff */
    for (uint32_t k = 0; k < 36; k++)
        assert_float_equal(wd_sample_smooth(values, 6, 6, k % 6, k / 6), values[k], 0);
    for (double u = -1; u < 7; u += 0.05) {
        float height = wd_sample_smooth(values, 6, 6, u, 2.3);
        assert_true(height >= 0 && height <= 100);
    }
    for (uint32_t k = 0; k < 36; k++)
        values[k] = 2 * (k % 6) + 3 * (k / 6);
    assert_float_equal(wd_sample_smooth(values, 6, 6, 2.37, 3.61), 2 * 2.37 + 3 * 3.61, 1e-5);
}

/* 64 x 64 buckets over hashes of neighbouring cells: chi-square near its degrees of freedom. */
static void hash_is_even_and_uncorrelated(void **state)
{
    (void)state;
    enum { SIDE = 512, BUCKETS = 64 };
    static uint32_t counts[BUCKETS * BUCKETS];
    memset(counts, 0, sizeof counts);
    for (uint32_t j = 0; j < SIDE; j++)
        for (uint32_t i = 0; i < SIDE; i++) {
            float here = wd_hash_unit(wd_hash3(9, i, j));
            float next = wd_hash_unit(wd_hash3(9, i + 1, j));
            assert_true(here >= 0 && here < 1);
            counts[(int)(here * BUCKETS) * BUCKETS + (int)(next * BUCKETS)]++;
        }
    double expected = (double)SIDE * SIDE / (BUCKETS * BUCKETS), chi = 0;
    for (int k = 0; k < BUCKETS * BUCKETS; k++)
        chi += pow(counts[k] - expected, 2) / expected;
    double freedom = BUCKETS * BUCKETS - 1;
    assert_true(fabs(chi - freedom) < 6 * sqrt(2 * freedom));
    assert_float_equal(wd_hash_unit(0xffffffffu), 1 - ldexp(1, -24), 0);
}

/* However many samples there are, a place lies between two of them. */
static void places_lie_between_samples(void **state)
{
    (void)state;
    static const uint32_t counts[] = {2, 3, 1025, 32769, 40001, 1u << 20};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        uint32_t samples = counts[i];
        const float places[] = {-5, 0, 0.5f, 1, (float)(samples - 1), (float)samples, 1e9f};
        for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
            float along = wd_grid_along(places[k], samples);
            uint32_t cell = wd_grid_cell(along, samples);
            assert_true(cell + 1 < samples);
            assert_true(along >= (float)cell && along <= (float)(cell + 1));
            assert_true(along == fminf(fmaxf(places[k], 0), (float)(samples - 1)));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(height_lies_on_two_triangles),
        cmocka_unit_test(slope_is_of_central_differences),
        cmocka_unit_test(holes_and_outside_are_not_contained),
        cmocka_unit_test(flat_ground_has_the_size_asked_for),
        cmocka_unit_test(hills_are_of_any_size_with_the_relief_asked_for),
        cmocka_unit_test(natural_relief_grows_with_the_root_of_the_area),
        cmocka_unit_test(roughness_is_the_y_of_the_seed),
        cmocka_unit_test(no_creases_on_lattice_lines),
        cmocka_unit_test(valley_has_a_flat_floor_and_slopes_on_both_sides),
        cmocka_unit_test(same_seed_same_hills),
        cmocka_unit_test_setup(too_many_samples_become_fewer, forget_log),
        cmocka_unit_test(senseless_sizes_are_refused),
        cmocka_unit_test(can_be_stopped),
        cmocka_unit_test(gaps_are_filled_smoothly),
        cmocka_unit_test(nothing_known_stays_missing),
        cmocka_unit_test(smooth_sampling_is_exact_and_never_overshoots),
        cmocka_unit_test(hash_is_even_and_uncorrelated),
        cmocka_unit_test(places_lie_between_samples),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
