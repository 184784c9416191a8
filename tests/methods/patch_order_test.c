#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "shared/hash.h"

static const uint32_t *first_of_cells;
#define WD_PATCH_FIRST(cell) first_of_cells[cell]
#include "shared/patch_order.h"

enum { SIDE = 13 };

static struct wd_patch_order order_for(double eye_x, double eye_y, uint32_t by_columns)
{
    double column = fmin(fmax(floor(eye_x), 0.0), SIDE), row = fmin(fmax(floor(eye_y), 0.0), SIDE);
    return (struct wd_patch_order){SIDE, SIDE, (uint32_t)column, (uint32_t)row, by_columns};
}

static void every_cell_comes_once(void **state)
{
    (void)state;
    for (int eye = -1; eye <= SIDE; eye++) {
        for (uint32_t by = 0; by < 2; by++) {
            struct wd_patch_order order = order_for(eye + 0.5, SIDE / 2.0 - eye, by);
            uint8_t seen[SIDE * SIDE] = {0};
            for (uint32_t i = 0; i < SIDE * SIDE; i++) {
                uint32_t cell = wd_patch_cell(order, i);
                assert_true(cell < SIDE * SIDE);
                seen[cell]++;
            }
            for (uint32_t i = 0; i < SIDE * SIDE; i++)
                assert_int_equal(seen[i], 1);
        }
    }
}

/* Along any ray from the eye the cells come from the back. */
static void rays_meet_cells_from_the_back(void **state)
{
    (void)state;
    for (uint32_t trial = 0; trial < 4000; trial++) {
        double eye_x = wd_hash_unit(wd_hash2(trial, 1)) * 33.0 - 10.0;
        double eye_y = wd_hash_unit(wd_hash2(trial, 2)) * 33.0 - 10.0;
        double angle = wd_hash_unit(wd_hash2(trial, 3)) * 6.2831853;
        struct wd_patch_order order = order_for(eye_x, eye_y, trial & 1u);
        uint32_t rank[SIDE * SIDE], last = UINT32_MAX, cell = UINT32_MAX;
        for (uint32_t i = 0; i < SIDE * SIDE; i++)
            rank[wd_patch_cell(order, i)] = i;
        for (double at = 0.0; at < 50.0; at += 0.01) {
            double x = floor(eye_x + at * cos(angle)), y = floor(eye_y + at * sin(angle));
            if (x < 0.0 || y < 0.0 || x >= SIDE || y >= SIDE)
                continue;
            uint32_t now = (uint32_t)y * SIDE + (uint32_t)x;
            if (now != cell)
                assert_true(rank[now] < last);
            cell = now;
            last = rank[now];
        }
    }
}

/* Trees in some cells only come as the cells that hold them would, each once. */
static void trees_come_as_their_cells(void **state)
{
    (void)state;
    for (uint32_t trial = 0; trial < 300; trial++) {
        double eye[2];
        uint32_t first[SIDE * SIDE + 1] = {0}, by_columns = trial & 1u, last_rank = 0;
        uint8_t seen[7 * SIDE * SIDE] = {0};
        for (uint32_t i = 0; i < SIDE * SIDE; i++) {
            uint32_t dice = wd_hash2(trial, i) % 8;
            first[i + 1] = first[i] + (dice < trial % 6 ? 0 : dice - trial % 6);
        }
        for (uint32_t k = 0; k < 2; k++)
            eye[k] = wd_hash_unit(wd_hash2(trial, 500 + k)) * 20.0 - 3.0;
        struct wd_patch_order order = order_for(eye[0], eye[1], by_columns);
        uint32_t rank[SIDE * SIDE];
        for (uint32_t i = 0; i < SIDE * SIDE; i++)
            rank[wd_patch_cell(order, i)] = i;
        first_of_cells = first;
        for (uint32_t i = 0; i < first[SIDE * SIDE]; i++) {
            uint32_t line = by_columns ? order.before_column : order.before_row, cell = 0;
            uint32_t at = wd_patch_tree(
                SIDE, line, by_columns ? order.before_row : order.before_column, i);
            assert_true(at < first[SIDE * SIDE] && !seen[at]);
            seen[at] = 1;
            while (first[cell + 1] <= at)
                cell++;
            if (by_columns)
                cell = cell % SIDE * SIDE + cell / SIDE;
            assert_true(rank[cell] >= last_rank);
            last_rank = rank[cell];
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_cell_comes_once),
        cmocka_unit_test(rays_meet_cells_from_the_back),
        cmocka_unit_test(trees_come_as_their_cells),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
