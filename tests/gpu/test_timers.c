#include "gpu_test.h"

static const uint32_t spin_comp[] =
#include "spin.comp.inc"
    ;

struct spinner {
    struct wd_pipeline pipeline;
    struct wd_buffer buffer;
};

static struct spinner make_spinner(struct gpu_test *test)
{
    return (struct spinner){make_compute(test, SPIRV(spin_comp), BINDINGS(STORAGE), 4),
                            make_buffer(test, 64 * 64 * 4)};
}

static void spin(struct wd_cmd *cmd, struct spinner *spinner, uint32_t rounds)
{
    wd_cmd_use_buffer(cmd, &spinner->buffer, WD_USE_COMPUTE_WRITE);
    wd_cmd_bind(cmd, &spinner->pipeline, (struct wd_binding[]){WD_BIND_BUFFER(&spinner->buffer)});
    wd_cmd_push(cmd, &spinner->pipeline, &rounds, 4);
    wd_cmd_dispatch(cmd, 64, 1, 1);
}

static void record_scopes(struct wd_cmd *cmd, struct spinner *spinner)
{
    wd_cmd_scope_begin(cmd, "outer");
    wd_cmd_scope_begin(cmd, "short");
    spin(cmd, spinner, 10);
    wd_cmd_scope_end(cmd);
    wd_cmd_scope_begin(cmd, "long");
    spin(cmd, spinner, 100000);
    wd_cmd_scope_end(cmd);
    spin(cmd, spinner, 20000);
    wd_cmd_scope_end(cmd);
    wd_cmd_scope_begin(cmd, "a second one with quite a long name indeed");
    wd_cmd_scope_end(cmd);
}

static void scopes_are_timed_alone_and_summed(void **state)
{
    struct gpu_test *test = *state;
    test->frames.timing = WD_TIMING_ON;
    struct spinner spinner = make_spinner(test);
    for (int i = 0; i < 3; i++) {
        struct wd_cmd cmd = begin_frame(test);
        spin(&cmd, &spinner, 1000);
        record_scopes(&cmd, &spinner);
        finish_frame(test, &cmd);
    }
    assert_int_equal(test->frames.last_scope_count, 4);
    const struct wd_scope_time *scopes = test->frames.last_scopes;
    const char *names[] = {"outer", "short", "long", "a second one with quite a long "};
    const uint32_t depths[] = {0, 1, 1, 0};
    for (int i = 0; i < 4; i++) {
        assert_string_equal(scopes[i].name, names[i]);
        assert_int_equal(scopes[i].depth, depths[i]);
        assert_true(scopes[i].cpu_us > 0);
        assert_true(i == 3 || scopes[i].gpu_us > 0);
    }
    assert_true(scopes[2].gpu_us > 2000); /* 4,096 threads × 100,000 rounds */
    assert_true(scopes[2].gpu_us > 3 * scopes[1].gpu_us);
    assert_true(scopes[0].gpu_us > scopes[1].gpu_us + scopes[2].gpu_us + 500);
    assert_true(scopes[0].cpu_us < scopes[0].gpu_us); /* waiting does not count as recording */
    assert_true(scopes[3].gpu_us == 0);
    wd_buffer_finish(&spinner.buffer, &test->gpu);
}

static void without_timing_there_are_no_scopes(void **state)
{
    struct gpu_test *test = *state;
    struct spinner spinner = make_spinner(test);
    struct wd_cmd cmd = begin_frame(test);
    record_scopes(&cmd, &spinner);
    finish_frame(test, &cmd);
    assert_int_equal(test->frames.last_scope_count, 0);
    wd_buffer_finish(&spinner.buffer, &test->gpu);
}

static void more_scopes_than_fit_are_left_out(void **state)
{
    struct gpu_test *test = *state;
    test->frames.timing = WD_TIMING_ON;
    struct wd_cmd cmd = begin_frame(test);
    for (int i = 0; i < WD_MAX_SCOPES + 3; i++) {
        wd_cmd_scope_begin(&cmd, "one of many");
        wd_cmd_scope_end(&cmd);
    }
    finish_frame(test, &cmd);
    assert_int_equal(test->frames.last_scope_count, WD_MAX_SCOPES);
}

/* Work between the begins and ends of scopes is cut from what follows, and labels with it. */
static void scopes_within_scopes_of_work_end(void **state)
{
    struct gpu_test *test = *state;
    test->frames.timing = WD_TIMING_ON;
    struct spinner spinner = make_spinner(test);
    for (int frame = 0; frame < 3; frame++) {
        struct wd_cmd cmd = begin_frame(test);
        for (int i = 0; i < WD_MAX_SCOPES / 4; i++) {
            const char *const names[4] = {"pass", "view", "choose", "draw"};
            for (int depth = 0; depth < 4; depth++) {
                wd_cmd_scope_begin(&cmd, names[depth]);
                spin(&cmd, &spinner, 10);
            }
            for (int depth = 0; depth < 4; depth++)
                wd_cmd_scope_end(&cmd);
        }
        finish_frame(test, &cmd);
    }
    assert_int_equal(test->frames.last_scope_count, WD_MAX_SCOPES);
    for (int i = 0; i < WD_MAX_SCOPES; i++)
        assert_int_equal(test->frames.last_scopes[i].depth, i % 4);
    wd_buffer_finish(&spinner.buffer, &test->gpu);
}

/* Lavapipe's timestamps are not true, but they are there: the other path runs too. */
static void timestamps_are_read(void **state)
{
    struct gpu_test *test = *state;
    wd_frames_finish(&test->frames);
    test->gpu.features |= WD_GPU_FEATURE_TIMESTAMPS;
    assert_true(wd_frames_init(&test->frames, &test->gpu));
    test->frames.timing = WD_TIMING_ON;
    struct spinner spinner = make_spinner(test);
    for (int i = 0; i < 4; i++) {
        struct wd_cmd cmd = begin_frame(test);
        record_scopes(&cmd, &spinner);
        assert_true(wd_frame_submit(&cmd, VK_NULL_HANDLE, VK_NULL_HANDLE));
    }
    assert_true(wd_frames_wait(&test->frames));
    const struct wd_scope_time *scopes = test->frames.last_scopes;
    assert_int_equal(test->frames.last_scope_count, 4);
    assert_true(scopes[0].gpu_us >= scopes[2].gpu_us);
    assert_true(scopes[2].gpu_us > scopes[1].gpu_us);
    wd_buffer_finish(&spinner.buffer, &test->gpu);
}

static void failed_frame_keeps_the_last_times(void **state)
{
    struct gpu_test *test = *state;
    test->frames.timing = WD_TIMING_ON;
    struct spinner spinner = make_spinner(test);
    struct wd_cmd cmd = begin_frame(test);
    record_scopes(&cmd, &spinner);
    finish_frame(test, &cmd);
    cmd = begin_frame(test);
    wd_cmd_scope_begin(&cmd, "doomed");
    cmd.failed = true;
    spin(&cmd, &spinner, 10);
    wd_cmd_scope_end(&cmd);
    assert_false(wd_frame_submit(&cmd, VK_NULL_HANDLE, VK_NULL_HANDLE));
    assert_true(wd_frames_wait(&test->frames));
    assert_string_equal(test->frames.last_scopes[0].name, "outer");
    wd_buffer_finish(&spinner.buffer, &test->gpu);
}

int main(void)
{
#define GPU_TEST(f) cmocka_unit_test_setup_teardown(f, gpu_setup, gpu_teardown)
    const struct CMUnitTest tests[] = {
        GPU_TEST(scopes_are_timed_alone_and_summed),
        GPU_TEST(without_timing_there_are_no_scopes),
        GPU_TEST(more_scopes_than_fit_are_left_out),
        GPU_TEST(scopes_within_scopes_of_work_end),
        GPU_TEST(timestamps_are_read),
        GPU_TEST(failed_frame_keeps_the_last_times),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
