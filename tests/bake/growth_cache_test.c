#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/memory.h"
#include "bake/growth_cache.h"
#include "bake/splats.h"
#include "shared/sun_ways.h"
#include "tree/import.h"
#include "tree/sunlit.h"

struct fixture {
    char directory[64];
    struct wd_bake_cache cache;
    struct wd_scene scene;
};

static int setup(void **state)
{
    const struct wd_scene_params params = {0};
    struct fixture *f = *state = wd_alloc(sizeof *f);
    strcpy(f->directory, "/tmp/weald-test-XXXXXX");
    f->cache.directory = f->directory;
    return mkdtemp(f->directory) &&
                   wd_scene_load_with(&f->scene, "tests/api/small.json", &params, NULL)
               ? 0
               : -1;
}

static char *file_of(const struct fixture *f, const char *kind, uint64_t key)
{
    return wd_format("%s/%s-%016llx.bin", f->directory, kind, (unsigned long long)key);
}

static void drop(const struct fixture *f, const char *kind, uint64_t key)
{
    char *path = file_of(f, kind, key);
    unlink(path);
    free(path);
}

static int teardown(void **state)
{
    struct fixture *f = *state;
    int result = rmdir(f->directory); /* tests remove their files */
    wd_scene_finish(&f->scene);
    free(f);
    return result;
}

static void assert_same_mesh(const struct wd_tree_mesh *a, const struct wd_tree_mesh *b)
{
    assert_int_equal(a->vertex_count, b->vertex_count);
    assert_int_equal(a->index_count, b->index_count);
    assert_int_equal(a->wood_index_count, b->wood_index_count);
    assert_int_equal(a->stem_index_count, b->stem_index_count);
    assert_memory_equal(a->vertices, b->vertices, a->vertex_count * sizeof *a->vertices);
    assert_memory_equal(a->indices, b->indices, a->index_count * sizeof *a->indices);
    assert_memory_equal(a->min_m, b->min_m, sizeof a->min_m);
    assert_memory_equal(a->max_m, b->max_m, sizeof a->max_m);
    assert_true(a->reach_m == b->reach_m);
}

static void assert_same_model(const struct wd_tree_model *a, const struct wd_tree_model *b)
{
    assert_same_mesh(&a->full, &b->full);
    assert_same_mesh(&a->reduced, &b->reduced);
    assert_same_mesh(&a->far_stem, &b->far_stem);
    assert_true(a->far_stem.index_count > 0 && a->far_stem.index_count < a->reduced.stem_index_count);
    assert_same_mesh(&a->spray, &b->spray);
    assert_same_mesh(&a->spray_shade, &b->spray_shade);
    assert_int_equal(a->leaf_count, b->leaf_count);
    assert_int_equal(a->flower_count, b->flower_count);
    assert_memory_equal(a->leaves, b->leaves, a->leaf_count * sizeof *a->leaves);
    assert_memory_equal(&a->leaf_box, &b->leaf_box, sizeof a->leaf_box);
    for (int i = 0; i < 2 * WD_LEAF_SETS; i++)
        assert_true(a->sets[i / WD_LEAF_SETS][i % WD_LEAF_SETS].grain ==
                    b->sets[i / WD_LEAF_SETS][i % WD_LEAF_SETS].grain);
    assert_true(a->leaf_count > 0 && a->spray_reach == b->spray_reach && a->spray_forms == b->spray_forms);
    assert_true(a->height_m == b->height_m && a->crown_radius_m == b->crown_radius_m);
    assert_true(a->crown_base_m == b->crown_base_m && a->dbh_m == b->dbh_m);
    assert_true(a->age_years == b->age_years && a->leaf_area_m2 == b->leaf_area_m2);
}

/* Leaves outside see most of the sky, those within little. */
static void assert_leaves_know_their_sky(const struct wd_tree_model *model)
{
    uint32_t open = 0, most = 0, least = WD_SUN_WAYS;
    for (uint32_t i = 0; i < model->leaf_count; i++) {
        uint32_t ways = (uint32_t)__builtin_popcount(model->leaves[i].open);
        open += ways;
        most = ways > most ? ways : most;
        least = ways < least ? ways : least;
    }
    double share = (double)open / model->leaf_count / WD_SUN_WAYS;
    assert_true(share > 0.15 && share < 0.75);
    assert_true(most > 26 && least < 4);
}

static void a_kept_tree_is_the_grown_tree(void **state)
{
    struct fixture *f = *state;
    struct wd_tree_model grown, first, kept;
    uint64_t key, again;
    assert_true(wd_variant_grow(&grown, &f->scene, 1, NULL));
    wd_tree_sunlit_fit(&grown); /* leaves learn how open they are, and their triangles by them */
    wd_tree_model_drop_leaves(&grown);
    wd_tree_model_add_leaves(&grown);
    assert_leaves_know_their_sky(&grown);
    assert_true(wd_growth_get(&first, &key, &f->cache, &f->scene, 1, NULL));
    char *path = file_of(f, "growth", key);
    assert_int_equal(access(path, R_OK), 0);
    assert_true(wd_growth_get(&kept, &again, &f->cache, &f->scene, 1, NULL));
    assert_true(key == again);
    assert_int_equal(kept.full.index_count, kept.full.wood_index_count);
    assert_same_model(&first, &kept);
    wd_tree_model_add_leaves(&kept);
    assert_true(kept.full.index_count > kept.full.wood_index_count);
    assert_same_model(&grown, &kept);
    wd_tree_model_finish(&grown);
    wd_tree_model_finish(&first);
    wd_tree_model_finish(&kept);
    drop(f, "growth", key);
    free(path);
}

static void a_damaged_file_grows_the_tree_again(void **state)
{
    static const long sizes[] = {0, 10, 40, 200, 5000};
    struct fixture *f = *state;
    struct wd_tree_model first, kept;
    uint64_t key;
    assert_true(wd_growth_get(&first, &key, &f->cache, &f->scene, 0, NULL));
    char *path = file_of(f, "growth", key);
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        assert_int_equal(truncate(path, sizes[i]), 0);
        assert_true(wd_growth_get(&kept, &key, &f->cache, &f->scene, 0, NULL));
        assert_same_model(&first, &kept);
        wd_tree_model_finish(&kept);
    }
    /* a file that is whole and checks, but holds something else */
    static const uint8_t nonsense[400] = {1, 2, 3};
    wd_cache_store(&f->cache, "growth", key, nonsense, sizeof nonsense);
    assert_true(wd_growth_get(&kept, &key, &f->cache, &f->scene, 0, NULL));
    assert_same_model(&first, &kept);
    wd_tree_model_finish(&kept);
    wd_tree_model_finish(&first);
    drop(f, "growth", key);
    free(path);
}

static void keys_follow_what_growth_sees(void **state)
{
    struct fixture *f = *state;
    struct wd_species *species = &f->scene.species[0];
    struct wd_species other = *species;
    assert_true(wd_species_key(species) == wd_species_key(&other));
    other.name = "another word for the same";
    assert_true(wd_species_key(species) == wd_species_key(&other));
    other.leaf.length_cm += 0.5f;
    assert_true(wd_species_key(species) != wd_species_key(&other));
    other = *species;
    struct wd_branch_order orders[8];
    memcpy(orders, species->orders, species->order_count * sizeof *orders);
    other.orders = orders;
    assert_true(wd_species_key(species) == wd_species_key(&other));
    orders[0].wander += 0.01f;
    assert_true(wd_species_key(species) != wd_species_key(&other));
    other = *species;
    other.model.file = "tree.obj";
    assert_true(wd_species_key(&other) == 0);
}

/* What is kept is found by the next process, in which everything lies elsewhere. */
static void keys_hold_no_addresses(void **state)
{
    struct fixture *f = *state;
    const struct wd_scene_params params = {0};
    struct wd_scene again;
    assert_true(wd_scene_load_with(&again, "tests/api/small.json", &params, NULL));
    for (size_t i = 0; i < again.species_file_count; i++) {
        assert_ptr_not_equal(again.species[i].path, f->scene.species[i].path);
        assert_true(wd_species_key(&again.species[i]) == wd_species_key(&f->scene.species[i]));
    }
    wd_scene_finish(&again);
}

/* The only file of a kind; drops it. */
static uint64_t drop_only(const struct fixture *f, const char *kind)
{
    unsigned long long key = 0;
    size_t count = 0, length = strlen(kind);
    DIR *folder = opendir(f->directory);
    assert_non_null(folder);
    for (struct dirent *entry; (entry = readdir(folder));)
        if (strncmp(entry->d_name, kind, length) == 0)
            count += (size_t)sscanf(entry->d_name + length, "-%llx.bin", &key);
    closedir(folder);
    assert_int_equal(count, 1);
    drop(f, kind, key);
    return key;
}

static void import_tree(struct fixture *f, struct wd_tree_import *import)
{
    assert_true(wd_variant_grow(&import->model, &f->scene, 0, NULL));
    free(import->model.leaves); /* of imports they are triangles like others */
    import->model.leaves = NULL;
    import->model.leaf_count = import->model.flower_count = 0;
    f->scene.species[0].imported = import;
}

static struct wd_tree_model imported_fit(struct fixture *f)
{
    uint64_t key;
    struct wd_tree_model model;
    assert_true(wd_growth_get(&model, &key, &f->cache, &f->scene, 0, NULL));
    assert_true(model.borrowed); /* from the import, which frees it */
    return model;
}

static void what_is_fitted_to_an_import_is_kept(void **state)
{
    struct fixture *f = *state;
    struct wd_tree_import import = {0};
    size_t size;
    import_tree(f, &import);
    const struct wd_tree_model first = imported_fit(f), kept = imported_fit(f);
    assert_true(first.recollision > 0 && first.shade.radius_m > 0);
    assert_memory_equal(&first, &kept, sizeof first);
    uint64_t key = drop_only(f, "fits");
    imported_fit(f);
    uint8_t *block = wd_cache_load(&f->cache, "fits", key, 1 << 20, &size);
    assert_non_null(block);
    wd_cache_store(&f->cache, "fits", key, block, size - 4); /* not all of it */
    const struct wd_tree_model again = imported_fit(f);
    assert_memory_equal(&first, &again, sizeof first);
    block[2] ^= 1; /* of its first figure */
    wd_cache_store(&f->cache, "fits", key, block, size);
    assert_true(imported_fit(f).height_m != first.height_m);
    assert_true(drop_only(f, "fits") == key);
    free(block);
    f->scene.species[0].imported = NULL;
    wd_tree_model_finish(&import.model);
}

static void imported_trees_are_named_by_mesh_and_pictures(void **state)
{
    struct fixture *f = *state;
    uint8_t texels[16] = {0};
    struct wd_model_picture picture = {.image = {2, 2, texels}};
    struct wd_tree_import import = {.materials = {.pictures = &picture, .picture_count = 1}};
    import_tree(f, &import);
    uint64_t keys[4];
    for (int i = 0; i < 4; i++) {
        struct wd_tree_model model;
        texels[5] = i == 2;
        picture.image.width = picture.image.height = i == 3 ? 1 : 2;
        assert_true(wd_growth_get(&model, &keys[i], &f->cache, &f->scene, 0, NULL));
        wd_tree_model_finish(&model);
    }
    f->scene.species[0].imported = NULL;
    wd_tree_model_finish(&import.model);
    assert_true(keys[0] == keys[1]);
    assert_true(keys[0] != keys[2]);
    assert_true(keys[0] != keys[3]);
    drop_only(f, "fits");
}

static void assert_same_splats(const struct wd_splats *a, const struct wd_splats *b)
{
    assert_memory_equal(&a->model, &b->model, sizeof a->model);
    assert_memory_equal(a->splats, b->splats, WD_SPLATS * sizeof *a->splats);
    assert_memory_equal(a->looks, b->looks, WD_SPLATS * sizeof *a->looks);
    assert_memory_equal(a->lit, b->lit, WD_SPLATS * sizeof *a->lit);
    assert_memory_equal(a->corners, b->corners, a->model.wood_corners * sizeof *a->corners);
    assert_memory_equal(a->wood, b->wood, a->model.wood_count * sizeof *a->wood);
}

static void splats_are_kept_by_model(void **state)
{
    struct fixture *f = *state;
    struct wd_tree_model model;
    struct wd_splats made, kept;
    assert_true(wd_variant_grow(&model, &f->scene, 1, NULL));
    static uint8_t texels[4 * WD_LOOK_LAYERS] = {90, 120, 30, 255};
    const struct wd_point_look look = {texels, 1};
    assert_true(wd_splats_init(&made, &model, &look, NULL));
    assert_false(wd_splats_load(&kept, &f->cache, 7));
    wd_splats_store(&made, &f->cache, 7);
    assert_false(wd_splats_load(&kept, &f->cache, 8));
    assert_true(wd_splats_load(&kept, &f->cache, 7));
    assert_true(kept.model.wood_count > 0);
    assert_same_splats(&made, &kept);
    wd_splats_finish(&kept);
    /* whole and checked, but with fewer triangles than it says */
    size_t size;
    uint8_t *block = wd_cache_load(&f->cache, "splats", 7, 64 << 20, &size);
    wd_cache_store(&f->cache, "splats", 7, block, size - sizeof *made.wood);
    assert_false(wd_splats_load(&kept, &f->cache, 7));
    wd_cache_store(&f->cache, "splats", 7, block, 100);
    assert_false(wd_splats_load(&kept, &f->cache, 7));
    free(block);
    wd_splats_finish(&made);
    wd_tree_model_finish(&model);
    drop(f, "splats", 7);
}

static void looks_are_kept_by_species(void **state)
{
    struct fixture *f = *state;
    uint8_t looks[1000], loaded[1000];
    for (size_t i = 0; i < sizeof looks; i++)
        looks[i] = (uint8_t)(i * 7);
    assert_false(wd_looks_load(loaded, sizeof loaded, &f->cache, &f->scene.species[0]));
    wd_looks_store(looks, sizeof looks, &f->cache, &f->scene.species[0]);
    assert_true(wd_looks_load(loaded, sizeof loaded, &f->cache, &f->scene.species[0]));
    assert_memory_equal(looks, loaded, sizeof looks);
    assert_false(wd_looks_load(loaded, sizeof loaded, &f->cache, &f->scene.species[1]));
    assert_false(wd_looks_load(loaded, 999, &f->cache, &f->scene.species[0]));
    drop(f, "looks", wd_species_key(&f->scene.species[0]));
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(a_kept_tree_is_the_grown_tree),
        TEST(a_damaged_file_grows_the_tree_again),
        TEST(keys_follow_what_growth_sees),
        TEST(keys_hold_no_addresses),
        TEST(what_is_fitted_to_an_import_is_kept),
        TEST(imported_trees_are_named_by_mesh_and_pictures),
        TEST(splats_are_kept_by_model),
        TEST(looks_are_kept_by_species),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
