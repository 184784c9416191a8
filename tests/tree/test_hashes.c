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
        0xd7d91c7e793ad1a3u, 0xf41281e38aa63fa1u, 0x34e5b85ddc365e69u,
        0xe98490c4f2a552f8u, 0x7341d7dff323342du, 0x243a50df820f80f4u,
        0x5fbeb69277f74de1u, 0x19bb7fc16768cd21u, 0xd4bb6fcb05bb1c3fu,
        0xd85d74afefa44923u, 0xb2ac74a96329549du, 0xddc8c10f65cf3b95u,
        0xc3098b979a71e289u, 0x261b729b3ede691du, 0x419301874c1d9884u,
        0x93d9cfbf3f9f432cu, 0xc738882ef573b17du};
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
