/* What a view's frustum holds. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "frame/view.h"

enum { WIDTH = 320, HEIGHT = 200 };

static const float AWAY_M = 30.0f;

/* Whether the frustum holds the point that many metres off which the picture shows at a place, in pixels. */
static bool holds(const struct wd_view *view, double x_px, double y_px)
{
    float rel_from_clip[4][4], point[3], clip[4];
    const float ndc[2] = {(float)(2.0 * x_px / WIDTH - 1.0), (float)(2.0 * y_px / HEIGHT - 1.0)};
    float matrix[4][4];
    for (int k = 0; k < 16; k++)
        matrix[k / 4][k % 4] = view->clip_from_rel[k / 4][k % 4];
    wd_matrix_invert(rel_from_clip, matrix);
    for (int k = 0; k < 3; k++)
        point[k] = AWAY_M * (rel_from_clip[0][k] * ndc[0] + rel_from_clip[1][k] * ndc[1] + rel_from_clip[3][k]);
    for (int row = 0; row < 4; row++)
        clip[row] = matrix[0][row] * point[0] + matrix[1][row] * point[1] + matrix[2][row] * point[2] + matrix[3][row];
    assert_float_equal(clip[0] / clip[3], ndc[0], 1e-4);
    assert_float_equal(clip[1] / clip[3], ndc[1], 1e-4);
    return wd_frustum_box(&view->frustum, point, point) != WD_OUTSIDE;
}

/* However far the picture is shifted, all of it and no more. */
static void frusta_hold_the_picture(void **state)
{
    (void)state;
    static const float offsets[][2] = {{0, 0},   {0.49f, -0.49f}, {-0.3f, 0.4f}, {40, 0},
                                       {-40, 0}, {0, 25.3f},      {0, -25.3f},   {-61.7f, 33.2f}};
    for (size_t i = 0; i < sizeof offsets / sizeof *offsets; i++) {
        struct wd_view view;
        wd_view_init(&view, &(struct wd_view_params){.camera = {{10, 20, 30}, 0.7, -0.2, 1.0},
                                                     .width = WIDTH,
                                                     .height = HEIGHT,
                                                     .near_m = 0.1f,
                                                     .offset_px = {offsets[i][0], offsets[i][1]}});
        assert_true(holds(&view, 0.5 * WIDTH, 0.5 * HEIGHT));
        for (int k = 0; k < 9; k++) {
            double x = k / 8.0 * WIDTH, y = k / 8.0 * HEIGHT;
            assert_true(holds(&view, 0.05, y) && holds(&view, WIDTH - 0.05, y));
            assert_true(holds(&view, x, 0.05) && holds(&view, x, HEIGHT - 0.05));
            assert_true(!holds(&view, -1.5, y) && !holds(&view, WIDTH + 1.5, y));
            assert_true(!holds(&view, x, -1.5) && !holds(&view, x, HEIGHT + 1.5));
        }
    }
}

/* So that what is chosen for one is kept for the next. */
static void places_in_a_pixel_share_a_frustum(void **state)
{
    (void)state;
    struct wd_view_params params = {
        .camera = {{10, 20, 30}, 0.7, -0.2, 1.0}, .width = WIDTH, .height = HEIGHT, .near_m = 0.1f};
    struct wd_view middle, other;
    wd_view_init(&middle, &params);
    params.offset_px[0] = 0.4f;
    params.offset_px[1] = -0.45f;
    wd_view_init(&other, &params);
    assert_memory_equal(&middle.frustum, &other.frustum, sizeof middle.frustum);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frusta_hold_the_picture),
        cmocka_unit_test(places_in_a_pixel_share_a_frustum),
    };
    return cmocka_run_group_tests_name("view", tests, NULL, NULL);
}
