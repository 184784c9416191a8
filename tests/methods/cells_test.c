#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "methods/cells.h"
#include "shared/hash.h"

enum { TREES = 3000 };

static struct wd_world scattered(struct wd_tree *trees)
{
    for (uint32_t i = 0; i < TREES; i++)
        trees[i] = (struct wd_tree){.x_mm = (int32_t)(wd_hash2(i, 1) % 400000u) - 100000,
                                    .y_mm = (int32_t)(wd_hash2(i, 2) % 250000u) + 50000,
                                    .z_mm = (int32_t)(wd_hash2(i, 3) % 9000u),
                                    .id = i + 1,
                                    .size = 1200u | 500u << 16};
    return (struct wd_world){.trees = trees, .tree_count = TREES};
}

static void every_tree_stands_in_its_cell(void **state)
{
    (void)state;
    static struct wd_tree trees[TREES];
    static uint8_t seen[TREES];
    const struct wd_world world = scattered(trees);
    struct wd_cells cells;
    memset(seen, 0, sizeof seen);
    wd_cells_init(&cells, &world, 17.0);
    for (uint32_t i = 0; i < cells.columns * cells.rows; i++) {
        double west = cells.min_m[0] + i % cells.columns * cells.cell_m;
        double south = cells.min_m[1] + i / cells.columns * cells.cell_m;
        for (uint32_t k = cells.first[i]; k < cells.first[i + 1]; k++) {
            const struct wd_tree *tree = &trees[cells.trees[k]];
            double x = tree->x_mm * 0.001, y = tree->y_mm * 0.001;
            seen[cells.trees[k]]++;
            assert_true(x >= west - 1e-9 && x < west + cells.cell_m + 1e-9);
            assert_true(y >= south - 1e-9 && y < south + cells.cell_m + 1e-9);
            assert_true(cells.boxes[i].min_m[2] <= (float)(tree->z_mm * 0.001) + 1e-3f);
            assert_true(cells.boxes[i].max_m[2] >= (float)(tree->z_mm * 0.001) + 11.99f);
        }
    }
    for (uint32_t i = 0; i < TREES; i++)
        assert_int_equal(seen[i], 1);
    wd_cells_finish(&cells);
}

static void cells_hold_as_many_as_asked_in_the_mean(void **state)
{
    (void)state;
    static struct wd_tree trees[TREES];
    const struct wd_world world = scattered(trees);
    struct wd_cells cells;
    wd_cells_init(&cells, &world, wd_cells_size(&world, 100.0));
    uint32_t filled = 0;
    for (uint32_t i = 0; i < cells.columns * cells.rows; i++)
        filled += cells.first[i + 1] > cells.first[i];
    assert_in_range(TREES / filled, 60, 140);
    wd_cells_finish(&cells);
}

static void one_tree_is_one_cell(void **state)
{
    (void)state;
    struct wd_tree tree = {.x_mm = 5, .y_mm = 5, .size = 100u | 100u << 16};
    const struct wd_world world = {.trees = &tree, .tree_count = 1};
    struct wd_cells cells;
    wd_cells_init(&cells, &world, wd_cells_size(&world, 64.0));
    assert_int_equal(cells.columns * cells.rows, 1);
    assert_int_equal(cells.first[1], 1);
    wd_cells_finish(&cells);
}

/* Memory stays bounded whatever the cell's size. */
static void tiny_cells_become_larger(void **state)
{
    (void)state;
    static struct wd_tree trees[TREES];
    const struct wd_world world = scattered(trees);
    struct wd_cells cells;
    wd_cells_init(&cells, &world, 0.001);
    assert_true((uint64_t)cells.columns * cells.rows <= 1u << 24);
    assert_int_equal(cells.first[cells.columns * cells.rows], TREES);
    wd_cells_finish(&cells);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_tree_stands_in_its_cell),
        cmocka_unit_test(cells_hold_as_many_as_asked_in_the_mean),
        cmocka_unit_test(one_tree_is_one_cell),
        cmocka_unit_test(tiny_cells_become_larger),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
