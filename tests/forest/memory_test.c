#include "planted.h"

#include "bake/splats.h"
#include "forest/model_bakes.h"

/* What a forest's models hold on the device: meshes, leaves and cards. */
static size_t model_bytes(const struct wd_forest_device *forest)
{
    const struct wd_forest_meshes *meshes = &forest->meshes;
    return meshes->vertices.memory_size + meshes->indices.memory_size +
           meshes->leaves.memory_size + meshes->corners.memory_size +
           forest->card_albedo.memory_size + forest->card_normal.memory_size +
           forest->card_leaf.memory_size;
}

/* What `continuum` adds for a model. */
static size_t splat_bytes(void)
{
    enum { WOOD_TRIANGLES = 2000, WOOD_CORNERS = 2000 };
    return WD_SPLATS_BYTES + WOOD_TRIANGLES * sizeof(uint64_t) +
           WOOD_CORNERS * sizeof(struct wd_splat_corner);
}

static void an_oaks_levels_are_small(void **state)
{
    struct planted planted;
    planted_init(&planted, *state, "tests/forest/one.json", NULL);
    assert_true(wd_forest_make_cards(&planted.forest, &planted.test->gpu));
    const struct wd_twig_range *leaves = &planted.forest.meshes.twigs[0];
    size_t bytes = model_bytes(&planted.forest) + splat_bytes();
    print_message("oak of %u leaves: %.2f MB, of which cards %.2f, splats %.2f\n",
                  leaves->leaf_count, 1e-6 * (double)bytes,
                  1e-6 * (double)(planted.forest.card_albedo.memory_size +
                                  planted.forest.card_normal.memory_size +
                                  planted.forest.card_leaf.memory_size),
                  1e-6 * (double)splat_bytes());
    assert_in_range(leaves->leaf_count, 15000, 25000);
    assert_true(bytes <= 2800000);
    /* a leaf is its record, whatever its form */
    assert_true(planted.forest.meshes.leaves.memory_size <= 24 * leaves->leaf_count + 4096);
    planted_finish(&planted);
}

static void trees_of_several_species_share_little_memory(void **state)
{
    struct planted planted;
    planted_init(&planted, *state, "tests/forest/five.json", NULL);
    assert_true(wd_forest_make_cards(&planted.forest, &planted.test->gpu));
    assert_int_equal(planted.forest.model_count, 10);
    size_t each = model_bytes(&planted.forest) / planted.forest.model_count;
    print_message("%.2f MB a tree\n", 1e-6 * (double)each);
    assert_true(each <= 1200000);
    /* nothing that only served to make them is left */
    size_t all = planted.test->gpu.bytes_allocated;
    size_t looks = planted.forest.looks.memory_size + planted.forest.look_details.memory_size;
    assert_true(all - looks - model_bytes(&planted.forest) < 4000000);
    planted_finish(&planted);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(an_oaks_levels_are_small, gpu_setup,
                                        gpu_teardown),
        cmocka_unit_test_setup_teardown(trees_of_several_species_share_little_memory,
                                        gpu_setup, gpu_teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
