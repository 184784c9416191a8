/* A renderer on a device of the program's own: that of the wanted features draws as an own one.
 *   test-vulkan ROOT   (the folder of the sources) */
#include "suite.h"

#include <stdlib.h>
#include <string.h>

#include "api/renderer.h"
#include "weald/vulkan.h"

enum { BYTES = PICTURE_WIDTH * PICTURE_HEIGHT * 4 };

/* A device beside the suite's, of the same instance: its errors of validation end the program. */
struct guest {
    struct wd_vulkan_handles handles;
    VkPhysicalDeviceFeatures2 features;
    VkPhysicalDeviceVulkan12Features features12;
    VkPhysicalDeviceVulkan13Features features13;
    struct wd_renderer *renderer;
};

enum said { SAID_NOTHING, SAID_WANTED };

static void open_guest(struct guest *guest, struct suite *suite, enum said said)
{
    wd_renderer_get_vulkan(suite->renderer, &guest->handles);
    assert_null(guest->handles.enabled);
    if (said == SAID_WANTED) {
        wd_vulkan_wanted_features(guest->handles.physical_device, &guest->features,
                                  &guest->features12, &guest->features13);
        guest->handles.enabled = &guest->features;
    } else {
        wd_vulkan_required_features(&guest->features, &guest->features12, &guest->features13);
    }
    const VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                           .queueFamilyIndex = guest->handles.queue_family,
                                           .queueCount = 1,
                                           .pQueuePriorities = (const float[]){1}};
    const VkDeviceCreateInfo device = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                       .pNext = &guest->features,
                                       .queueCreateInfoCount = 1,
                                       .pQueueCreateInfos = &queue};
    assert_int_equal(
        vkCreateDevice(guest->handles.physical_device, &device, NULL, &guest->handles.device), 0);
    vkGetDeviceQueue(guest->handles.device, guest->handles.queue_family, 0, &guest->handles.queue);
    const struct wd_renderer_params params = {.log = suite->log};
    assert_int_equal(wd_renderer_create_vulkan(&guest->renderer, &guest->handles, &params), WD_OK);
    assert_int_equal(wd_renderer_set_forest(guest->renderer, suite->forest), WD_OK);
}

static void close_guest(struct guest *guest)
{
    wd_renderer_destroy(&guest->renderer);
    vkDestroyDevice(guest->handles.device, NULL);
}

/* Bytes of the guest's display that are more than `most` from the suite's. */
static size_t other_bytes(struct suite *suite, struct guest *guest, const char *method, int most)
{
    struct wd_render_params params = suite_params(suite->forest, "over");
    params.method = method;
    struct wd_picture own = suite_render(suite, &params), theirs;
    assert_int_equal(wd_renderer_render(guest->renderer, &params, &theirs), WD_OK);
    size_t other = 0;
    for (size_t i = 0; i < BYTES; i++)
        other += abs(own.display[i] - theirs.display[i]) > most;
    wd_picture_finish(&own);
    wd_picture_finish(&theirs);
    return other;
}

static void wanted_features_draw_as_an_own_device(void **state)
{
    struct suite *suite = *state;
    struct guest guest;
    open_guest(&guest, suite, SAID_WANTED);
    uint32_t own = suite->renderer->gpu.features & ~(uint32_t)WD_GPU_FEATURE_DEBUG_LABELS;
    assert_int_equal(guest.renderer->gpu.features, own);
    assert_true(own & WD_GPU_FEATURE_INT64_ATOMICS);
    assert_int_equal(other_bytes(suite, &guest, "continuum", 0), 0);
    assert_int_equal(other_bytes(suite, &guest, "octree", 0), 0);
    close_guest(&guest);
}

/* Equal depths of different splats may be told apart in another order of items. */
static void the_fallbacks_draw_where_nothing_is_said(void **state)
{
    struct suite *suite = *state;
    struct guest guest;
    open_guest(&guest, suite, SAID_NOTHING);
    assert_int_equal(guest.renderer->gpu.features, 0);
    assert_in_range(other_bytes(suite, &guest, "continuum", 8), 0, BYTES / 200);
    close_guest(&guest);
}

int main(int argc, char **argv)
{
    struct suite suite;
    if (argc != 2 || !suite_init(&suite, argv[1]) ||
        wd_renderer_set_forest(suite.renderer, suite.forest) != WD_OK)
        return 1;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(wanted_features_draw_as_an_own_device, &suite),
        cmocka_unit_test_prestate(the_fallbacks_draw_where_nothing_is_said, &suite),
    };
    int failed = cmocka_run_group_tests_name("vulkan", tests, NULL, NULL);
    suite_finish(&suite);
    return failed;
}
