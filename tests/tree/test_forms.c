#include "tree_test.h"

#include "raster.h"
#include "tree/leaf_set.h"

enum { VARIANTS = 20, SIDE = 56 };

static void draw(const struct wd_tree_model *model, unsigned char covered[SIDE * SIDE])
{
    float reach = fmaxf(model->full.max_m[0] - model->full.min_m[0],
                        model->full.max_m[2] - model->full.min_m[2]);
    float middle = 0.5f * (model->full.max_m[0] + model->full.min_m[0]);
    float scale = 0.9f * SIDE / reach;
    struct wd_raster_view view = {0.5f * SIDE - middle * scale, 0.95f * SIDE, scale, 0, 0.02f};
    struct wd_raster raster;
    wd_raster_init(&raster, SIDE, SIDE);
    wd_raster_silhouette(&raster, &model->full, &view);
    memcpy(covered, raster.covered, SIDE * SIDE);
    wd_raster_finish(&raster);
}

/* Share of the pixels of either silhouette that the other one lacks. */
static double difference(const unsigned char *a, const unsigned char *b)
{
    int either = 0, one = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        either += a[i] || b[i];
        one += !a[i] != !b[i];
    }
    return (double)one / (double)(either > 0 ? either : 1);
}

/* Twenty individuals of one size: no two look alike from the same side. */
static void variants_look_different(void **state)
{
    (void)state;
    static unsigned char covered[VARIANTS][SIDE * SIDE];
    struct wd_arena arena = {0};
    for (int s = 0; s < SPECIES_COUNT; s++) {
        struct wd_species species = test_species(&arena, test_species_names[s]);
        for (uint32_t v = 0; v < VARIANTS; v++) {
            struct wd_grow_params params = {.seed = v + 1, .detail = 0.2f, .openness = 0.35f};
            struct wd_tree_model model;
            assert_true(wd_tree_grow(&model, &species, &params, NULL));
            draw(&model, covered[v]);
            wd_tree_model_finish(&model);
        }
        double least = 1;
        for (int a = 0; a < VARIANTS; a++)
            for (int b = 0; b < a; b++)
                least = fmin(least, difference(covered[a], covered[b]));
        print_message("%s: silhouettes differ by %.0f%% or more\n", test_species_names[s],
                      100 * least);
        assert_true(least > 0.12);
    }
    wd_arena_finish(&arena);
}

/* Crowns are as wide as the allometry that the file tells, by which trees are planted: others would be
 * drawn stretched, stems and leaves with them. */
static void crowns_follow_the_allometry(void **state)
{
    (void)state;
    static const char *const names[] = {"oak", "beech", "birch", "spruce", "pine", "maple",
                                        "larch", "angelique", "willow", "catalpa", "coconut",
                                        "hazel", "camellia-red", "fern", "grass",
                                        "snag"};
    struct wd_arena arena = {0};
    for (size_t s = 0; s < sizeof names / sizeof *names; s++) {
        struct wd_species species = test_species(&arena, names[s]);
        double sum = 0, wanted = 0.5 * wd_species_crown_of_height_m(
                                           &species, (double)species.typical_height_m);
        for (uint32_t seed = 1; seed <= 6; seed++) {
            struct wd_grow_params params = {.seed = seed, .detail = 0.3f};
            struct wd_tree_model model;
            assert_true(wd_tree_grow(&model, &species, &params, NULL));
            sum += (double)model.crown_radius_m / 6;
            wd_tree_model_finish(&model);
        }
        print_message("%s: crown radius %.2f m, by allometry %.2f m\n", names[s], sum, wanted);
        assert_float_equal(sum / wanted, 1, 0.25);
    }
    wd_arena_finish(&arena);
}

/* A fern's fronds rise from the ground itself: its rootstock hardly shows. Their stipes are brown and scaly up to
 * where the first pinnae stand. */
static void ferns_rise_from_the_ground(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    struct wd_species species = test_species(&arena, "fern");
    const float heights[] = {0.3f, 0.8f, 1.3f};
    for (uint32_t seed = 0; seed < 6; seed++) {
        float height = heights[seed % 3], stipes = 0;
        struct wd_tree_model model = test_grow_tree(&species, seed, height, 0);
        for (uint32_t i = 0; i < model.leaf_count; i++)
            assert_true(wd_leaf_foot(model.leaves[i], model.leaf_box).z < 0.01f * height);
        for (uint32_t i = 0; i < model.full.wood_index_count; i++) {
            const float *p = model.full.vertices[model.full.indices[i]].position_m;
            if (p[0] * p[0] + p[1] * p[1] < 0.03f * model.dbh_m * model.dbh_m)
                assert_true(p[2] < 0.025f * height);
            stipes = fmaxf(stipes, p[2]);
        }
        assert_true(stipes > 0.08f * height && stipes < 0.3f * height);
        wd_tree_model_finish(&model);
    }
    wd_arena_finish(&arena);
}

/* Without leaves their rootstocks are all that is left, as low as they were: they had been drawn out to the height of
 * fronds, as posts. The plant is as wide as planted all the while. */
static void bare_rootstocks_stay_low(void **state)
{
    (void)state;
    static const char *const names[] = {"fern", "grass", "meadow"};
    struct wd_arena arena = {0};
    for (int i = 0; i < 3; i++) {
        struct wd_species species = test_species(&arena, names[i]), bare = species;
        bare.leaf.count = bare.flower.count = 0;
        bare.leaf.area_index = 0;
        struct wd_tree_model leafy = test_grow_tree(&species, 2, 0, 0.2f);
        struct wd_tree_model low = test_grow_tree(&bare, 2, 0, 0.2f);
        assert_int_equal(low.leaf_count, 0);
        assert_true(low.full.max_m[2] < 0.12f * low.height_m && low.reduced.max_m[2] < 0.12f * low.height_m);
        assert_float_equal(low.height_m, leafy.height_m, 1e-4);
        assert_true(low.crown_radius_m > 0.5f * leafy.crown_radius_m && low.crown_radius_m < 2 * leafy.crown_radius_m);
        wd_tree_model_finish(&leafy);
        wd_tree_model_finish(&low);
    }
    wd_arena_finish(&arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(variants_look_different),
        cmocka_unit_test(crowns_follow_the_allometry),
        cmocka_unit_test(ferns_rise_from_the_ground),
        cmocka_unit_test(bare_rootstocks_stay_low),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
