#include "tree/sunlit.h"
#include "tree_test.h"

static void assert_finite(const struct wd_tree_mesh *mesh)
{
    bool finite = true;
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        for (int axis = 0; axis < 3; axis++)
            finite &= isfinite(mesh->vertices[i].position_m[axis]) != 0;
    assert_true(finite);
}

/* How far wood reaches from the axis within 5 cm of the ground. */
static float foot_m(const struct wd_tree_mesh *mesh)
{
    float reach = 0;
    for (uint32_t i = 0; i < mesh->wood_index_count; i++) {
        const float *p = mesh->vertices[mesh->indices[i]].position_m;
        if (p[2] < 0.05f)
            reach = fmaxf(reach, hypotf(p[0], p[1]));
    }
    return reach;
}

static void grow_absurd(struct wd_species *species, float detail)
{
    struct test_log log;
    struct wd_tree_model model;
    struct wd_grow_params params = {.seed = 1, .detail = detail};
    test_log_init(&log);
    bool ok = wd_tree_grow(&model, species, &params, &log.log);
    assert_true(ok || log.count == 1);
    /* most are 652,812, spruces with flowers, and 24,080, 200 stems of bramble or camellia with
     * 4,000 leaves of two and flowers of 120 triangles */
    assert_true(model.full.index_count / 3 < 700000);
    assert_true(model.reduced.index_count / 3 < 24500);
    assert_int_equal(model.flower_count, model.sets[0][WD_SET_FLOWERS].leaf_count);
    assert_finite(&model.full);
    assert_finite(&model.reduced);
    wd_tree_model_finish(&model);
}

/* What fills a plant of each form with more than anybody could look at. */
static void crowded_species_are_bounded(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    for (int s = 0; s < SPECIES_COUNT; s += SPECIES_STEP)
        for (int i = 0; i < 4; i++) {
            struct wd_species species = test_species(&arena, test_species_names[s]);
            species.leaf.count = i == 0 ? 0 : 2000000;
            species.stems.count = 200;
            species.leaf.leaflets = i == 1 ? 400 : 1;
            species.flower.count = i == 3 ? 20000 : species.flower.count;
            species.flower.petals = i == 3 ? 60 : 0;
            species.decay.broken_at = 0.1f;
            species.buttress.count = i == 2 ? 12 : 0;
            grow_absurd(&species, i == 3 ? 8 : 0);
        }
    wd_arena_finish(&arena);
}

/* Numbers that the schema lets through make a bounded tree or one error, and never a hang. */
static void absurd_species_are_bounded(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    for (int i = 0; i < 8; i++) {
        struct wd_species species = test_species(&arena, i == 7 ? "coconut" : i & 1 ? "snag" : "oak");
        if (i < 2)
            species.orders[0].spacing_m = species.orders[1].spacing_m = 1e-30f;
        if (i == 1 || i == 3)
            species.decay.limbs = 0;
        if (i == 2 || i == 3)
            species.orders[1].spacing_m = species.orders[0].length_ratio = 1e-20f;
        if (i == 4)
            species.leaf.count = 2000000, species.leaf.length_cm = 1e-6f;
        if (i == 5)
            species.allometry.crown_b = 1e-9, species.allometry.crown_a = 0;
        if (i == 6)
            species.orders[0].length_ratio = 4, species.orders[1].length_ratio = 4;
        if (i == 7)
            species.crown_base_forest = 0;
        grow_absurd(&species, i == 4 ? 0.05f : 0); /* 4 takes half a minute in full under sanitizers */
    }
    wd_arena_finish(&arena);
}

/* Those that a mesh has no room for are nowhere asked for. */
static void flowers_that_do_not_fit_are_left_out(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    struct wd_species species = test_species(&arena, "oak");
    species.flower.count = 20000;
    species.flower.petals = 60;
    struct wd_tree_model model = test_grow_tree(&species, 1, 0, 0);
    assert_in_range(model.flower_count, 100, 10000);
    wd_tree_sunlit_fit(&model);
    uint32_t open = 0;
    for (uint32_t i = 0; i < model.flower_count; i++)
        open += model.leaves[model.leaf_count + i].open != 0;
    assert_true(open > model.flower_count / 2); /* they stand where light reaches */
    wd_tree_model_finish(&model);
    wd_arena_finish(&arena);
}

/* Buttresses without height are none; a crown that begins at the ground leaves the stem its foot. */
static void a_stem_stands_on_a_sound_foot(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    for (int i = 0; i < 4; i++) {
        struct wd_species species = test_species(&arena, i < 2 ? "angelique" : "oak");
        float openness = i == 3 ? 1 : 0;
        if (i < 2)
            species.buttress.height = i == 0 ? 0 : 1e-40f;
        else
            species.crown_base_open = species.crown_base_forest = 0;
        struct wd_tree_model model = test_grow_tree(&species, 1, 0, openness);
        assert_finite(&model.full);
        assert_finite(&model.reduced);
        assert_true(foot_m(&model.full) > 0.5f * model.dbh_m);
        assert_true(foot_m(&model.reduced) > 0.4f * model.dbh_m);
        wd_tree_model_finish(&model);
    }
    wd_arena_finish(&arena);
}

/* Whose leaf area would take leaves as long as the tree: few ones, or a width in the wrong unit. */
static void leaves_are_shorter_than_the_tree(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    for (int i = 0; i < 2; i++) {
        struct wd_species species = test_species(&arena, "oak");
        species.leaf.count = i == 0 ? 8 : 200;
        species.leaf.width_cm = i == 0 ? 6.5f : 1e-3f;
        struct wd_tree_model model = test_grow_tree(&species, 1, 0, 0);
        assert_true(model.full.index_count > model.full.wood_index_count);
        assert_true(model.full.min_m[2] > -0.05f * model.height_m);
        assert_true(model.full.max_m[0] - model.full.min_m[0] < 0.9f * model.height_m);
        wd_tree_model_finish(&model);
    }
    wd_arena_finish(&arena);
}

static void trunks_that_wander_stay_above_their_foot(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    struct wd_species species = test_species(&arena, "oak");
    species.trunk_wander = 2;
    struct wd_tree_model model = test_grow_tree(&species, 1, 0, 0);
    assert_true(model.full.min_m[2] > -0.05f * model.height_m);
    assert_true(model.full.max_m[0] - model.full.min_m[0] < 2 * model.height_m);
    wd_tree_model_finish(&model);
    wd_arena_finish(&arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(absurd_species_are_bounded),
        cmocka_unit_test(a_stem_stands_on_a_sound_foot),
        cmocka_unit_test(crowded_species_are_bounded),
        cmocka_unit_test(flowers_that_do_not_fit_are_left_out),
        cmocka_unit_test(leaves_are_shorter_than_the_tree),
        cmocka_unit_test(trunks_that_wander_stay_above_their_foot),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
