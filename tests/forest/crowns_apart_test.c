/* Crowns that stand at random, in rows, in groups. */
#include "forest/crowns_apart.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

enum { SIDE = 32 /* squares */, MOST = 4096 };
static const double CELL_M = 8;
static const float CROWN_M = 5;

static struct wd_tree trees[MOST];
static size_t count;

static void plant(double x_m, double y_m)
{
    trees[count++] = (struct wd_tree){.x_mm = (int32_t)lround(x_m * 1000), .y_mm = (int32_t)lround(y_m * 1000),
                                      .size = 1500u | (uint32_t)(100 * CROWN_M) << 16};
}

static double drawn(void)
{
    static uint64_t state = 7;
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (double)(state >> 33) / 2147483648.0;
}

/* Mean over the squares within. */
static double apart(void)
{
    float outline[SIDE * SIDE];
    struct wd_world world = {.trees = trees, .tree_count = count};
    double squares_m2 = SIDE * SIDE * CELL_M * CELL_M, sum = 0;
    double each = 0.25 * 3.14159265 * (double)(CROWN_M * CROWN_M) * (double)count / squares_m2;
    for (int i = 0; i < SIDE * SIDE; i++)
        outline[i] = (float)each;
    const struct wd_crown_grid grid = {.outline = outline, .width = SIDE, .height = SIDE, .cell_m = CELL_M};
    float *found = wd_crowns_apart(&world, &grid);
    for (int i = 0; i < SIDE * SIDE; i++)
        sum += (double)found[i];
    free(found);
    return sum / (SIDE * SIDE);
}

static void crowns_at_random_cover_as_chance_does(void **state)
{
    (void)state;
    count = 0;
    while (count < MOST)
        plant(drawn() * SIDE * CELL_M, drawn() * SIDE * CELL_M);
    assert_float_equal(apart(), 1, 0.06);
}

/* Discs of 5 m every 5 m leave 1 - pi / 4 of the ground free: -ln of that is 1.54, of outlines of pi / 4. */
static void crowns_in_rows_cover_more(void **state)
{
    (void)state;
    count = 0;
    for (double y = 2.5; y < SIDE * CELL_M; y += 5)
        for (double x = 2.5; x < SIDE * CELL_M; x += 5)
            plant(x, y);
    assert_float_equal(apart(), 1.54 / 0.785, 0.06);
}

static void crowns_in_groups_cover_less(void **state)
{
    (void)state;
    count = 0;
    while (count + 4 <= MOST) {
        double x = drawn() * SIDE * CELL_M, y = drawn() * SIDE * CELL_M;
        for (int i = 0; i < 4; i++)
            plant(x + drawn(), y + drawn());
    }
    assert_true(apart() < 0.6);
}

static void open_ground_has_no_say(void **state)
{
    (void)state;
    count = 0;
    double found = apart();
    assert_true(found > 0.9 && found < 1.1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(crowns_at_random_cover_as_chance_does),
        cmocka_unit_test(crowns_in_rows_cover_more),
        cmocka_unit_test(crowns_in_groups_cover_less),
        cmocka_unit_test(open_ground_has_no_say),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
