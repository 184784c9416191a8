/* gpu_test.h: a software device with validation, and a log that remembers. */
#ifndef WD_TESTS_GPU_TEST_H
#define WD_TESTS_GPU_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "gpu/command.h"

struct gpu_test {
    struct wd_gpu gpu;
    struct wd_frames frames;
    struct wd_log log;
    char messages[16384]; /* errors and warnings, a line each */
    int errors;
};

/* A struct gpu_test with only the log set up; and one with device and frames. */
int log_setup(void **state);
int gpu_setup(void **state);
int gpu_teardown(void **state);

/* Forgets what was logged. */
void clear_log(struct gpu_test *test);
void assert_logged(const struct gpu_test *test, const char *part);

struct wd_cmd begin_frame(struct gpu_test *test);
void finish_frame(struct gpu_test *test, struct wd_cmd *cmd); /* submits and waits */

struct wd_buffer make_buffer(struct gpu_test *test, VkDeviceSize size);
struct wd_pipeline make_compute(struct gpu_test *test, struct wd_spirv shader,
                                struct wd_bindings bindings, uint32_t push_size);

#define SPIRV(array) ((struct wd_spirv){array, sizeof array, #array})
#define BINDINGS(...)                                                                              \
    ((struct wd_bindings){sizeof((VkDescriptorType[]){__VA_ARGS__}) / sizeof(VkDescriptorType),    \
                          {__VA_ARGS__}})
#define STORAGE VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
#define UNIFORM VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER
#define STORAGE_IMAGE VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
#define SAMPLED VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER

#endif
