#include "tree_test.h"

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
    wd_tree_model_finish(&model);
}

/* What fills a plant of each form with more than anybody could look at. */
static void crowded_species_are_bounded(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    for (int s = 0; s < SPECIES_COUNT; s++)
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
    for (int i = 0; i < 7; i++) {
        struct wd_species species = test_species(&arena, i & 1 ? "snag" : "oak");
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
        grow_absurd(&species, 0);
    }
    wd_arena_finish(&arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(absurd_species_are_bounded),
        cmocka_unit_test(crowded_species_are_bounded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
