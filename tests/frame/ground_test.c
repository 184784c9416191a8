/* What lies on the ground: its mean, and how far off it is seen. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "shared/ground_cover.h"
#include "shared/hash.h"

static struct wd_frame_uniforms palette(void)
{
    return (struct wd_frame_uniforms){
        .grass = {0.075f, 0.105f, 0.035f}, .litter = {0.1f, 0.07f, 0.045f}, .soil = {0.13f, 0.095f, 0.065f},
        .rock = {0.2f, 0.19f, 0.175f}, .rock_slope = 0.84f, .tree_line_m = 5000, .snow_line_m = 9000, .water_level_m = -1e9f};
}

/* Of level ground under a sun 53 degrees high: the light that it reflects in three colours, and how far green spreads
 * about its mean, over that. `woods`: 1 under trees, 0 in the open. */
struct lit {
    double mean[3], spread;
};

static struct lit lit_ground(float woods, float footprint_m)
{
    enum { PLACES = 60000 };
    struct wd_frame_uniforms frame = palette();
    struct lit lit = {0};
    double squares = 0;
    for (uint32_t i = 0; i < PLACES; i++) {
        struct wd_vec3 rel = {3000 * wd_hash_unit(wd_hash2(i, 1)) - 1500, 3000 * wd_hash_unit(wd_hash2(i, 2)) - 1500, 0};
        struct wd_ground_look look = wd_ground_cover(&frame, rel, 0, 0, woods, woods, 0, -1e9f, footprint_m);
        double sun = fmax(0.6 * (double)look.normal.x + 0.8 * (double)look.normal.z, 0);
        const double light[3] = {look.albedo.x * sun, look.albedo.y * sun, look.albedo.z * sun};
        for (int k = 0; k < 3; k++)
            lit.mean[k] += light[k] / PLACES;
        squares += light[1] * light[1] / PLACES;
    }
    lit.spread = sqrt(squares / (lit.mean[1] * lit.mean[1]) - 1);
    return lit;
}

/* Leaves took up to 7 % of the ground's light where pixels showed them, blades up to 4. */
static void ground_is_as_bright_with_its_leaves_as_without(void **state)
{
    (void)state;
    for (int woods = 0; woods < 2; woods++) {
        struct lit far = lit_ground((float)woods, 0.4f), near = lit_ground((float)woods, 0.012f);
        for (int k = 0; k < 3; k++) {
            print_message("%.3f ", near.mean[k] / far.mean[k]);
            assert_float_equal(near.mean[k] / far.mean[k], 1, 0.012);
        }
    }
    print_message("\n");
}

/* From eye height a pixel of 540 lines over 60 degrees is as wide as 35 mm squared 8 m off: alone it shows little of the
 * leaves, one of four samples all of them. */
static void samples_show_leaves_that_pixels_do_not(void **state)
{
    (void)state;
    struct lit one = lit_ground(1, 0.035f), four = lit_ground(1, 0.035f * wd_sample_footprint(4));
    print_message("spread %.2f, of four samples %.2f\n", one.spread, four.spread);
    assert_true(four.spread > 1.5 * one.spread);
    assert_float_equal(wd_sample_footprint(0), 1, 0);
    assert_float_equal(wd_sample_footprint(64), wd_sample_footprint(4), 0);
}

static double green_at(const struct wd_frame_uniforms *frame, float layers, float away_m)
{
    return (double)wd_ground_cover(frame, WD_V3(away_m, 0.3f, 0), 0, 0, 0, 0, layers, -1e9f, 0.4f).albedo.y;
}

/* The ground has their colour from where plants are no longer drawn, as far as they stand close and fade. */
static void ground_has_the_colour_of_plants_too_far_to_be_drawn(void **state)
{
    (void)state;
    struct wd_frame_uniforms bare = palette(), meadow = palette();
    const float dark = 0.01f;
    for (int k = 0; k < 3; k++)
        meadow.sward[k] = dark;
    meadow.sward_share = 1;
    meadow.sward_whole_m = 30;
    meadow.sward_gone_m = 60;
    double lawn = green_at(&bare, 3, 70);
    assert_float_equal(green_at(&meadow, 3, 29), green_at(&bare, 3, 29), 0);
    assert_float_equal(green_at(&meadow, 0, 70), lawn, 0);
    assert_true(green_at(&meadow, 20, 70) < 1.5 * (double)dark);
    double some = green_at(&meadow, 0.7f, 70); /* they leave half of the ground open */
    assert_true(some > 0.45 * lawn && some < 0.65 * lawn + (double)dark);
    meadow.sward_share = 0;
    assert_float_equal(green_at(&meadow, 3, 70), lawn, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ground_is_as_bright_with_its_leaves_as_without),
        cmocka_unit_test(samples_show_leaves_that_pixels_do_not),
        cmocka_unit_test(ground_has_the_colour_of_plants_too_far_to_be_drawn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
