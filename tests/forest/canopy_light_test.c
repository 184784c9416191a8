/* Skylight under crowns: open ground, a closed stand, a forest's edge, hills; crowns' own shade. */
#include "planted.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "forest/canopy_light.h"
#include "forest/crowns_apart.h"
#include "scene/species.h"
#include "tree/coverage.h"
#include "tree/grow.h"
#include "world/cover.h"

enum { SIDE_M = 240, SPACING_M = 5 };

static struct wd_tree trees[2 * SIDE_M * SIDE_M];
static float heights_m[4];

/* Flat ground of SIDE_M with trees of 20 m and crowns of 6 m, where x_m >= from_m. */
static struct wd_world stand_from(int from_m)
{
    struct wd_world world = {0};
    world.terrain =
        (struct wd_terrain){.width = 2, .height = 2, .cell_m = SIDE_M, .height_m = heights_m};
    for (int y = 0; y < SIDE_M; y += SPACING_M)
        for (int x = from_m; x < SIDE_M; x += SPACING_M)
            trees[world.tree_count++] = (struct wd_tree){
                .x_mm = x * 1000 + 2500, .y_mm = y * 1000 + 2500, .size = 2000u | 600u << 16};
    world.trees = trees;
    wd_cover_init(&world, 1);
    return world;
}

/* Leaves hide 0.8 of the crown's outline from each side. */
static struct wd_model model = {.height_m = 20,
                                .crown_m = 6,
                                .crown_base_m = 8,
                                .roughness = 0.4f,
                                .seen_m2 = {45.2f, 36.2f, 22.6f}};

static struct wd_tree_model stems = {.dbh_m = 0.3f};

static struct wd_canopy_field field_of(const struct wd_world *world, unsigned threads)
{
    struct wd_canopy_field field;
    wd_canopy_field_init(&field,
                         &(struct wd_canopy_field_params){
                             .world = world, .models = &model, .grown = &stems, .variants = 1, .threads = threads});
    return field;
}

/* The nearest cell. */
static size_t cell_at(const struct wd_canopy_field *field, double x_m, double y_m)
{
    double column = floor((x_m - field->from_m[0]) / field->cell_m);
    double row = floor((y_m - field->from_m[1]) / field->cell_m);
    column = fmin(fmax(column, 0), field->width - 1);
    row = fmin(fmax(row, 0), field->height - 1);
    return (size_t)row * field->width + (size_t)column;
}

static const float *at(const struct wd_canopy_field *field, double x_m, double y_m)
{
    return field->quarters[cell_at(field, x_m, y_m)];
}

static const float *layer_at(const struct wd_canopy_field *field, double x_m, double y_m)
{
    return field->layer_m[cell_at(field, x_m, y_m)];
}

static void open_ground_gets_all(void **state)
{
    (void)state;
    struct wd_world world = stand_from(SIDE_M);
    struct wd_canopy_field field = field_of(&world, 1);
    for (size_t i = 0; i < (size_t)field.width * field.height; i++)
        for (int k = 0; k < 4; k++)
            assert_float_equal(field.quarters[i][k], 1, 1e-5);
    wd_canopy_field_finish(&field);
    free(world.cover);
}

/* Upright surfaces in a stand have the less of the sky the lower it is. */
static void low_skies_are_darkest(void **state)
{
    (void)state;
    struct wd_world world = stand_from(0);
    struct wd_canopy_field field = field_of(&world, 1);
    size_t middle = cell_at(&field, 120, 120);
    const float *high = field.high[middle], *low = field.low[middle];
    for (int k = 0; k < 4; k++) {
        assert_true(low[k] < 0.5f * high[k] && high[k] < at(&field, 120, 120)[k]);
        assert_true(low[k] > 0);
    }
    wd_canopy_field_finish(&field);
    free(world.cover);
}

/* Within, little and from all sides alike; at the edge, most from the open side. */
static void stands_are_dark_and_edges_are_not(void **state)
{
    (void)state;
    struct wd_world world = stand_from(SIDE_M / 2);
    struct wd_canopy_field field = field_of(&world, 1);
    const float *within = at(&field, 200, 120), *edge = at(&field, 121, 120);
    const float *before = at(&field, 112, 120), *open = at(&field, 12, 120);
    for (int k = 0; k < 4; k++)
        assert_true(within[k] < 0.35f && within[k] > 0.005f);
    assert_float_equal(within[1], within[3], 0.1f * within[1]); /* north and south */
    assert_true(edge[2] > 1.5f * edge[0]);                      /* west over east */
    assert_true(before[2] > 0.95f && before[0] < 0.8f);
    assert_true(open[0] > 0.9f && open[2] > 0.99f);
    wd_canopy_field_finish(&field);
    free(world.cover);
}

/* Low light comes in below crowns that begin at 8 m, past stems, the less the farther in. */
static void low_light_comes_in_at_edges(void **state)
{
    (void)state;
    struct wd_world world = stand_from(SIDE_M / 2);
    struct wd_canopy_field field = field_of(&world, 1);
    const float *near = field.low[cell_at(&field, 132, 120)], *far = field.low[cell_at(&field, 200, 120)];
    assert_true(near[2] > 0.3f && near[0] < 0.1f); /* west, east */
    assert_true(far[2] < 0.3f * near[2]);
    float between_thin_stems = near[2];
    wd_canopy_field_finish(&field);
    stems.dbh_m = 1.5f;
    field = field_of(&world, 1);
    assert_true(field.low[cell_at(&field, 132, 120)][2] < 0.75f * between_thin_stems);
    stems.dbh_m = 0.3f;
    wd_canopy_field_finish(&field);
    free(world.cover);
}

/* A plot on a wide plain has small cells. */
static void plots_on_plains_are_resolved(void **state)
{
    (void)state;
    struct wd_world world = {.terrain = {.width = 2, .height = 2, .cell_m = 6000, .height_m = heights_m}};
    for (int i = 0; i < 100; i++)
        trees[world.tree_count++] = (struct wd_tree){
            .x_mm = 3000000 + 3000 * (i % 10), .y_mm = 2000000 + 3000 * (i / 10), .size = 1000u | 200u << 16};
    world.trees = trees;
    wd_cover_init(&world, 1);
    struct wd_canopy_field field = field_of(&world, 1);
    assert_true(field.cell_m < 5 && field.width < 50 && field.height < 50);
    assert_true(at(&field, 3013, 2013)[0] < 0.5f);
    assert_true(at(&field, 2980, 2013)[2] > 0.95f);
    wd_canopy_field_finish(&field);
    free(world.cover);
}

/* Trees of one height are a layer from their crowns' base to their tops, herbs below them or not;
 * crowns reach into the next cell; lower trees under higher ones make it deeper. */
static void layers_are_as_high_as_their_trees(void **state)
{
    (void)state;
    struct wd_world world = stand_from(SIDE_M / 2);
    size_t stand = world.tree_count;
    for (size_t i = 0; i < stand; i++, world.tree_count++) {
        trees[world.tree_count] = trees[i];
        trees[world.tree_count].size = 100u | 100u << 16;
    }
    struct wd_canopy_field field = field_of(&world, 1);
    const float *within = layer_at(&field, 200, 120), *open = layer_at(&field, 12, 120);
    assert_float_equal(within[0], 8, 0.01f);
    assert_float_equal(within[1], 20, 0.01f);
    assert_float_equal(layer_at(&field, 110, 120)[1], 20, 0.01f);
    assert_float_equal(open[1], 0, 0);
    wd_canopy_field_finish(&field);
    for (size_t i = stand; i < world.tree_count; i++)
        trees[i].size = 500u | 400u << 16;
    field = field_of(&world, 1);
    assert_true(layer_at(&field, 200, 120)[0] < 4 && layer_at(&field, 200, 120)[1] > 18);
    wd_canopy_field_finish(&field);
    free(world.cover);
}

static void threads_change_nothing(void **state)
{
    (void)state;
    struct wd_world world = stand_from(SIDE_M / 2);
    struct wd_canopy_field one = field_of(&world, 1), three = field_of(&world, 3);
    assert_memory_equal(one.quarters, three.quarters,
                        (size_t)one.width * one.height * sizeof *one.quarters);
    wd_canopy_field_finish(&one);
    wd_canopy_field_finish(&three);
    free(world.cover);
}

/* West of a wall of 100 m nothing comes from the east below its brow. */
static void hills_hide_their_side(void **state)
{
    (void)state;
    enum { SAMPLES = 61 };
    static float wall_m[SAMPLES * SAMPLES];
    for (int i = 0; i < SAMPLES * SAMPLES; i++)
        wall_m[i] = i % SAMPLES > 40 ? 100 : 0;
    struct wd_world world = stand_from(SIDE_M);
    world.terrain = (struct wd_terrain){
        .width = SAMPLES, .height = SAMPLES, .cell_m = 4, .height_m = wall_m, .max_m = 100};
    struct wd_canopy_field field = field_of(&world, 1);
    const float *foot = at(&field, 140, 120), *far = at(&field, 20, 120);
    assert_true(foot[0] < 0.3f && foot[2] > 0.999f);
    size_t cell = cell_at(&field, 140, 120);
    const float *high = field.high[cell], *low = field.low[cell];
    assert_true(low[0] < 1e-6f && low[2] > 0.999f && high[2] > 0.999f); /* nothing of the low sky behind the wall */
    assert_true(high[0] <= foot[0]);
    assert_true(far[0] > foot[0] && far[0] < 0.95f);
    wd_canopy_field_finish(&field);
    free(world.cover);
}

/* Herbs below a stand take nothing of what comes to them, and are told with their height; a sward,
 * which the ground's own openness knows, is not. */
static void herbs_are_apart(void **state)
{
    (void)state;
    struct wd_world world = stand_from(0);
    struct wd_canopy_field stand = field_of(&world, 1);
    size_t cells = (size_t)stand.width * stand.height, middle = cells / 2 + stand.width / 2;
    for (int y = 0; y < SIDE_M; y++)
        for (int x = 0; x < SIDE_M; x++)
            trees[world.tree_count++] = (struct wd_tree){
                .x_mm = x * 1000 + 500, .y_mm = y * 1000 + 500, .size = 60u | 100u << 16};
    struct wd_canopy_field herbs = field_of(&world, 1);
    model.roughness = -0.4f;
    struct wd_canopy_field sward = field_of(&world, 1);
    model.roughness = 0.4f;
    assert_memory_equal(stand.quarters, herbs.quarters, cells * sizeof *stand.quarters);
    assert_memory_equal(stand.layer_m, herbs.layer_m, cells * sizeof *stand.layer_m);
    assert_float_equal(stand.herbs[middle][0], 0, 1e-6);
    assert_float_equal(sward.herbs[middle][0], 0, 1e-6);
    /* one of 1 m across a square metre, of whose outline leaves hide 0.8 */
    assert_float_equal(herbs.herbs[middle][0], 0.8 * 3.14159 / 4, 0.02);
    assert_float_equal(herbs.herbs[middle][1], 0.6, 0.01);
    wd_canopy_field_finish(&stand);
    wd_canopy_field_finish(&herbs);
    wd_canopy_field_finish(&sward);
    free(world.cover);
}

/* Deep in a wide stand, of each of four rings of the sky, the lowest of which the field tells by three, what crowns
 * cover of the area across its rays, and more, the more ground their outlines cover together, stops them by Beer's
 * law; cells of 8 m hold one tree or four of those that stand 5 m apart, in rows that leave next to nothing free: as
 * much as twice the layers would at random. */
static void floors_get_what_crowns_do_not_cover(void **state)
{
    (void)state;
    struct wd_world world = stand_from(0);
    struct wd_canopy_field field = field_of(&world, 1);
    const float *middle = at(&field, 0.5 * SIDE_M, 0.5 * SIDE_M);
    const float *seen = model.seen_m2;
    float wanted = 0, crown_m = WD_TREE_CROWN_M(trees[0]) / SPACING_M;
    float outline = 3.14159f / 4 * crown_m * crown_m, apart = 1.155f + 0.3f * fmaxf(outline - 1.1f, 0);
    apart *= powf(2 / wd_planted_apart(outline), 0.5f);
    for (int ring = 0; ring < 4; ring++) {
        float rise = sqrtf(1 - ((float)ring + 0.5f) / 4);
        float covered =
            wd_seen_m2(seen[0], seen[1], seen[2], rise) / (SPACING_M * SPACING_M * rise);
        wanted += expf(-apart * covered) / 4;
    }
    print_message("%.3f of the sky's light from the east, %.3f by Beer's law\n", (double)middle[0],
                  (double)wanted);
    for (int k = 0; k < 4; k++)
        assert_float_equal(middle[k], wanted, 0.1f * wanted);
    wd_canopy_field_finish(&field);
    free(world.cover);
}

/* A fern is a dozen fronds, each of which spans half of it. */
static void fronds_hide_what_they_span(void **state)
{
    (void)state;
    const struct wd_grow_params params = {.seed = 3, .height_m = 0.8f};
    struct wd_arena arena = {0};
    struct wd_species fern;
    struct wd_tree_model grown;
    assert_true(wd_species_load(&fern, "species/fern.json", &arena, NULL));
    assert_true(wd_tree_grow(&grown, &fern, &params, NULL));
    wd_tree_model_add_leaves(&grown);
    wd_tree_mesh_measure_seen(grown.seen_m2, &grown.full);
    float radius_m = grown.crown_radius_m,
          share = grown.seen_m2[2] / (3.14159f * radius_m * radius_m);
    print_message("a fern hides %.2f of its outline\n", (double)share);
    assert_true(share > 0.3f && share < 1.2f);
    wd_tree_model_drop_leaves(&grown);
    assert_int_equal(grown.full.index_count, grown.full.wood_index_count);
    wd_tree_model_finish(&grown);
    wd_arena_finish(&arena);
}

/* A single level leaf of 2 x 2 m over 15 m: what it hides from above is its area, from the side
 * nothing. */
static void crowns_hide_their_leaves(void **state)
{
    (void)state;
    struct wd_tree_mesh leaf = {0};
    float seen_m2[WD_GAIN_SIDES];
    for (int k = 0; k < 4; k++) {
        const struct wd_tree_vertex vertex = {
            .position_m = {k == 1 || k == 2 ? 1 : -1, k >= 2 ? 1 : -1, 15}};
        wd_tree_mesh_add_vertex(&leaf, &vertex);
    }
    wd_tree_mesh_add_triangle(&leaf, 0, 1, 2);
    wd_tree_mesh_add_triangle(&leaf, 0, 2, 3);
    wd_tree_mesh_update_bounds(&leaf);
    wd_tree_mesh_measure_seen(seen_m2, &leaf);
    assert_float_equal(seen_m2[2], 4, 0.1);
    assert_float_equal(seen_m2[1], 4 * 0.7071, 0.1);
    assert_float_equal(seen_m2[0], 0, 1e-6);
    wd_tree_mesh_finish(&leaf);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(open_ground_gets_all),
        cmocka_unit_test(stands_are_dark_and_edges_are_not),
        cmocka_unit_test(low_light_comes_in_at_edges),
        cmocka_unit_test(plots_on_plains_are_resolved),
        cmocka_unit_test(low_skies_are_darkest),
        cmocka_unit_test(layers_are_as_high_as_their_trees),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(hills_hide_their_side),
        cmocka_unit_test(herbs_are_apart),
        cmocka_unit_test(floors_get_what_crowns_do_not_cover),
        cmocka_unit_test(fronds_hide_what_they_span),
        cmocka_unit_test(crowns_hide_their_leaves),
    };
    return cmocka_run_group_tests_name("canopy light", tests, NULL, NULL);
}
