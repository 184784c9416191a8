#include "gpu_test.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Drivers and layers keep memory when they are unloaded, which the leak sanitizer counts as lost.
 * Held loaded they are known by name; what we lose ourselves is still found. */
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void)
{
    return "leak:libvulkan_lvp\nleak:libVkLayer\nleak:libLLVM\n";
}

static void hold_drivers(void)
{
    dlopen("libvulkan_lvp.so", RTLD_NOW | RTLD_NODELETE);
    dlopen("libVkLayer_khronos_validation.so", RTLD_NOW | RTLD_NODELETE);
}

static void remember(void *user, enum wd_log_level level, const char *message)
{
    struct gpu_test *test = user;
    if (level > WD_LOG_WARNING)
        return;
    test->errors += level == WD_LOG_ERROR;
    size_t used = strlen(test->messages);
    snprintf(test->messages + used, sizeof test->messages - used, "%s\n", message);
    if (strstr(message, "Vulkan validation"))
        fprintf(stderr, "%s\n", message);
}

int log_setup(void **state)
{
    hold_drivers();
    struct gpu_test *test = wd_alloc(sizeof *test);
    test->log = (struct wd_log){remember, test};
    *state = test;
    return 0;
}

int gpu_setup(void **state)
{
    log_setup(state);
    struct gpu_test *test = *state;
    const struct wd_gpu_params params = {
        .name = "software",
        .validation = WD_GPU_VALIDATION_ON,
    };
    bool ok = wd_gpu_init(&test->gpu, &params, &test->log) &&
              wd_frames_init(&test->frames, &test->gpu);
    if (!ok)
        fprintf(stderr, "%s", test->messages);
    return ok ? 0 : 1;
}

int gpu_teardown(void **state)
{
    struct gpu_test *test = *state;
    wd_frames_finish(&test->frames);
    clear_log(test);
    wd_gpu_finish(&test->gpu); /* warns of leaks */
    bool silent = test->messages[0] == 0;
    if (!silent)
        fprintf(stderr, "%s", test->messages);
    free(test);
    return silent ? 0 : 1;
}

void clear_log(struct gpu_test *test)
{
    test->messages[0] = 0;
    test->errors = 0;
}

void assert_logged(const struct gpu_test *test, const char *part)
{
    if (!strstr(test->messages, part))
        fail_msg("expected \"%s\" in the log, found: %s", part, test->messages);
}

struct wd_cmd begin_frame(struct gpu_test *test)
{
    struct wd_cmd cmd;
    assert_true(wd_frame_begin(&test->frames, &cmd));
    return cmd;
}

void finish_frame(struct gpu_test *test, struct wd_cmd *cmd)
{
    assert_true(wd_frame_submit(cmd, VK_NULL_HANDLE, VK_NULL_HANDLE));
    assert_true(wd_frames_wait(&test->frames));
}

struct wd_buffer make_buffer(struct gpu_test *test, VkDeviceSize size)
{
    struct wd_buffer buffer;
    const struct wd_buffer_params params = {
        .name = "test buffer",
        .size = size,
        .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT,
    };
    assert_true(wd_buffer_init(&buffer, &test->gpu, &params));
    return buffer;
}

struct wd_pipeline make_compute(struct gpu_test *test, struct wd_spirv shader,
                                struct wd_bindings bindings, uint32_t push_size)
{
    struct wd_pipeline pipeline;
    const struct wd_compute_params params = {
        .shader = shader,
        .bindings = bindings,
        .push_size = push_size,
    };
    assert_true(wd_pipeline_init_compute(&pipeline, &test->gpu, &params));
    return pipeline;
}
