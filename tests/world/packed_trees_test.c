#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "world/packed_trees.h"

enum { TREES = 3000, VARIANTS = 5, SPECIES = 200 };

/* Anywhere in a box, of any size, species and look; the ends of each range are among them. */
static struct wd_tree tree_in(uint32_t i, const int64_t least_mm[3], const int64_t most_mm[3])
{
    int32_t at_mm[3];
    for (uint32_t k = 0; k < 3; k++) {
        uint64_t span = (uint64_t)(most_mm[k] - least_mm[k]);
        uint32_t share = i < 8 ? (i >> k & 1u) * UINT32_MAX : wd_hash2(i, k);
        at_mm[k] = (int32_t)(least_mm[k] + (int64_t)((span * share + share) >> 32));
    }
    uint32_t end = i == 8 ? 0 : i == 9 ? UINT32_MAX : 1;
#define ANY(purpose, count) (end == 1 ? wd_hash2(i, purpose) % (count) : end ? (count) - 1u : 0u)
    return (struct wd_tree){
        .x_mm = at_mm[0],
        .y_mm = at_mm[1],
        .z_mm = at_mm[2],
        .kind = ANY(3, SPECIES) | ANY(4, VARIANTS) << 16,
        .size = (1 + ANY(5, WD_TREE_HEIGHT_MOST_CM)) | (1 + ANY(6, WD_TREE_CROWN_MOST_CM)) << 16,
        .look = WD_TREE_LOOK_OF_LAYER(WD_TREE_LOOK(ANY(7, 16384u), ANY(8, 256u), ANY(9, 2u)),
                                      ANY(10, 128u)),
    };
#undef ANY
}

static int64_t off_mm(int32_t a, int32_t b)
{
    return llabs((int64_t)a - b);
}

static struct wd_tree unpacked(const struct wd_packed_tree *packed, uint32_t i)
{
    return wd_tree_unpack(packed[WD_PACKED_AT(i)], wd_tree_block_of(packed[WD_PACKED_HEAD(i)]));
}

/* Packs trees strewn over a box; places come back so near, all else as it was. */
static void check(const int64_t least_mm[3], const int64_t most_mm[3], int64_t across_mm,
                  int64_t up_mm)
{
    struct wd_tree *trees = wd_alloc_array(TREES, sizeof *trees);
    struct wd_packed_tree *packed = wd_alloc_array(wd_packed_count(TREES), sizeof *packed);
    for (uint32_t i = 0; i < TREES; i++)
        trees[i] = tree_in(i, least_mm, most_mm);
    wd_trees_pack(packed, trees, TREES, VARIANTS);
    for (uint32_t i = 0; i < TREES; i++) {
        struct wd_tree tree = unpacked(packed, i);
        assert_true(off_mm(tree.x_mm, trees[i].x_mm) <= across_mm);
        assert_true(off_mm(tree.y_mm, trees[i].y_mm) <= across_mm);
        assert_true(off_mm(tree.z_mm, trees[i].z_mm) <= up_mm);
        assert_int_equal(tree.kind, trees[i].kind);
        assert_int_equal(tree.size, trees[i].size);
        assert_int_equal(tree.look, trees[i].look);
        assert_int_equal(wd_tree_random(tree), wd_tree_random(trees[i]));
    }
    free(packed);
    free(trees);
}

static void places_come_back(void **state)
{
    (void)state;
    /* a stand; 50 km of mountains; all that whole millimetres reach */
    check((int64_t[3]){1000, -2000, -500}, (int64_t[3]){2000000, 2000000, 260000}, 0, 0);
    check((int64_t[3]){0, 0, 0}, (int64_t[3]){50000000, 50000000, 4500000}, 12, 9);
    check((int64_t[3]){INT32_MIN, INT32_MIN, -9000000}, (int64_t[3]){INT32_MAX, INT32_MAX, 9000000},
          1025, 35);
}

/* A herb and a redwood, wherever they stand. */
static void sizes_come_back(void **state)
{
    (void)state;
    struct wd_tree trees[2] = {{.x_mm = 5, .size = 10u | 3u << 16},
                               {.x_mm = 400000000, .size = 11500u | 4000u << 16}};
    struct wd_packed_tree packed[3];
    wd_trees_pack(packed, trees, 2, 1);
    for (uint32_t i = 0; i < 2; i++)
        assert_int_equal(unpacked(packed, i).size, trees[i].size);
}

static void a_million_trees_take_16_mb(void **state)
{
    (void)state;
    size_t bytes = wd_packed_count(1000000) * sizeof(struct wd_packed_tree);
    assert_in_range(bytes, 16000000, 16020000);
    assert_int_equal(wd_packed_count(0), 0);
    assert_int_equal(wd_packed_count(1024), 1025);
    assert_int_equal(wd_packed_count(1025), 1027);
}

static void models_are_limited(void **state)
{
    (void)state;
    assert_true(wd_packed_models_fit(2048, 1));
    assert_false(wd_packed_models_fit(2049, 1));
    assert_true(wd_packed_models_fit(256, VARIANTS)); /* three bits of variants */
    assert_false(wd_packed_models_fit(257, VARIANTS));
    assert_true(wd_packed_models_fit(8, 256));
}

/* Trees of one size that all face one way are still told apart by chance: random numbers spread over
 * all bits. */
static void random_numbers_differ(void **state)
{
    (void)state;
    uint32_t ones[32] = {0}, count = 0;
    for (uint32_t facing = 0; facing < 32; facing++) {
        for (uint32_t tint = 96; tint < 160; tint++, count++) {
            const struct wd_tree tree = {.size = 150u | 100u << 16,
                                         .look = WD_TREE_LOOK(4096u + facing, tint, 0u)};
            for (uint32_t bit = 0; bit < 32; bit++)
                ones[bit] += wd_tree_random(tree) >> bit & 1u;
        }
    }
    for (uint32_t bit = 0; bit < 32; bit++)
        assert_in_range(ones[bit], count / 2 - 113, count / 2 + 113); /* five deviations */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(places_come_back),
        cmocka_unit_test(sizes_come_back),
        cmocka_unit_test(a_million_trees_take_16_mb),
        cmocka_unit_test(models_are_limited),
        cmocka_unit_test(random_numbers_differ),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
