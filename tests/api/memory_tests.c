/* Memory that runs out is told from a device that fails, and what is there goes on. */
#include <stdio.h>
#include <sys/resource.h>
#include <unistd.h>

#include "api/renderer.h"
#include "parts.h"
#include "weald/reference.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
enum { OWN_ALLOCATOR = 1 }; /* which ends the process where memory runs out */
#else
enum { OWN_ALLOCATOR = 0 };
#endif

/* As if the device had no more than this beyond what it holds. */
static VkPhysicalDeviceMemoryProperties shrink_device(struct wd_gpu *gpu, uint64_t spare_bytes)
{
    VkPhysicalDeviceMemoryProperties before = gpu->memory;
    for (uint32_t i = 0; i < gpu->memory.memoryHeapCount; i++)
        gpu->memory.memoryHeaps[i].size = gpu->bytes_allocated + spare_bytes;
    return before;
}

static void full_devices_are_out_of_memory(void **state)
{
    struct suite *suite = *state;
    struct wd_gpu *gpu = &suite->renderer->gpu;
    struct wd_render_params params = suite_params(suite->forest, "over");
    struct wd_picture picture = suite_render(suite, &params);
    wd_picture_finish(&picture);
    VkPhysicalDeviceMemoryProperties before = shrink_device(gpu, 1 << 20);
    params.width = params.height = 4096;
    suite_clear(suite);
    enum wd_result drawn = wd_renderer_render(suite->renderer, &params, &picture);
    bool logged = suite_logged(suite, "out of device memory");
    enum wd_result set = wd_renderer_set_forest(suite->renderer, suite->forest);
    gpu->memory = before;
    assert_true(drawn == WD_ERROR_MEMORY && logged && !picture.display);
    assert_int_equal(set, WD_OK); /* it needs what the one before gave back */
    params = suite_params(suite->forest, "over");
    picture = suite_render(suite, &params);
    wd_picture_finish(&picture);

    assert_int_equal(wd_renderer_set_forest(suite->renderer, NULL), WD_OK);
    before = shrink_device(gpu, 1 << 20);
    set = wd_renderer_set_forest(suite->renderer, suite->forest);
    gpu->memory = before;
    assert_int_equal(set, WD_ERROR_MEMORY);
    assert_int_equal(wd_renderer_set_forest(suite->renderer, suite->forest), WD_OK);
}

/* As if the machine had no more than two gibibytes beyond what the process maps. */
static struct rlimit shrink_host(void)
{
    struct rlimit before, less;
    unsigned long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    assert_true(file && fscanf(file, "%lu", &pages) == 1);
    fclose(file);
    assert_int_equal(getrlimit(RLIMIT_AS, &before), 0);
    less = before;
    less.rlim_cur = pages * (rlim_t)sysconf(_SC_PAGESIZE) + ((rlim_t)2 << 30);
    assert_int_equal(setrlimit(RLIMIT_AS, &less), 0);
    return before;
}

/* The largest picture there is, with all layers: 15 GiB. */
static void large_pictures_are_out_of_memory(void **state)
{
    struct suite *suite = *state;
    if (OWN_ALLOCATOR)
        skip();
    struct wd_render_params params = suite_params(suite->forest, "over");
    params.width = params.height = 16384;
    params.layers = WD_LAYER_ALL;
    const struct wd_reference_params reference_params = {.log = suite->log};
    const struct wd_reference_picture_params trace = {
        .camera = params.camera, .width = 16384, .height = 16384, .layers = WD_LAYER_ALL};
    struct wd_reference *reference;
    struct wd_picture drawn, traced;
    const char *message = "out of memory: a picture of 16384 x 16384 pixels wants";
    assert_int_equal(wd_reference_create(&reference, suite->forest, &reference_params), WD_OK);
    suite_clear(suite);
    struct rlimit before = shrink_host();
    enum wd_result drawing = wd_renderer_render(suite->renderer, &params, &drawn);
    bool drawing_told = suite_logged(suite, message);
    suite_clear(suite);
    enum wd_result tracing = wd_reference_render(reference, &trace, &traced);
    bool tracing_told = suite_logged(suite, message);
    setrlimit(RLIMIT_AS, &before);
    wd_reference_destroy(&reference);
    assert_true(drawing == WD_ERROR_MEMORY && drawing_told && !drawn.display && !drawn.width);
    assert_true(tracing == WD_ERROR_MEMORY && tracing_told && !traced.display && !traced.width);
}

int memory_tests(struct suite *suite)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(large_pictures_are_out_of_memory, suite),
        cmocka_unit_test_prestate(full_devices_are_out_of_memory, suite),
    };
    return cmocka_run_group_tests_name("memory", tests, NULL, NULL);
}
