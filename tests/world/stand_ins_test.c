#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

#include "inventory_file.h"
#include "world/stand_ins.h"

static const char *const path = "stand_ins_test.csv";

/* Oaks become birches, and these spruces, with so much light. */
static void open_species(struct small_scene *small)
{
    static const float openness[SMALL_SPECIES] = {0.2f, 1, 0.5f}; /* oak, spruce, birch */
    small_scene_init(small);
    for (int i = 0; i < SMALL_SPECIES; i++) {
        small->species[i].openness = openness[i];
        small->species[i].crown_open = 1.5f;
        small->species[i].stem_open = 1.4f;
    }
    small->species[0].in_the_open = 1 + 2;
    small->species[2].in_the_open = 1 + 1;
}

static struct wd_tree tree_of(const struct wd_world *world, size_t id)
{
    return world->trees[world->tree_of_id[id]];
}

/* 20 x 20 oaks 5 m apart, and one more. */
static void write_stand(const char *last)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fprintf(file, "x,y,species,dbh,height,crown_diameter\n");
    for (int i = 0; i < 400; i++)
        fprintf(file, "%d,%d,oak,,20,\n", 50 + 5 * (i % 20), 50 + 5 * (i / 20));
    fprintf(file, "%s\n", last);
    assert_int_equal(fclose(file), 0);
}

static void stands_have_edges(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world world;
    open_species(&small);
    small_scene_inventory(&small, path);
    write_stand("230,100,oak,,20,");
    make_or_fail(&small, &world);
    assert_said(captured.others, "in the open: ");
    for (size_t i = 0; i < 400; i++) {
        bool side = i % 20 == 0 || i % 20 == 19 || i / 20 == 0 || i / 20 == 19;
        bool corner = (i % 20 == 0 || i % 20 == 19) && (i / 20 == 0 || i / 20 == 19);
        uint32_t species = WD_TREE_SPECIES(tree_of(&world, 1 + i));
        if (!corner && species != (side ? 2 : 0))
            fail_msg("tree %zu is of species %u", i, species);
        assert_true(!corner || species == 2);
    }
    struct wd_tree alone = tree_of(&world, 401), inside = tree_of(&world, 211);
    assert_int_equal(WD_TREE_SPECIES(alone), 1);
    assert_int_equal(alone.size & 0xffff, 2000);
    assert_true(fabs((alone.size >> 16) - wd_crown_cm(&small.species[1], 2000)) < 1.5);
    assert_true(fabs((inside.size >> 16) - wd_crown_cm(&small.species[0], 2000)) < 1.5);
    assert_int_equal(world.species_counts[1], 1);
    wd_world_finish(&world);
}

static void what_is_measured_stays(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world world;
    open_species(&small);
    small_scene_inventory(&small, path);
    write_file(path, "x,y,species,dbh,height,crown_diameter\n50,50,oak,,20,7.5\n200,50,oak,40,21,\n");
    make_or_fail(&small, &world);
    struct wd_tree crown = tree_of(&world, 1), stem = tree_of(&world, 2);
    assert_int_equal(WD_TREE_SPECIES(crown), 1);
    assert_int_equal(crown.size, 2000 | 750 << 16);
    const struct wd_species *spruce = &small.species[1];
    double wide_cm = 100 * wd_species_crown_m(spruce, 40) * wd_species_open_crown(spruce, 1);
    assert_true(fabs((stem.size >> 16) - wide_cm) < 1.5);
    wd_world_finish(&world);
}

/* Trees that a caller plants are the caller's. */
static void given_trees_are_neighbours_and_stay(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world world;
    open_species(&small);
    small_scene_inventory(&small, path);
    write_file(path, "x,y,species,height\n50,50,oak,20\n200,50,oak,20\n");
    struct wd_tree given[8];
    for (int i = 0; i < 8; i++)
        given[i] = (struct wd_tree){.x_mm = 50000 + (int)(4000 * cos(i * 0.785398)), .z_mm = 100000, .size = 2000 | 500 << 16,
                                    .y_mm = 50000 + (int)(4000 * sin(i * 0.785398))};
    small.scene.path = NULL;
    struct wd_world_params params = {.trees = given, .tree_count = 8, .log = &sink};
    assert_true(wd_world_init(&world, &small.scene, &params));
    for (size_t id = 1; id <= 8; id++)
        assert_int_equal(tree_of(&world, id).kind, 0);
    assert_int_equal(WD_TREE_SPECIES(tree_of(&world, 9)), 0);
    assert_int_equal(WD_TREE_SPECIES(tree_of(&world, 10)), 1);
    wd_world_finish(&world);
}

/* Light from the sides, tree by tree over all others. */
static double side_light(const struct wd_tree *trees, size_t count, size_t index)
{
    double steepest[12] = {0}, sum = 0;
    const struct wd_tree *tree = &trees[index];
    for (size_t i = 0; i < count; i++) {
        double east = (trees[i].x_mm - tree->x_mm) * 0.001, north = (trees[i].y_mm - tree->y_mm) * 0.001;
        double rise = (trees[i].z_mm - tree->z_mm) * 0.001 + (double)WD_TREE_HEIGHT_M(trees[i]) -
                      0.4 * (double)WD_TREE_HEIGHT_M(*tree);
        double far = fmax(hypot(east, north), 0.5), half = (double)WD_TREE_CROWN_M(trees[i]) / 6;
        for (int k = 0; k < 12 && i != index && far <= 48; k++) {
            double c = cos(k * 0.52359877559), s = sin(k * 0.52359877559), along = east * c + north * s;
            if (along > 0 && fabs(north * c - east * s) <= half + 0.268 * along && rise / far > steepest[k])
                steepest[k] = rise / far;
        }
    }
    for (int k = 0; k < 12; k++)
        sum += fmin(fmax(1.6 - steepest[k], 0), 1);
    return sum / 12;
}

static void fill_hills(struct small_scene *small, struct wd_world *world, bool open, unsigned threads)
{
    open_species(small);
    small_scene_hills(small);
    struct wd_scene_layer *layer = small_scene_layer(small);
    layer->species_count = 1;
    layer->spacing_m = 6;
    layer->density = 0.6;
    small->species[0].in_the_open = open ? small->species[0].in_the_open : 0;
    assert_true(wd_world_init(world, &small->scene, &(struct wd_world_params){.threads = threads}));
}

static void hills_are_as_every_pair_says(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world closed, open;
    fill_hills(&small, &closed, false, 1);
    fill_hills(&small, &open, true, 1);
    assert_int_equal(closed.tree_count, open.tree_count);
    size_t counts[SMALL_SPECIES] = {0}, asked = 0;
    for (size_t i = 0; i < closed.tree_count; i += 97, asked++) {
        double share = side_light(closed.trees, closed.tree_count, i);
        uint32_t wanted = share > 0.75 ? 1 : share > 0.35 ? 2 : 0;
        bool near = fabs(share - 0.75) < 1e-3 || fabs(share - 0.35) < 1e-3;
        uint32_t is = WD_TREE_SPECIES(tree_of(&open, closed.trees[i].id));
        if (is != wanted && !near)
            fail_msg("tree %zu has %.4f of the light and is of species %u", i, share, is);
        counts[is]++;
    }
    for (int i = 0; i < SMALL_SPECIES; i++)
        assert_true(counts[i] > asked / 100);
    wd_world_finish(&closed);
    wd_world_finish(&open);
}

static void worlds_are_the_same_on_any_threads(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world one, many;
    fill_hills(&small, &one, true, 1);
    fill_hills(&small, &many, true, 7);
    assert_true(wd_world_hash(&one) == wd_world_hash(&many));
    assert_int_equal(wd_world_hash(&one), UINT64_C(0x76c074aefec4ebcc));
    wd_world_finish(&one);
    wd_world_finish(&many);
}

/* As of plots whose trees have no places of their own: every pair would take minutes. */
static void a_heap_of_trees_takes_no_endless_time(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world world;
    open_species(&small);
    small_scene_inventory(&small, path);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fprintf(file, "x,y,species,height\n");
    for (int i = 0; i < 80000; i++)
        fprintf(file, "100,100,oak,%.5f\n", 10 + 4e-5 * i);
    assert_int_equal(fclose(file), 0);
    alarm(60);
    make_or_fail(&small, &world);
    alarm(0);
    assert_int_equal(world.tree_count, 80000);
    wd_world_finish(&world);
}

/* Lower than 9 m, oaks are birches, which grow as saplings; heights and crowns are as they were. */
static void low_trees_are_young_ones(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world world;
    open_species(&small);
    small.species[0].in_the_open = small.species[2].in_the_open = 0;
    small.species[0].when_young = 1 + 2;
    small.species[2].form = WD_FORM_BROADLEAF;
    small.species[2].planted_m[0] = 2;
    small.species[2].planted_m[1] = 8;
    small_scene_inventory(&small, path);
    write_file(path, "x,y,species,height,crown_diameter\n50,50,oak,2.1,1.5\n60,50,oak,8.9,\n70,50,oak,9,\n80,50,birch,3,\n");
    make_or_fail(&small, &world);
    assert_said(captured.others, "young: 2 trees");
    static const uint32_t species[4] = {2, 2, 0, 2};
    for (size_t i = 0; i < 4; i++)
        assert_int_equal(WD_TREE_SPECIES(tree_of(&world, 1 + i)), species[i]);
    assert_int_equal(tree_of(&world, 1).size, 210 | 150 << 16);
    assert_int_equal(WD_TREE_VARIANT(tree_of(&world, 1)), 0);
    assert_int_equal(WD_TREE_VARIANT(tree_of(&world, 2)), 5);
    wd_world_finish(&world);
}

static void trees_on_demand_are_told_of(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world world;
    open_species(&small);
    small_scene_layer(&small);
    small.scene.planting = WD_PLANTING_ON_DEMAND;
    make_or_fail(&small, &world);
    assert_said(captured.others, "layer: is planted on demand, where \"when_young\" and \"in_the_open\" have no effect");
    wd_world_finish(&world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stands_have_edges),
        cmocka_unit_test(what_is_measured_stays),
        cmocka_unit_test(given_trees_are_neighbours_and_stay),
        cmocka_unit_test(hills_are_as_every_pair_says),
        cmocka_unit_test(worlds_are_the_same_on_any_threads),
        cmocka_unit_test(a_heap_of_trees_takes_no_endless_time),
        cmocka_unit_test(low_trees_are_young_ones),
        cmocka_unit_test(trees_on_demand_are_told_of),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    unlink(path);
    return failed;
}
