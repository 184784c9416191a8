#include "gpu_test.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include "gpu/barriers.h"

static const uint32_t step_comp[] =
#include "step.comp.inc"
    ;
static const uint32_t count_comp[] =
#include "count.comp.inc"
    ;

/* A buffer that no device knows: the plan alone is looked at. */
static struct wd_buffer imagined_buffer(void)
{
    return (struct wd_buffer){.buffer = (VkBuffer)(uintptr_t)1, .size = 4};
}

static struct wd_image imagined_image(void)
{
    return (struct wd_image){
        .image = (VkImage)(uintptr_t)1,
        .layers = 1,
        .mips = 1,
    };
}

static void first_use_of_a_buffer_needs_nothing(void **state)
{
    (void)state;
    struct wd_barrier barrier;
    for (int use = WD_USE_TRANSFER_READ; use < WD_USE_COUNT; use++) {
        bool image_only = use == WD_USE_COLOR_TARGET || use == WD_USE_DEPTH_TARGET;
        struct wd_buffer buffer = imagined_buffer();
        if (!image_only)
            assert_false(wd_barrier_for_buffer(&buffer, (enum wd_gpu_use)use, &barrier));
    }
}

static void reads_of_host_data_need_nothing(void **state)
{
    (void)state;
    struct wd_buffer buffer = imagined_buffer();
    struct wd_barrier barrier;
    assert_false(wd_barrier_for_buffer(&buffer, WD_USE_COMPUTE_READ, &barrier));
    assert_false(wd_barrier_for_buffer(&buffer, WD_USE_INDEX, &barrier));
    assert_false(wd_barrier_for_buffer(&buffer, WD_USE_GRAPHICS_READ, &barrier));
    assert_true(wd_barrier_for_buffer(&buffer, WD_USE_COMPUTE_WRITE, &barrier));
    assert_int_equal(barrier.buffer.srcStageMask, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT |
                                                      VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT |
                                                      VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT |
                                                      VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT);
}

static void write_after_write_is_ordered(void **state)
{
    (void)state;
    struct wd_buffer buffer = imagined_buffer();
    struct wd_barrier barrier;
    assert_false(wd_barrier_for_buffer(&buffer, WD_USE_COMPUTE_WRITE, &barrier));
    for (int i = 0; i < 3; i++) {
        assert_true(wd_barrier_for_buffer(&buffer, WD_USE_COMPUTE_WRITE, &barrier));
        assert_int_equal(barrier.buffer.srcStageMask, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
        assert_int_equal(barrier.buffer.srcAccessMask, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
        assert_int_equal(barrier.buffer.dstAccessMask, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
                                                           VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
    }
}

static void each_new_reader_is_let_in_once(void **state)
{
    (void)state;
    struct wd_buffer buffer = imagined_buffer();
    struct wd_barrier barrier;
    wd_barrier_for_buffer(&buffer, WD_USE_COMPUTE_WRITE, &barrier);
    assert_true(wd_barrier_for_buffer(&buffer, WD_USE_COMPUTE_READ, &barrier));
    assert_false(wd_barrier_for_buffer(&buffer, WD_USE_COMPUTE_READ, &barrier));
    assert_true(wd_barrier_for_buffer(&buffer, WD_USE_INDIRECT, &barrier));
    assert_int_equal(barrier.buffer.srcStageMask, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
    assert_false(wd_barrier_for_buffer(&buffer, WD_USE_COMPUTE_READ, &barrier));
    assert_false(wd_barrier_for_buffer(&buffer, WD_USE_INDIRECT, &barrier));
    assert_true(wd_barrier_for_buffer(&buffer, WD_USE_TRANSFER_WRITE, &barrier));
    assert_int_equal(barrier.buffer.srcStageMask, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT |
                                                      VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT);
    assert_int_equal(barrier.buffer.srcAccessMask, 0);
    assert_true(wd_barrier_for_buffer(&buffer, WD_USE_SHADER_READ, &barrier));
    assert_false(wd_barrier_for_buffer(&buffer, WD_USE_GRAPHICS_READ, &barrier));
}

static void image_layouts_follow_the_use(void **state)
{
    (void)state;
    static const struct {
        enum wd_gpu_use use;
        VkImageLayout layout;
    } steps[] = {
        {WD_USE_COMPUTE_WRITE, VK_IMAGE_LAYOUT_GENERAL},
        {WD_USE_GRAPHICS_READ, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL},
        {WD_USE_COMPUTE_READ, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL},
        {WD_USE_COLOR_TARGET, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
        {WD_USE_TRANSFER_READ, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL},
        {WD_USE_TRANSFER_WRITE, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL},
        {WD_USE_DEPTH_TARGET, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL},
    };
    struct wd_image image = imagined_image();
    VkImageLayout last = VK_IMAGE_LAYOUT_UNDEFINED;
    struct wd_barrier barrier;
    for (size_t i = 0; i < sizeof steps / sizeof steps[0]; i++) {
        assert_true(wd_barrier_for_image(&image, steps[i].use, WD_CONTENTS_KEEP, &barrier));
        assert_int_equal(barrier.image.oldLayout, last);
        assert_int_equal(barrier.image.newLayout, steps[i].layout);
        assert_false(barrier.image.srcStageMask & VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
        assert_false(barrier.image.dstStageMask & VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
        last = steps[i].layout;
    }
    assert_true(wd_barrier_for_image(&image, WD_USE_DEPTH_TARGET, WD_CONTENTS_DISCARD, &barrier));
    assert_int_equal(barrier.image.oldLayout, VK_IMAGE_LAYOUT_UNDEFINED);
}

static void step(struct wd_cmd *cmd, const struct wd_pipeline *pipeline, struct wd_buffer *from,
                 struct wd_buffer *into)
{
    wd_cmd_use_buffer(cmd, from, WD_USE_COMPUTE_READ);
    wd_cmd_use_buffer(cmd, into, WD_USE_COMPUTE_WRITE);
    wd_cmd_bind(cmd, pipeline, (struct wd_binding[]){WD_BIND_BUFFER(from), WD_BIND_BUFFER(into)});
    wd_cmd_dispatch(cmd, (uint32_t)(into->size / 4 + 63) / 64, 1, 1);
}

/* Write, read, write in a chain within and across frames; validation aborts on a hazard. */
static void ping_pong_chain_is_right(void **state)
{
    struct gpu_test *test = *state;
    enum { COUNT = 4096, STEPS = 12 };
    struct wd_pipeline pipeline =
        make_compute(test, SPIRV(step_comp), BINDINGS(STORAGE, STORAGE), 0);
    struct wd_buffer buffers[2] = {make_buffer(test, COUNT * 4), make_buffer(test, COUNT * 4)};
    uint32_t values[COUNT], expected = 0;
    struct wd_cmd cmd = begin_frame(test);
    wd_cmd_fill_buffer(&cmd, &buffers[0], 0);
    for (int i = 0; i < STEPS; i++) {
        step(&cmd, &pipeline, &buffers[i % 2], &buffers[(i + 1) % 2]);
        expected = 3 * expected + 1;
        if (i % 5 != 4)
            continue;
        assert_true(wd_frame_submit(&cmd, VK_NULL_HANDLE, VK_NULL_HANDLE));
        cmd = begin_frame(test);
    }
    finish_frame(test, &cmd);
    assert_true(wd_buffer_read(&test->gpu, &buffers[0], 0, values, sizeof values));
    for (int i = 0; i < COUNT; i++)
        assert_int_equal(values[i], expected);
    wd_buffer_finish(&buffers[0], &test->gpu);
    wd_buffer_finish(&buffers[1], &test->gpu);
}

static void atomic_dispatches_are_ordered(void **state)
{
    struct gpu_test *test = *state;
    struct wd_pipeline pipeline = make_compute(test, SPIRV(count_comp), BINDINGS(STORAGE), 0);
    struct wd_buffer total = make_buffer(test, 8);
    struct wd_cmd cmd = begin_frame(test);
    wd_cmd_fill_buffer(&cmd, &total, 0);
    size_t before = cmd.slot->barrier_count;
    for (int i = 0; i < 10; i++) {
        wd_cmd_use_buffer(&cmd, &total, WD_USE_COMPUTE_WRITE);
        wd_cmd_bind(&cmd, &pipeline, (struct wd_binding[]){WD_BIND_BUFFER(&total)});
        wd_cmd_dispatch(&cmd, 100, 1, 1);
    }
    assert_int_equal(cmd.slot->barrier_count - before, 10);
    finish_frame(test, &cmd);
    uint32_t count;
    assert_true(wd_buffer_read(&test->gpu, &total, 0, &count, 4));
    assert_int_equal(count, 1000);
    wd_buffer_finish(&total, &test->gpu);
}

/* A frame that fails after its barriers were planned must leave the tracked layouts true. */
static void abandoned_frame_keeps_layouts_true(void **state)
{
    struct gpu_test *test = *state;
    struct wd_image image;
    assert_true(wd_image_init(&image, &test->gpu, &(struct wd_image_params){
        .name = "survivor", .format = VK_FORMAT_R32_UINT, .width = 4, .height = 4,
        .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT}));
    uint32_t sent[16], received[16];
    for (uint32_t i = 0; i < 16; i++)
        sent[i] = i * i;
    assert_true(wd_image_upload(&test->gpu, &image, 0, 0, sent, sizeof sent));
    for (int i = 0; i < 5; i++) {
        struct wd_cmd cmd = begin_frame(test);
        wd_cmd_use_image(&cmd, &image, WD_USE_COMPUTE_READ);
        wd_cmd_use_image(&cmd, &image, WD_USE_COMPUTE_WRITE);
        cmd.failed = true;
        assert_false(wd_frame_submit(&cmd, VK_NULL_HANDLE, VK_NULL_HANDLE));
    }
    assert_true(wd_image_read(&test->gpu, &image, 0, 0, received, sizeof received));
    assert_memory_equal(sent, received, sizeof sent);
    struct wd_cmd cmd = begin_frame(test);
    wd_cmd_use_image(&cmd, &image, WD_USE_COMPUTE_READ);
    finish_frame(test, &cmd);
    wd_image_finish(&image, &test->gpu);
}

/* In a process of its own: two writes, the second undeclared. */
static void overwrite(enum wd_gpu_validation validation)
{
    if (!freopen("/dev/null", "w", stderr))
        _exit(4);
    struct wd_gpu gpu;
    struct wd_frames frames;
    struct wd_buffer buffer;
    struct wd_cmd cmd;
    const struct wd_gpu_params params = {.name = "software", .validation = validation};
    bool ok = wd_gpu_init(&gpu, &params, NULL) && wd_frames_init(&frames, &gpu) &&
              wd_buffer_init(&buffer, &gpu, &(struct wd_buffer_params){.name = "b", .size = 64}) &&
              wd_frame_begin(&frames, &cmd);
    if (!ok)
        _exit(2);
    wd_cmd_fill_buffer(&cmd, &buffer, 1);
    vkCmdFillBuffer(cmd.vk, buffer.buffer, 0, VK_WHOLE_SIZE, 2);
    _exit(wd_frame_submit(&cmd, VK_NULL_HANDLE, VK_NULL_HANDLE) && wd_frames_wait(&frames) ? 0 : 3);
}

static int status_of_overwrite(enum wd_gpu_validation validation)
{
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0)
        overwrite(validation);
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    return status;
}

/* Otherwise the other tests would prove nothing. */
static void validation_aborts_on_a_hazard(void **state)
{
    (void)state;
    int off = status_of_overwrite(WD_GPU_VALIDATION_OFF);
    assert_true(WIFEXITED(off) && WEXITSTATUS(off) == 0);
    int on = status_of_overwrite(WD_GPU_VALIDATION_ON);
    assert_true(WIFSIGNALED(on) && WTERMSIG(on) == SIGABRT);
}

int main(void)
{
#define GPU_TEST(f) cmocka_unit_test_setup_teardown(f, gpu_setup, gpu_teardown)
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(first_use_of_a_buffer_needs_nothing),
        cmocka_unit_test(reads_of_host_data_need_nothing),
        cmocka_unit_test(write_after_write_is_ordered),
        cmocka_unit_test(each_new_reader_is_let_in_once),
        cmocka_unit_test(image_layouts_follow_the_use),
        cmocka_unit_test(validation_aborts_on_a_hazard),
        GPU_TEST(ping_pong_chain_is_right),
        GPU_TEST(atomic_dispatches_are_ordered),
        GPU_TEST(abandoned_frame_keeps_layouts_true),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
