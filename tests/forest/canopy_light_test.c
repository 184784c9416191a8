/* Skylight under crowns: open ground, a closed stand, a forest's edge, hills; crowns' own shade. */
#include "planted.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "forest/canopy_light.h"
#include "world/cover.h"

enum { SIDE_M = 240, SPACING_M = 5 };

static struct wd_tree trees[SIDE_M * SIDE_M];
static float heights_m[4];

/* Flat ground of SIDE_M with trees of 20 m and crowns of 6 m, where x_m >= from_m. */
static struct wd_world stand_from(int from_m)
{
    struct wd_world world = {0};
    world.terrain = (struct wd_terrain){.width = 2, .height = 2, .cell_m = SIDE_M,
                                        .height_m = heights_m};
    for (int y = 0; y < SIDE_M; y += SPACING_M)
        for (int x = from_m; x < SIDE_M; x += SPACING_M)
            trees[world.tree_count++] =
                (struct wd_tree){.x_mm = x * 1000 + 2500, .y_mm = y * 1000 + 2500,
                                 .size = 2000u | 600u << 16};
    world.trees = trees;
    wd_cover_init(&world, 1);
    return world;
}

static struct wd_canopy_field field_of(const struct wd_world *world, unsigned threads)
{
    static const struct wd_model model = {.height_m = 20, .crown_base_m = 8};
    static const struct wd_crown_shade shade = {0.8f, 0.8f, 0.2f, 0.5f};
    struct wd_canopy_field field;
    wd_canopy_field_init(&field, &(struct wd_canopy_field_params){
                                     .world = world, .models = &model, .shades = &shade,
                                     .variants = 1, .threads = threads});
    return field;
}

static const float *at(const struct wd_canopy_field *field, double x_m, double y_m)
{
    size_t column = (size_t)(x_m / field->cell_m), row = (size_t)(y_m / field->cell_m);
    return field->quarters[row * field->width + column];
}

static const float *layer_at(const struct wd_canopy_field *field, double x_m, double y_m)
{
    size_t column = (size_t)(x_m / field->cell_m), row = (size_t)(y_m / field->cell_m);
    return field->layer_m[row * field->width + column];
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

/* Trees of one height are a layer from their crowns' base to their tops, herbs below them or not; crowns
 * reach into the next cell; lower trees under higher ones make it deeper. */
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
    assert_float_equal(layer_at(&field, 106, 120)[1], 20, 0.01f);
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
    world.terrain = (struct wd_terrain){.width = SAMPLES, .height = SAMPLES, .cell_m = 4,
                                        .height_m = wall_m, .max_m = 100};
    struct wd_canopy_field field = field_of(&world, 1);
    const float *foot = at(&field, 140, 120), *far = at(&field, 20, 120);
    assert_true(foot[0] < 0.3f && foot[2] > 0.999f);
    assert_true(far[0] > foot[0] && far[0] < 0.95f);
    wd_canopy_field_finish(&field);
    free(world.cover);
}

/* A single level leaf of 2 x 2 m over 20 m: what it hides from above is its area, from the side
 * nothing. */
static void crowns_hide_their_leaves(void **state)
{
    (void)state;
    struct wd_tree_model model = {.height_m = 20, .crown_base_m = 10, .crown_radius_m = 2};
    for (int k = 0; k < 4; k++) {
        const struct wd_tree_vertex vertex = {
            .position_m = {k == 1 || k == 2 ? 1 : -1, k >= 2 ? 1 : -1, 15}};
        wd_tree_mesh_add_vertex(&model.full, &vertex);
    }
    wd_tree_mesh_add_triangle(&model.full, 0, 1, 2);
    wd_tree_mesh_add_triangle(&model.full, 0, 2, 3);
    model.full.min_m[0] = model.full.min_m[1] = -1;
    model.full.max_m[0] = model.full.max_m[1] = 1;
    model.full.min_m[2] = model.full.max_m[2] = 15;
    struct wd_crown_shade shade = wd_crown_shade_of(&model);
    assert_true(shade.above > 0 && shade.above * 3.14159f * 4 <= 4.0f);
    assert_float_equal(shade.side, 0, 1e-6);
    assert_float_equal(shade.stem, 0, 1e-6);
    assert_true(shade.clumped > 0 && shade.clumped <= 1);
    wd_tree_mesh_finish(&model.full);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(open_ground_gets_all),
        cmocka_unit_test(stands_are_dark_and_edges_are_not),
        cmocka_unit_test(layers_are_as_high_as_their_trees),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(hills_hide_their_side),
        cmocka_unit_test(crowns_hide_their_leaves),
    };
    return cmocka_run_group_tests_name("canopy light", tests, NULL, NULL);
}
