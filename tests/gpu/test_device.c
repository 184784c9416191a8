#include "gpu_test.h"

#include <stdlib.h>
#include <string.h>

#include "gpu/device_features.h"

static void software_device_is_chosen(void **state)
{
    struct gpu_test *test = *state;
    struct wd_gpu gpu;
    assert_true(wd_gpu_init(&gpu, &(struct wd_gpu_params){.name = "Software"}, &test->log));
    assert_true(gpu.software);
    assert_false(gpu.features & WD_GPU_FEATURE_TIMESTAMPS);
    assert_true(gpu.features & WD_GPU_FEATURE_INT64_ATOMICS);
    assert_non_null(strstr(gpu.properties.deviceName, "llvmpipe"));
    wd_gpu_finish(&gpu);
    assert_null(gpu.device);
    wd_gpu_finish(&gpu);
}

static void part_of_a_name_matches_in_any_case(void **state)
{
    struct gpu_test *test = *state;
    struct wd_gpu gpu;
    assert_true(wd_gpu_init(&gpu, &(struct wd_gpu_params){.name = "LLVMpipe"}, &test->log));
    wd_gpu_finish(&gpu);
}

static void unknown_name_lists_what_there_is(void **state)
{
    struct gpu_test *test = *state;
    struct wd_gpu gpu;
    assert_false(wd_gpu_init(&gpu, &(struct wd_gpu_params){.name = "Voodoo 2"}, &test->log));
    assert_logged(test, "Voodoo 2");
    assert_logged(test, "llvmpipe");
    assert_logged(test, "(software)");
    assert_int_equal(test->errors, 1);
    assert_null(gpu.instance);
}

static void without_driver_the_error_says_so(void **state)
{
    struct gpu_test *test = *state;
    setenv("VK_ICD_FILENAMES", "/nonexistent/driver.json", 1);
    setenv("VK_DRIVER_FILES", "/nonexistent/driver.json", 1);
    struct wd_gpu gpu;
    bool ok = wd_gpu_init(&gpu, &(struct wd_gpu_params){0}, &test->log);
    char *names = wd_gpu_list(&test->log);
    unsetenv("VK_ICD_FILENAMES");
    unsetenv("VK_DRIVER_FILES");
    assert_false(ok);
    assert_logged(test, "mesa-vulkan-drivers");
    assert_string_equal(names, "");
    free(names);
}

static void missing_validation_layer_is_an_error(void **state)
{
    struct gpu_test *test = *state;
    setenv("VK_LAYER_PATH", "/nonexistent", 1);
    struct wd_gpu gpu;
    const struct wd_gpu_params params = {.validation = WD_GPU_VALIDATION_ON};
    bool ok = wd_gpu_init(&gpu, &params, &test->log);
    unsetenv("VK_LAYER_PATH");
    assert_false(ok);
    assert_logged(test, "VK_LAYER_KHRONOS_validation is not installed");
}

static void missing_instance_extension_is_named(void **state)
{
    struct gpu_test *test = *state;
    const char *extensions[] = {"VK_KHR_surface", "VK_WEALD_nonsense"};
    const struct wd_gpu_params params = {
        .instance_extensions = extensions,
        .instance_extension_count = 2,
    };
    struct wd_gpu gpu;
    assert_false(wd_gpu_init(&gpu, &params, &test->log));
    assert_logged(test, "VK_WEALD_nonsense");
}

static void every_optional_feature_can_be_disabled(void **state)
{
    struct gpu_test *test = *state;
    for (uint32_t bit = 1; bit <= WD_GPU_FEATURE_MANY_LANES; bit *= 2) {
        struct wd_gpu gpu;
        const struct wd_gpu_params params = {.name = "software", .disabled_features = bit};
        assert_true(wd_gpu_init(&gpu, &params, &test->log));
        assert_false(gpu.features & bit);
        wd_gpu_finish(&gpu);
    }
    struct wd_gpu gpu;
    const struct wd_gpu_params none = {.name = "software", .disabled_features = UINT32_MAX};
    assert_true(wd_gpu_init(&gpu, &none, &test->log));
    assert_int_equal(gpu.features, 0);
    assert_null(gpu.begin_label);
    wd_gpu_finish(&gpu);
}

static void lacking_features_are_named(void **state)
{
    (void)state;
    struct wd_feature_set set;
    wd_features_choose(&set, 0);
    assert_null(wd_features_missing(&set));
    assert_int_equal(wd_features_optional(&set), 0);
    set.v12.scalarBlockLayout = VK_FALSE;
    set.v13.synchronization2 = VK_FALSE;
    char *missing = wd_features_missing(&set);
    assert_string_equal(missing, "scalarBlockLayout, synchronization2");
    free(missing);
    wd_features_choose(&set, WD_GPU_FEATURE_INT64_ATOMICS | WD_GPU_FEATURE_ANISOTROPY);
    set.base.features.shaderInt64 = VK_FALSE; /* half of a pair is none */
    assert_int_equal(wd_features_optional(&set), WD_GPU_FEATURE_ANISOTROPY);
}

/* In two structs as we chain them, and each in one of its own as older programs do. */
static void enabled_features_are_read_from_any_chain(void **state)
{
    (void)state;
    struct wd_feature_set chosen, read;
    wd_features_choose(&chosen, UINT32_MAX);
    wd_features_read(&read, &chosen.base);
    assert_null(wd_features_missing(&read));
    assert_int_equal(wd_features_optional(&read), wd_features_optional(&chosen));
#define LINK(name) VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_##name##_FEATURES, chain
    void *chain = NULL;
    chain = &(VkPhysicalDeviceMultiviewFeatures){LINK(MULTIVIEW), .multiview = VK_TRUE};
    chain = &(VkPhysicalDeviceScalarBlockLayoutFeatures){LINK(SCALAR_BLOCK_LAYOUT), VK_TRUE};
    chain = &(VkPhysicalDeviceDynamicRenderingFeatures){LINK(DYNAMIC_RENDERING), VK_TRUE};
    chain = &(VkPhysicalDeviceSynchronization2Features){LINK(SYNCHRONIZATION_2), VK_TRUE};
    chain = &(VkPhysicalDeviceMaintenance4Features){LINK(MAINTENANCE_4), VK_TRUE};
    chain = &(VkPhysicalDeviceShaderTerminateInvocationFeatures){LINK(SHADER_TERMINATE_INVOCATION),
                                                                 VK_TRUE};
    chain = &(VkPhysicalDeviceShaderDemoteToHelperInvocationFeatures){
        LINK(SHADER_DEMOTE_TO_HELPER_INVOCATION), VK_TRUE};
    VkPhysicalDeviceShaderAtomicInt64Features atomics = {LINK(SHADER_ATOMIC_INT64), VK_TRUE};
#undef LINK
    const VkPhysicalDeviceFeatures2 base = {.pNext = &atomics, .features = chosen.base.features};
    wd_features_read(&read, &base);
    assert_null(wd_features_missing(&read));
    assert_int_equal(wd_features_optional(&read), wd_features_optional(&chosen));
    atomics.shaderBufferInt64Atomics = VK_FALSE;
    wd_features_read(&read, &base);
    assert_int_equal(wd_features_optional(&chosen) & ~wd_features_optional(&read),
                     WD_GPU_FEATURE_INT64_ATOMICS);
}

static void presentation_enables_the_swapchain(void **state)
{
    struct gpu_test *test = *state;
    const char *extensions[] = {"VK_KHR_surface"};
    const struct wd_gpu_params params = {
        .name = "software",
        .validation = WD_GPU_VALIDATION_ON,
        .presentation = WD_GPU_PRESENT,
        .instance_extensions = extensions,
        .instance_extension_count = 1,
    };
    struct wd_gpu gpu;
    assert_true(wd_gpu_init(&gpu, &params, &test->log));
    assert_non_null(vkGetDeviceProcAddr(gpu.device, "vkCreateSwapchainKHR"));
    wd_gpu_finish(&gpu);
}

static void list_names_the_software_device(void **state)
{
    struct gpu_test *test = *state;
    char *names = wd_gpu_list(&test->log);
    assert_non_null(strstr(names, "llvmpipe"));
    free(names);
}

static void lost_device_fails_fast(void **state)
{
    struct gpu_test *test = *state;
    assert_false(wd_gpu_check(&test->gpu, VK_ERROR_DEVICE_LOST, "the walk"));
    assert_logged(test, "lost during the walk");
    assert_true(test->gpu.lost);
    struct wd_cmd cmd;
    struct wd_buffer buffer;
    assert_false(wd_frame_begin(&test->frames, &cmd));
    assert_false(wd_buffer_init(&buffer, &test->gpu, &(struct wd_buffer_params){
        .name = "late", .size = 4, .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT}));
    assert_int_equal(test->errors, 1);
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
        LOG_TEST(software_device_is_chosen),
        LOG_TEST(part_of_a_name_matches_in_any_case),
        LOG_TEST(unknown_name_lists_what_there_is),
        LOG_TEST(without_driver_the_error_says_so),
        LOG_TEST(missing_validation_layer_is_an_error),
        LOG_TEST(missing_instance_extension_is_named),
        LOG_TEST(every_optional_feature_can_be_disabled),
        cmocka_unit_test(lacking_features_are_named),
        cmocka_unit_test(enabled_features_are_read_from_any_chain),
        LOG_TEST(presentation_enables_the_swapchain),
        LOG_TEST(list_names_the_software_device),
        cmocka_unit_test_setup_teardown(lost_device_fails_fast, gpu_setup, gpu_teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
