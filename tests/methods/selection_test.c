#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "frame/view.h"
#include "methods/continuum_view.h"
#include "methods/selection.h"

static const struct wd_level_rule RULE = {60.0f, 200.0f, 0.25f, WD_LEVEL_MESH};

/* G7: at every distance some level is whole, so that the background never leaks through. */
static void one_level_is_always_whole(void **state)
{
    (void)state;
    for (float distance = 0.0f; distance < 600.0f; distance += 0.37f) {
        for (float height = 1.0f; height < 60.0f; height += 7.0f) {
            struct wd_levels levels = wd_levels_at(&RULE, height, distance);
            float most = 0.0f;
            for (int i = 0; i < 3; i++) {
                assert_true(levels.show[i] >= 0.0f && levels.show[i] <= 1.0f);
                most = fmaxf(most, levels.show[i]);
            }
            assert_true(most == 1.0f);
        }
    }
}

static void levels_follow_each_other(void **state)
{
    (void)state;
    struct wd_levels near = wd_levels_at(&RULE, 20.0f, 10.0f);
    assert_true(near.show[WD_LEVEL_MESH] == 1.0f && near.show[WD_LEVEL_REDUCED] == 0.0f &&
                near.show[WD_LEVEL_CARD] == 0.0f);
    struct wd_levels middle = wd_levels_at(&RULE, 20.0f, 120.0f);
    assert_true(middle.show[WD_LEVEL_MESH] == 0.0f && middle.show[WD_LEVEL_REDUCED] == 1.0f &&
                middle.show[WD_LEVEL_CARD] == 0.0f);
    struct wd_levels far = wd_levels_at(&RULE, 20.0f, 260.0f);
    assert_true(far.show[WD_LEVEL_MESH] == 0.0f && far.show[WD_LEVEL_REDUCED] == 0.0f &&
                far.show[WD_LEVEL_CARD] == 1.0f);
    /* a tree half as high changes at half the distance */
    assert_true(wd_levels_at(&RULE, 10.0f, 130.0f).show[WD_LEVEL_CARD] == 1.0f);
}

static void beyond_the_card_distance_there_are_cards_only(void **state)
{
    (void)state;
    for (float height = 2.0f; height <= 40.0f; height += 2.0f) {
        float distance = wd_level_card_distance(&RULE, 40.0f);
        struct wd_levels levels = wd_levels_at(&RULE, height, distance + 0.01f);
        assert_true(levels.show[WD_LEVEL_MESH] == 0.0f && levels.show[WD_LEVEL_REDUCED] == 0.0f);
    }
}

static void far_cascades_take_coarser_levels(void **state)
{
    (void)state;
    struct wd_level_rule cards = RULE;
    cards.finest = WD_LEVEL_CARD;
    assert_true(wd_levels_at(&cards, 20.0f, 1.0f).show[WD_LEVEL_CARD] == 1.0f);
    assert_true(wd_levels_at(&cards, 20.0f, 1.0f).show[WD_LEVEL_MESH] == 0.0f);
    struct wd_level_rule reduced = {0.0f, 60.0f, 0.25f, WD_LEVEL_REDUCED};
    assert_true(wd_levels_at(&reduced, 20.0f, 1.0f).show[WD_LEVEL_REDUCED] == 1.0f);
}

static float scale_of(uint32_t lines, double fov_deg)
{
    const struct wd_view_params params = {
        .camera = {.fov_rad = fov_deg * 0.017453292519943295}, .width = 800, .height = lines,
        .near_m = 0.1f};
    struct wd_view view;
    wd_view_init(&view, &params);
    return view.lod_scale;
}

/* Levels change at the same size in pixels in pictures as large as the one that distances are meant
 * for, and larger ones; small ones lose nothing. */
static void distances_follow_pixels(void **state)
{
    (void)state;
    assert_float_equal(scale_of(600, 60), 1, 1e-5);
    assert_float_equal(scale_of(1200, 60), 2, 1e-5);
    assert_float_equal(scale_of(600, 30), tan(0.5235987755982988) / tan(0.2617993877991494), 1e-4);
    assert_true(scale_of(150, 60) == 1 && scale_of(600, 90) == 1);
}

/* Pictures of several samples resolve what is finer: leaves thin out later, and continuum draws meshes
 * farther out, unless its error is bounded. */
static void samples_show_finer_things(void **state)
{
    (void)state;
    struct wd_scene scene = {.quality.leaf_px = 3, .methods.continuum = {.density = 0.5, .near_px = 8}};
    const struct wd_forest_device forest = {.scene = &scene};
    const struct wd_continuum_forest discs = {.coarsest_m = 1};
    struct wd_view_params params = {.camera = {.fov_rad = 1}, .width = 800, .height = 600,
                                    .near_m = 0.1f};
    float leaf[3], reach[3], bounded[3];
    for (int i = 0; i < 3; i++) {
        struct wd_view view;
        params.samples = i == 0 ? 1 : i == 1 ? 4 : 16;
        wd_view_init(&view, &params);
        struct wd_tree_draw draw = {.forest = &forest, .view = &view, .pass = WD_PASS_CAMERA};
        leaf[i] = wd_leaf_pixels(&forest, &view, WD_PASS_CAMERA);
        reach[i] = wd_continuum_near_rule(&draw, &discs).reach;
        draw.max_error_px = 1.4142136f;
        bounded[i] = wd_continuum_near_rule(&draw, &discs).reach;
    }
    assert_float_equal(leaf[1] / leaf[0], 2, 1e-5);
    assert_float_equal(leaf[2] / leaf[0], 4, 1e-5);
    assert_float_equal(reach[1] / reach[0], 3.340352, 1e-5);
    assert_float_equal(reach[2] / reach[0], 10, 1e-4);
    assert_float_equal(bounded[2] / bounded[0], 1, 1e-6);
    assert_float_equal(bounded[0] / reach[0], 1, 1e-4);
}

static void ranges_that_touch_become_one(void **state)
{
    (void)state;
    struct wd_selection selection = {0};
    wd_selection_add_range(&selection, &(struct wd_range){0, 10, 12});
    wd_selection_add_range(&selection, &(struct wd_range){10, 25, 12});
    wd_selection_add_range(&selection, &(struct wd_range){25, 25, 12});
    wd_selection_add_range(&selection, &(struct wd_range){30, 31, 12});
    wd_selection_add_range(&selection, &(struct wd_range){31, 40, 8});
    assert_int_equal(selection.range_count, 3);
    assert_int_equal(selection.ranges[0].end, 25);
    assert_int_equal(selection.ranges[1].begin, 30);
    wd_selection_finish(&selection);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_level_is_always_whole),
        cmocka_unit_test(levels_follow_each_other),
        cmocka_unit_test(beyond_the_card_distance_there_are_cards_only),
        cmocka_unit_test(far_cascades_take_coarser_levels),
        cmocka_unit_test(distances_follow_pixels),
        cmocka_unit_test(samples_show_finer_things),
        cmocka_unit_test(ranges_that_touch_become_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
