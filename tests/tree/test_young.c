/* Young trees are no shrunken old ones: one leader, thin branches, a crown down to the ground. */
#include "tree_test.h"

#include "tree/form.h"
#include "tree/leaf_set.h"
#include "tree/skeleton.h"

static const char *const trees[] = {"oak", "beech", "birch", "maple", "willow", "catalpa", "pine", "spruce", "larch"};
enum { TREES = sizeof trees / sizeof *trees };

/* Height below which a twentieth of all leaves stand. */
static float lowest_leaves_m(const struct wd_tree_model *model)
{
    enum { STEPS = 200 };
    uint32_t count[STEPS] = {0}, below = 0;
    int step = 0;
    for (uint32_t i = 0; i < model->leaf_count; i++) {
        float z = wd_leaf_foot(model->leaves[i], model->leaf_box).z / model->height_m;
        count[(int)fmaxf(0, fminf(z, 0.999f) * STEPS)]++;
    }
    while (20 * (below += count[step]) < model->leaf_count)
        step++;
    return model->height_m * ((float)step + 0.5f) / STEPS;
}

/* Below a quarter of a grown tree's height the live crown takes 0.6 to 0.9 of a tree. */
static void saplings_are_green_to_the_ground(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    for (int s = 0; s < TREES; s += SPECIES_STEP)
        for (uint32_t seed = 1; seed <= 2; seed++)
            for (int open = 0; open <= 1; open++) {
                struct wd_species species = test_species(&arena, trees[s]);
                float height = fminf(2, 0.25f * species.typical_height_m);
                struct wd_tree_model model = test_grow_tree(&species, seed, height, (float)open);
                float share = lowest_leaves_m(&model) / height;
                if (share > 0.33f || model.crown_base_m > 0.2f * height)
                    fail_msg("%s %g m, open %d: leaves from %g, crown from %g of the height", trees[s],
                             (double)height, open, (double)share, (double)(model.crown_base_m / height));
                wd_tree_model_finish(&model);
            }
    wd_arena_finish(&arena);
}

static void check_leader(const struct wd_skeleton *skeleton, const struct wd_tree_form *form)
{
    const struct wd_branch *trunk = &skeleton->branches[0];
    const struct wd_skeleton_node *top = &skeleton->nodes[trunk->first_node + trunk->node_count - 1];
    uint32_t limbs = 0;
    assert_int_equal(skeleton->stem_count, 1);
    if (top->position_m.z < 0.9f * form->height_m)
        fail_msg("%s %g m: the leader ends at %g m", form->species->name, (double)form->height_m,
                 (double)top->position_m.z);
    for (size_t i = 1; i < skeleton->branch_count; i++) {
        const struct wd_branch *branch = &skeleton->branches[i];
        if (branch->order != 0)
            continue;
        float joint = skeleton->nodes[branch->parent_node].radius_m;
        float thick = skeleton->nodes[branch->first_node].radius_m;
        if (branch->parent_node + 3 < trunk->first_node + trunk->node_count) /* below the tip */
            assert_true(thick < 0.6f * joint || thick < 0.002f);
        limbs++;
    }
    assert_in_range(limbs, 8, 200);
}

static void saplings_have_one_leader(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    for (int s = 0; s < TREES; s += SPECIES_STEP)
        for (uint32_t seed = 1; seed <= 2; seed++) {
            struct wd_species species = test_species(&arena, trees[s]);
            struct wd_grow_params params = {.seed = seed, .height_m = 0.12f * species.typical_height_m};
            assert_true(wd_grow_params_resolve(&params, &species, NULL));
            struct wd_tree_form form = wd_tree_form_of(&species, &params);
            struct wd_skeleton skeleton;
            assert_true(wd_skeleton_grow(&skeleton, &form, NULL));
            wd_skeleton_set_radii(&skeleton, &form);
            check_leader(&skeleton, &form);
            wd_skeleton_finish(&skeleton);
        }
    wd_arena_finish(&arena);
}

/* Scenes plant young trees as wide as they grow. */
static void planted_crowns_are_the_grown_ones(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    static const float shares[] = {0.06f, 0.12f, 0.25f};
    for (int s = 0; s < TREES; s += SPECIES_STEP)
        for (int i = 0; i < 3; i++) {
            struct wd_species species = test_species(&arena, trees[s]);
            float height = fmaxf(shares[i] * species.typical_height_m, species.height_range_m[0]), sum = 0;
            for (uint32_t seed = 1; seed <= 3; seed++) {
                struct wd_tree_model model = test_grow_tree(&species, seed, height, species.openness);
                sum += model.crown_radius_m / 3;
                wd_tree_model_finish(&model);
            }
            double planted = 0.5 * wd_species_crown_of_height_m(&species, (double)height);
            print_message("%s %.1f m: crown radius %.2f m, planted %.2f m\n", trees[s], (double)height,
                          (double)sum, planted);
            assert_true(planted > 0.12 * (double)height && planted < 0.36 * (double)height);
            if (fabs((double)sum / planted - 1) > 0.3)
                fail_msg("%s %g m is planted %g times as wide as it grows", trees[s], (double)height,
                         planted / (double)sum);
        }
    wd_arena_finish(&arena);
}

/* What has been measured of grown trees holds: from a little below half of the typical height on nothing is young. */
static void grown_trees_are_not_young(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    for (int s = 0; s < SPECIES_COUNT; s++) {
        struct wd_species species = test_species(&arena, test_species_names[s]);
        double typical = (double)species.typical_height_m;
        bool tree = species.form == WD_FORM_BROADLEAF || species.form == WD_FORM_CONIFER;
        assert_true(wd_species_youth(&species, 0.46 * typical) == 0);
        assert_true(wd_species_youth(&species, 0.1 * typical) == (tree ? 1 : 0));
        for (float before = 1, share = 0.1f; share < 0.5f; share += 0.01f) {
            float youth = wd_species_youth(&species, (double)share * typical);
            assert_true(youth <= before && (!tree || before - youth < 0.07f));
            before = tree ? youth : before;
        }
    }
    wd_arena_finish(&arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(saplings_are_green_to_the_ground),
        cmocka_unit_test(saplings_have_one_leader),
        cmocka_unit_test(planted_crowns_are_the_grown_ones),
        cmocka_unit_test(grown_trees_are_not_young),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
