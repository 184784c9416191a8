#include "gpu_test.h"

#include <stdlib.h>
#include <string.h>

struct features {
    VkPhysicalDeviceFeatures2 base;
    VkPhysicalDeviceVulkan12Features v12;
    VkPhysicalDeviceVulkan13Features v13;
};

/* A device as an embedding program would make it: from the published required features, or with
 * `wanted` from the wanted ones. */
static void make_external(struct wd_gpu_external *external, struct features *wanted)
{
    const VkApplicationInfo application = {
        .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
        .apiVersion = VK_API_VERSION_1_3,
    };
    const VkInstanceCreateInfo instance = {
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
        .pApplicationInfo = &application,
    };
    *external = (struct wd_gpu_external){0};
    assert_int_equal(vkCreateInstance(&instance, NULL, &external->instance), VK_SUCCESS);
    uint32_t count = 1;
    vkEnumeratePhysicalDevices(external->instance, &count, &external->physical_device);
    assert_int_equal(count, 1);
    struct features required, *features = wanted ? wanted : &required;
    if (wanted)
        wd_gpu_wanted_features(external->physical_device, &wanted->base, &wanted->v12, &wanted->v13);
    else
        wd_gpu_required_features(&required.base, &required.v12, &required.v13);
    assert_true(features->v13.dynamicRendering && features->v13.synchronization2);
    assert_true(features->v12.scalarBlockLayout && features->base.features.independentBlend);
    const VkDeviceQueueCreateInfo queue = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
        .queueCount = 1,
        .pQueuePriorities = (const float[]){1},
    };
    const VkDeviceCreateInfo device = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
        .pNext = &features->base,
        .queueCreateInfoCount = 1,
        .pQueueCreateInfos = &queue,
    };
    assert_int_equal(vkCreateDevice(external->physical_device, &device, NULL, &external->device),
                     VK_SUCCESS);
    vkGetDeviceQueue(external->device, 0, 0, &external->queue);
}

static void destroy_external(struct wd_gpu_external *external)
{
    vkDestroyDevice(external->device, NULL);
    vkDestroyInstance(external->instance, NULL);
}

static void draw_and_read(struct wd_gpu *gpu)
{
    struct wd_frames frames;
    assert_true(wd_frames_init(&frames, gpu));
    struct wd_buffer buffer;
    assert_true(wd_buffer_init(&buffer, gpu, &(struct wd_buffer_params){
        .name = "theirs", .size = 64, .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT}));
    struct wd_cmd cmd;
    assert_true(wd_frame_begin(&frames, &cmd));
    wd_cmd_scope_begin(&cmd, "fill");
    wd_cmd_fill_buffer(&cmd, &buffer, 42);
    wd_cmd_scope_end(&cmd);
    assert_true(wd_frame_submit(&cmd, VK_NULL_HANDLE, VK_NULL_HANDLE));
    uint32_t values[16];
    assert_true(wd_buffer_read(gpu, &buffer, 0, values, sizeof values));
    assert_int_equal(values[15], 42);
    wd_buffer_finish(&buffer, gpu);
    wd_frames_finish(&frames);
}

/* What no feature of a device says. */
static const uint32_t unsaid = WD_GPU_FEATURE_TIMESTAMPS | WD_GPU_FEATURE_MANY_LANES |
                               WD_GPU_FEATURE_DEBUG_LABELS;

static void external_device_is_used_and_left_alone(void **state)
{
    struct gpu_test *test = *state;
    struct wd_gpu_external external;
    make_external(&external, NULL);
    struct wd_gpu gpu;
    assert_true(wd_gpu_init(&gpu, &(struct wd_gpu_params){.external = &external}, &test->log));
    assert_false(gpu.owned);
    assert_int_equal(gpu.features & ~unsaid, 0);
    draw_and_read(&gpu);
    wd_gpu_finish(&gpu);
    assert_int_equal(vkDeviceWaitIdle(external.device), VK_SUCCESS); /* still alive */
    assert_int_equal(test->errors, 0);
    destroy_external(&external);
}

static uint32_t features_of(struct gpu_test *test, const struct wd_gpu_params *params)
{
    struct wd_gpu gpu;
    assert_true(wd_gpu_init(&gpu, params, &test->log));
    uint32_t features = gpu.features;
    wd_gpu_finish(&gpu);
    return features;
}

static void wanted_features_are_those_of_an_own_device(void **state)
{
    struct gpu_test *test = *state;
    struct wd_gpu_external external;
    struct features wanted;
    make_external(&external, &wanted);
    external.enabled = &wanted.base;
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(external.physical_device, &properties);
    uint32_t own = features_of(test, &(struct wd_gpu_params){.name = properties.deviceName});
    uint32_t theirs = features_of(test, &(struct wd_gpu_params){.external = &external});
    assert_int_equal(theirs, own & ~(uint32_t)WD_GPU_FEATURE_DEBUG_LABELS);
    assert_true(theirs & WD_GPU_FEATURE_INT64_ATOMICS);
    destroy_external(&external);
}

static void enabled_features_alone_are_used(void **state)
{
    struct gpu_test *test = *state;
    struct wd_gpu_external external;
    struct features enabled;
    make_external(&external, NULL);
    wd_gpu_required_features(&enabled.base, &enabled.v12, &enabled.v13);
    external.enabled = &enabled.base;
    const struct wd_gpu_params params = {.external = &external};
    assert_int_equal(features_of(test, &params) & ~unsaid, 0);
    enabled.base.features.samplerAnisotropy = VK_TRUE;
    enabled.base.features.shaderInt64 = VK_TRUE; /* half of a pair is none */
    assert_int_equal(features_of(test, &params) & ~unsaid, WD_GPU_FEATURE_ANISOTROPY);
    enabled.v13.maintenance4 = VK_FALSE;
    struct wd_gpu gpu;
    assert_false(wd_gpu_init(&gpu, &params, &test->log));
    assert_logged(test, "was made without the feature maintenance4");
    destroy_external(&external);
}

static void the_queue_is_of_its_own_family(void **state)
{
    struct gpu_test *test = *state;
    struct wd_gpu_external external;
    make_external(&external, NULL);
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(external.physical_device, &count, NULL);
    VkQueueFamilyProperties *families = calloc(count, sizeof *families);
    vkGetPhysicalDeviceQueueFamilyProperties(external.physical_device, &count, families);
    struct wd_gpu gpu;
    assert_true(wd_gpu_init(&gpu, &(struct wd_gpu_params){.external = &external}, &test->log));
    assert_int_equal(gpu.queue_family, external.queue_family);
    assert_int_equal(gpu.timestamp_bits, families[external.queue_family].timestampValidBits);
    wd_gpu_finish(&gpu);
    const uint32_t wrong[] = {count, UINT32_MAX};
    for (size_t i = 0; i < 2; i++) {
        external.queue_family = wrong[i];
        assert_false(wd_gpu_init(&gpu, &(struct wd_gpu_params){.external = &external}, &test->log));
        assert_logged(test, "queue family");
    }
    free(families);
    destroy_external(&external);
}

static void null_handle_is_an_error(void **state)
{
    struct gpu_test *test = *state;
    struct wd_gpu gpu;
    const struct wd_gpu_external external = {0};
    assert_false(wd_gpu_init(&gpu, &(struct wd_gpu_params){.external = &external}, &test->log));
    assert_logged(test, "null handle");
}

static int log_teardown(void **state)
{
    free(*state);
    return 0;
}

int main(void)
{
#define LOG_TEST(f) cmocka_unit_test_setup_teardown(f, log_setup, log_teardown)
    const struct CMUnitTest tests[] = {
        LOG_TEST(external_device_is_used_and_left_alone),
        LOG_TEST(wanted_features_are_those_of_an_own_device),
        LOG_TEST(enabled_features_alone_are_used),
        LOG_TEST(the_queue_is_of_its_own_family),
        LOG_TEST(null_handle_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
