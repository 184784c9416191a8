#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "frame_test.h"

/* Up to cells of 17 pixels: then the far half of the grove is clusters either way. */
enum { OVER, STEPS = 19 };

static const char *root;

static size_t changed_pixels(const struct frame_picture *a, const struct frame_picture *b)
{
    size_t changed = 0;
    for (size_t i = 0; i < (size_t)a->width * a->height; i++)
        changed += a->surface[i] != b->surface[i] || a->depth[i] != b->depth[i];
    return changed;
}

/* Pixels that change at once, at most, while ever larger cells may stand for trees; `sum` of all. */
static size_t largest_step(struct frame_test *test, bool faithful, size_t *sum)
{
    struct wd_impostor_options *options = &test->scene.methods.impostor;
    struct frame_picture before, now;
    size_t largest = 0;
    *sum = 0;
    options->faithful = faithful;
    for (int i = 0; i <= STEPS; i++) {
        options->area_px = 2 * pow(1.3, i);
        frame_test_draw(test, "impostor", OVER, &now);
        if (i > 0) {
            size_t changed = changed_pixels(&before, &now);
            largest = changed > largest ? changed : largest;
            *sum += changed;
            frame_picture_finish(&before);
        }
        before = now;
    }
    frame_picture_finish(&before);
    return largest;
}

/* Row G4's fault: a cluster shows or hides as a whole. */
static void clusters_give_way_octant_by_octant(void **state)
{
    static const char *const settings[] = {
        "methods.impostor.cluster_trees=200", "methods.impostor.cluster_size=12",
        "quality.mesh_distance_m=5", "quality.reduced_distance_m=10", NULL};
    (void)state;
    struct frame_test test;
    frame_test_init(&test, root, &(struct frame_test_params){.settings = settings});
    size_t all_at_once, all_in_parts;
    size_t at_once = largest_step(&test, true, &all_at_once);
    size_t in_parts = largest_step(&test, false, &all_in_parts);
    print_message("pixels changed: at most %zu of %zu at once, %zu of %zu in parts\n", at_once,
                  all_at_once, in_parts, all_in_parts);
    assert_true(in_parts > 0 && 10 * in_parts < 7 * at_once);
    frame_test_finish(&test);
}

/* Pixels of trees in `picture` that lie above all trees of the other in their columns. */
static size_t pixels_above(const struct frame_picture *picture, const struct frame_picture *other)
{
    size_t above = 0;
    for (uint32_t x = 0; x < picture->width; x++) {
        for (uint32_t y = 0; y < picture->height; y++) {
            size_t at = (size_t)y * picture->width + x;
            if (other->surface[at])
                break;
            above += picture->surface[at] != 0;
        }
    }
    return above;
}

static size_t pixels_of_trees(const struct frame_picture *picture)
{
    size_t count = 0;
    for (size_t i = 0; i < (size_t)picture->width * picture->height; i++)
        count += picture->surface[i] != 0;
    return count;
}

/* A crown's tip that reaches into a cell covers no more than its own height of it. */
static void cells_end_where_trees_do(void **state)
{
    static const char *const settings[] = {
        "methods.impostor.cluster_trees=200", "methods.impostor.cluster_size=6",
        "quality.mesh_distance_m=5", "quality.reduced_distance_m=10", NULL};
    (void)state;
    struct frame_test test;
    struct frame_picture cards, cells;
    frame_test_init(&test, root, &(struct frame_test_params){.settings = settings});
    test.scene.methods.impostor.area_px = 2000;
    frame_test_draw(&test, "octree", OVER, &cards);
    frame_test_draw(&test, "impostor", OVER, &cells);
    size_t above = pixels_above(&cells, &cards);
    size_t shown = pixels_of_trees(&cells), all = pixels_of_trees(&cards);
    print_message("cells: %zu pixels of trees of %zu; %zu above these\n", shown, all, above);
    assert_true(20 * above < all && 20 * shown > 19 * all);
    frame_picture_finish(&cards);
    frame_picture_finish(&cells);
    frame_test_finish(&test);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(cells_end_where_trees_do),
                                       cmocka_unit_test(clusters_give_way_octant_by_octant)};
    root = argc > 1 ? argv[1] : ".";
    return cmocka_run_group_tests(tests, NULL, frame_tests_finish);
}
