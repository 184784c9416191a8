#include "gpu_test.h"

#include <string.h>

static const uint32_t fill_comp[] =
#include "fill.comp.inc"
    ;
static const uint32_t step_comp[] =
#include "step.comp.inc"
    ;

/* Every frame makes a buffer, fills it, adds it up and leaves it to the queue. */
static void many_frames_with_deferred_buffers(void **state)
{
    struct gpu_test *test = *state;
    enum { COUNT = 256, FRAMES = 100 };
    struct wd_pipeline pipeline = make_compute(test, SPIRV(fill_comp), BINDINGS(STORAGE), 8);
    struct wd_buffer kept = make_buffer(test, COUNT * 4);
    for (uint32_t i = 0; i < FRAMES; i++) {
        struct wd_cmd cmd = begin_frame(test);
        struct wd_buffer buffer = make_buffer(test, COUNT * 4);
        wd_cmd_use_buffer(&cmd, &buffer, WD_USE_COMPUTE_WRITE);
        wd_cmd_bind(&cmd, &pipeline, (struct wd_binding[]){WD_BIND_BUFFER(&buffer)});
        wd_cmd_push(&cmd, &pipeline, (uint32_t[]){i, COUNT}, 8);
        wd_cmd_dispatch(&cmd, COUNT / 64, 1, 1);
        wd_cmd_use_buffer(&cmd, &buffer, WD_USE_TRANSFER_READ);
        wd_cmd_use_buffer(&cmd, &kept, WD_USE_TRANSFER_WRITE);
        vkCmdCopyBuffer(cmd.vk, buffer.buffer, kept.buffer, 1, &(VkBufferCopy){0, 0, COUNT * 4});
        wd_cmd_defer_buffer(&cmd, &buffer);
        assert_null(buffer.buffer);
        wd_cmd_defer_buffer(&cmd, &buffer); /* {0} is fine */
        assert_true(wd_frame_submit(&cmd, VK_NULL_HANDLE, VK_NULL_HANDLE));
        assert_in_range(test->gpu.allocation_count, 1, 1 + WD_FRAMES_IN_FLIGHT);
    }
    uint32_t values[COUNT];
    assert_true(wd_buffer_read(&test->gpu, &kept, 0, values, sizeof values));
    for (uint32_t i = 0; i < COUNT; i++)
        assert_int_equal(values[i], FRAMES - 1 + i);
    wd_buffer_finish(&kept, &test->gpu);
}

static void deferred_images_die(void **state)
{
    struct gpu_test *test = *state;
    for (int i = 0; i < 5; i++) {
        struct wd_cmd cmd = begin_frame(test);
        struct wd_image image;
        assert_true(wd_image_init(&image, &test->gpu, &(struct wd_image_params){
            .name = "short-lived", .format = VK_FORMAT_R8_UNORM, .width = 8, .height = 8,
            .usage = VK_IMAGE_USAGE_SAMPLED_BIT}));
        wd_cmd_use_image(&cmd, &image, WD_USE_TRANSFER_WRITE);
        wd_cmd_defer_image(&cmd, &image);
        assert_null(image.image);
        assert_true(wd_frame_submit(&cmd, VK_NULL_HANDLE, VK_NULL_HANDLE));
    }
    wd_frames_finish(&test->frames);
    assert_int_equal(test->gpu.allocation_count, 0);
}

/* Bindings into the arena stay valid when it grows within the frame. */
static void upload_arena_grows(void **state)
{
    struct gpu_test *test = *state;
    enum { COUNT = 3000, ROUNDS = 7 };
    struct wd_pipeline pipeline =
        make_compute(test, SPIRV(step_comp), BINDINGS(STORAGE, STORAGE), 0);
    struct wd_buffer into[ROUNDS];
    struct wd_cmd cmd = begin_frame(test);
    for (uint32_t r = 0; r < ROUNDS; r++) {
        into[r] = make_buffer(test, COUNT * 4);
        struct wd_binding from, filler;
        uint32_t *values = wd_cmd_upload(&cmd, COUNT * 4, &from);
        assert_non_null(values);
        assert_int_equal(from.offset % 256, 0);
        for (uint32_t i = 0; i < COUNT; i++)
            values[i] = r * 1000 + i;
        assert_non_null(wd_cmd_upload(&cmd, 700000u << (r / 2), &filler));
        wd_cmd_use_buffer(&cmd, &into[r], WD_USE_COMPUTE_WRITE);
        wd_cmd_bind(&cmd, &pipeline, (struct wd_binding[]){from, WD_BIND_BUFFER(&into[r])});
        wd_cmd_dispatch(&cmd, (COUNT + 63) / 64, 1, 1);
    }
    finish_frame(test, &cmd);
    uint32_t values[COUNT];
    for (uint32_t r = 0; r < ROUNDS; r++) {
        assert_true(wd_buffer_read(&test->gpu, &into[r], 0, values, sizeof values));
        for (uint32_t i = 0; i < COUNT; i++)
            assert_int_equal(values[i], 3 * (r * 1000 + i) + 1);
        wd_buffer_finish(&into[r], &test->gpu);
    }
}

static void descriptor_pools_grow_and_are_reused(void **state)
{
    struct gpu_test *test = *state;
    struct wd_pipeline pipeline = make_compute(test, SPIRV(fill_comp), BINDINGS(STORAGE), 8);
    struct wd_buffer buffer = make_buffer(test, 256);
    size_t pools = 0;
    for (int frame = 0; frame < 6; frame++) {
        struct wd_cmd cmd = begin_frame(test);
        wd_cmd_use_buffer(&cmd, &buffer, WD_USE_COMPUTE_WRITE);
        for (int i = 0; i < 1000; i++)
            wd_cmd_bind(&cmd, &pipeline, (struct wd_binding[]){WD_BIND_BUFFER(&buffer)});
        assert_false(cmd.failed);
        if (frame == 0)
            pools = cmd.slot->descriptor_pool_count;
        assert_int_equal(cmd.slot->descriptor_pool_count, pools);
        assert_true(wd_frame_submit(&cmd, VK_NULL_HANDLE, VK_NULL_HANDLE));
    }
    assert_true(pools > 1);
    assert_true(wd_frames_wait(&test->frames));
    wd_buffer_finish(&buffer, &test->gpu);
}

static void upload_beyond_memory_fails_only_its_frame(void **state)
{
    struct gpu_test *test = *state;
    struct wd_pipeline pipeline = make_compute(test, SPIRV(fill_comp), BINDINGS(STORAGE), 8);
    struct wd_buffer buffer = make_buffer(test, 256);
    const uint32_t before = 0xabcdef01;
    assert_true(wd_buffer_upload(&test->gpu, &buffer, 0, &before, 4));
    for (uint32_t i = 0; i < 4; i++) {
        struct wd_cmd cmd = begin_frame(test);
        wd_cmd_use_buffer(&cmd, &buffer, WD_USE_COMPUTE_WRITE);
        struct wd_binding binding;
        bool too_much = i % 2 == 0;
        void *space = wd_cmd_upload(&cmd, too_much ? 1ull << 60 : 64, &binding);
        assert_int_equal(!space, too_much);
        wd_cmd_bind(&cmd, &pipeline, (struct wd_binding[]){WD_BIND_BUFFER(&buffer)});
        wd_cmd_push(&cmd, &pipeline, (uint32_t[]){i + 5, 64}, 8);
        wd_cmd_dispatch(&cmd, 1, 1, 1);
        assert_int_equal(wd_frame_submit(&cmd, VK_NULL_HANDLE, VK_NULL_HANDLE), !too_much);
        uint32_t value;
        assert_true(wd_buffer_read(&test->gpu, &buffer, 0, &value, 4));
        assert_int_equal(value, i == 0 ? before : i < 3 ? 6 : 8);
    }
    assert_logged(test, "\"upload arena\" wants");
    assert_int_equal(test->errors, 2);
    wd_buffer_finish(&buffer, &test->gpu);
}

/* What a swapchain would do: one frame signals, the next waits. */
static void semaphores_join_frames(void **state)
{
    struct gpu_test *test = *state;
    const VkSemaphoreCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VkSemaphore semaphore;
    assert_int_equal(vkCreateSemaphore(test->gpu.device, &info, NULL, &semaphore), VK_SUCCESS);
    for (int i = 0; i < 6; i++) {
        struct wd_cmd cmd = begin_frame(test);
        cmd.failed = i == 3; /* a failed frame consumes what it waits for */
        bool ok = wd_frame_submit(&cmd, i % 2 ? semaphore : VK_NULL_HANDLE,
                                  i % 2 ? VK_NULL_HANDLE : semaphore);
        assert_int_equal(ok, i != 3);
    }
    assert_true(wd_frames_wait(&test->frames));
    vkDestroySemaphore(test->gpu.device, semaphore, NULL);
}

int main(void)
{
#define GPU_TEST(f) cmocka_unit_test_setup_teardown(f, gpu_setup, gpu_teardown)
    const struct CMUnitTest tests[] = {
        GPU_TEST(many_frames_with_deferred_buffers),
        GPU_TEST(deferred_images_die),
        GPU_TEST(upload_arena_grows),
        GPU_TEST(descriptor_pools_grow_and_are_reused),
        GPU_TEST(upload_beyond_memory_fails_only_its_frame),
        GPU_TEST(semaphores_join_frames),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
