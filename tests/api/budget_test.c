/* The controller of frame time, fed by a made cost: no clock, no device. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "weald/renderer.h"

enum { FRAMES = 80, LATEST = 2 };
static const double TARGET_MS = 40.0;

/* A frame costs fixed_ms + discs_ms / error^2, +- noise, and its time is told `late` frames on. */
struct cost {
    double fixed_ms, discs_ms, noise;
    uint32_t late;
};

struct run {
    double error_px[FRAMES + 1], ms[FRAMES]; /* ms: without noise */
};

static double noise_of(uint32_t frame)
{
    uint32_t bits = (frame + 1u) * 2654435761u;
    return (double)(bits >> 8) / (double)(1u << 24) * 2.0 - 1.0;
}

static void run_frames(struct run *run, const struct cost *cost, const struct cost *after,
                       uint32_t change)
{
    struct wd_budget budget = wd_budget_of(TARGET_MS);
    run->error_px[0] = budget.error_px;
    for (uint32_t i = 0; i < FRAMES; i++) {
        const struct cost *now = i < change ? cost : after;
        uint32_t told = i > now->late ? i - now->late : 0;
        double error = run->error_px[told];
        double ms = now->fixed_ms + now->discs_ms / (error * error);
        run->ms[i] = now->fixed_ms + now->discs_ms / (run->error_px[i] * run->error_px[i]);
        run->error_px[i + 1] = wd_budget_next(&budget, ms * (1.0 + now->noise * noise_of(i)));
    }
}

/* Costs of which discs are `share` at the target, which an error of `error_px` meets. */
static struct cost cost_meeting(double error_px, double share, uint32_t late, double noise)
{
    return (struct cost){.fixed_ms = 0.92 * TARGET_MS * (1.0 - share),
                         .discs_ms = 0.92 * TARGET_MS * share * error_px * error_px,
                         .late = late,
                         .noise = noise};
}

static void expect_held(const struct run *run, uint32_t from, uint32_t to)
{
    for (uint32_t i = from; i < to; i++) {
        if (run->ms[i] > TARGET_MS * 1.02 || run->ms[i] < TARGET_MS * 0.8)
            fail_msg("frame %u takes %.1f of %.1f ms", i, run->ms[i], TARGET_MS);
    }
}

static void any_cost_is_held_within_eight_frames(void **state)
{
    static const double shares[] = {0.3, 0.5, 0.8, 1.0}, errors[] = {0.9, 4.0, 7.0};
    (void)state;
    for (int i = 0; i < 4 * 3 * (LATEST + 1); i++) {
        const struct cost cost =
            cost_meeting(errors[i / 4 % 3], shares[i % 4], (uint32_t)(i / 12), 0.0);
        struct run run;
        run_frames(&run, &cost, &cost, 0);
        expect_held(&run, 8, FRAMES);
        for (int k = 16; k < FRAMES; k++)
            assert_true(run.error_px[k] == run.error_px[k + 1]); /* at rest */
    }
}

static void a_jump_in_cost_is_met_and_left_again(void **state)
{
    (void)state;
    const struct cost calm = cost_meeting(1.5, 0.7, 1, 0.0), dear = cost_meeting(5.0, 0.7, 1, 0.0);
    struct run run;
    run_frames(&run, &calm, &dear, 40);
    expect_held(&run, 8, 40);
    assert_true(run.ms[40] > 2.0 * TARGET_MS);
    expect_held(&run, 49, FRAMES);
    run_frames(&run, &dear, &calm, 40);
    expect_held(&run, 49, FRAMES);
}

/* Noise of 5 % must not make the picture breathe. */
static void noise_is_not_followed(void **state)
{
    (void)state;
    const struct cost cost = cost_meeting(3.0, 0.7, 1, 0.05);
    struct run run;
    uint32_t changes = 0;
    run_frames(&run, &cost, &cost, 0);
    for (int i = 16; i < FRAMES; i++) {
        changes += run.error_px[i] != run.error_px[i + 1];
        assert_true(fabs(run.error_px[i + 1] / run.error_px[i] - 1.0) < 0.08);
    }
    assert_in_range(changes, 0, 4);
}

/* What no error can meet ends at the bounds, and comes back from them. */
static void bounds_hold(void **state)
{
    (void)state;
    const struct cost dear = {.fixed_ms = 10.0 * TARGET_MS, .discs_ms = 1.0};
    const struct cost cheap = {.fixed_ms = 0.01, .discs_ms = 0.01};
    struct run run;
    run_frames(&run, &dear, &cheap, 40);
    assert_true(run.error_px[40] == WD_MOST_ERROR_PX);
    assert_true(run.error_px[FRAMES] == WD_LEAST_ERROR_PX);
}

static void times_that_are_none_change_nothing(void **state)
{
    (void)state;
    struct wd_budget budget = wd_budget_of(TARGET_MS);
    const double odd[] = {0.0, -1.0, NAN, INFINITY};
    for (int i = 0; i < 4; i++)
        assert_true(wd_budget_next(&budget, odd[i]) == wd_budget_of(TARGET_MS).error_px);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_cost_is_held_within_eight_frames),
        cmocka_unit_test(a_jump_in_cost_is_met_and_left_again),
        cmocka_unit_test(noise_is_not_followed),
        cmocka_unit_test(bounds_hold),
        cmocka_unit_test(times_that_are_none_change_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
