/* Trees are the same bytes for the same parameters, whatever made the program. */
#include "tree_test.h"

static uint64_t hash_bytes(uint64_t hash, const void *data, size_t size)
{
    const uint8_t *bytes = data;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ bytes[i]) * 0x100000001b3u;
    return hash;
}

static uint64_t hash_mesh(uint64_t hash, const struct wd_tree_mesh *mesh)
{
    hash = hash_bytes(hash, mesh->vertices, mesh->vertex_count * sizeof *mesh->vertices);
    return hash_bytes(hash, mesh->indices, mesh->index_count * sizeof *mesh->indices);
}

static uint64_t hash_model(const struct wd_tree_model *model)
{
    return hash_mesh(hash_mesh(0xcbf29ce484222325u, &model->full), &model->reduced);
}

static void same_parameters_same_bytes(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    struct wd_species species = test_species(&arena, "oak");
    struct wd_tree_model a = test_grow_tree(&species, 7, 20, 0.3f);
    struct wd_tree_model b = test_grow_tree(&species, 7, 20, 0.3f);
    struct wd_tree_model other = test_grow_tree(&species, 8, 20, 0.3f);
    assert_true(hash_model(&a) == hash_model(&b));
    assert_true(hash_model(&a) != hash_model(&other));
    wd_tree_model_finish(&a);
    wd_tree_model_finish(&b);
    wd_tree_model_finish(&other);
    wd_arena_finish(&arena);
}

/* The same on every compiler and optimisation level. When growth or a species file changes on
 * purpose, the failing test prints the new numbers. */
static void known_hashes(void **state)
{
    static const uint64_t expected[SPECIES_COUNT] = {
        0xa16c01c0becc0f1bu, 0x27abadb2fa7e98a4u, 0xf1e244e6602e93adu,
        0xc9dafd0adcecf085u, 0xa96f2ae1366a617eu, 0x7c48e2d80dce2070u,
        0x87d7a2283966169bu, 0x6e2be77eb7319012u, 0x75b39be61f6ba307u,
        0x918702d855b9c2d6u, 0xead87e0df1b01c69u, 0x6612a4604276fb5bu,
        0x4e5ee1ddf06f5029u, 0xfbfcd6625ef42055u, 0x6393199adb47c050u,
        0x739b215ad14c97c5u, 0xf9143f5ad8569c6bu};
    struct wd_arena arena = {0};
    int wrong = 0;
    (void)state;
    for (int s = 0; s < SPECIES_COUNT; s++) {
        struct wd_species species = test_species(&arena, test_species_names[s]);
        struct wd_tree_model model = test_grow_tree(&species, 1, 0, 0.25f);
        if (hash_model(&model) != expected[s]) {
            print_error("%s: 0x%016llx\n", test_species_names[s],
                        (unsigned long long)hash_model(&model));
            wrong++;
        }
        wd_tree_model_finish(&model);
    }
    wd_arena_finish(&arena);
    assert_int_equal(wrong, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_parameters_same_bytes),
        cmocka_unit_test(known_hashes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
