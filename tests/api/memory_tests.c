/* Memory that runs out is told from a device that fails, and what is there goes on. */
#include <malloc.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "api/renderer.h"
#include "parts.h"
#include "weald/compare.h"

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

/* The largest picture there is, with all layers: 15 GiB. */
static void large_pictures_are_out_of_memory(void **state)
{
    struct suite *suite = *state;
    struct wd_render_params params = suite_params(suite->forest, "over");
    struct wd_picture picture;
    struct rlimit before;
    params.width = params.height = 16384;
    params.layers = WD_LAYER_ALL;
    suite_clear(suite);
    if (!suite_shrink_memory(&before, UINT64_C(2) << 30))
        skip();
    enum wd_result result = wd_renderer_render(suite->renderer, &params, &picture);
    setrlimit(RLIMIT_AS, &before);
    assert_int_equal(result, WD_ERROR_MEMORY);
    assert_true(suite_logged(suite, "out of memory: a picture of 16384 x 16384 pixels wants"));
    assert_true(picture.width == 0 && !picture.display);
}

/* Has the file, of a picture one pixel wide, say that it is as wide as can be. */
static void widen(const char *path)
{
    static const char mark[] = "dataWindow\0box2i\0\20\0\0";
    static const uint8_t most[4] = {0xff, 0x7f, 0, 0};
    static char head[65536];
    FILE *file = fopen(path, "r+b");
    assert_non_null(file);
    size_t size = fread(head, 1, sizeof head, file);
    char *found = memmem(head, size, mark, sizeof mark);
    assert_non_null(found);
    assert_int_equal(fseek(file, found - head + (long)sizeof mark + 8, SEEK_SET), 0);
    assert_int_equal(fwrite(most, 1, 4, file), 4);
    assert_int_equal(fclose(file), 0);
}

static void large_files_are_out_of_memory(void **state)
{
    enum { HIGH = 16384 };
    static float depth_m[HIGH];
    static uint8_t pixel[4];
    struct suite *suite = *state;
    const struct wd_picture narrow = {.width = 1, .height = HIGH, .depth_m = depth_m};
    const struct wd_picture large = {.width = HIGH, .height = HIGH, .display = pixel};
    const char *exr = suite_path(suite, "large.exr"), *png = suite_path(suite, "large.png");
    struct wd_picture read;
    struct rlimit before;
    assert_int_equal(wd_picture_write(&narrow, exr, &suite->log), WD_OK);
    widen(exr);
    suite_clear(suite);
    if (!suite_shrink_memory(&before, 64 << 20))
        skip();
    enum wd_result reading = wd_picture_read_exr(&read, exr, &suite->log);
    enum wd_result writing = wd_picture_write(&large, png, &suite->log);
    setrlimit(RLIMIT_AS, &before);
    assert_int_equal(reading, WD_ERROR_MEMORY);
    assert_int_equal(writing, WD_ERROR_MEMORY);
    assert_true(suite_logged(suite, "large.exr: out of memory: 32768 x 16384 pixels of 1 channels want"));
    assert_true(suite_logged(suite, "out of memory: a picture of 16384 x 16384 pixels wants 768.0 MiB"));
    assert_int_not_equal(access(png, F_OK), 0);
}

/* Bytes of blocks in use; 0 under sanitizers. */
static size_t heap_bytes(void)
{
    struct mallinfo2 heap = mallinfo2();
    return heap.uordblks + heap.hblkhd;
}

/* Draws pictures, each at another time. */
static void draw_more(struct wd_renderer *renderer, struct wd_render_params *params, uint32_t pictures)
{
    for (uint32_t i = 0; i < pictures; i++) {
        struct wd_picture picture;
        params->time_s += 1;
        assert_int_equal(wd_renderer_render(renderer, params, &picture), WD_OK);
        wd_picture_finish(&picture);
    }
}

/* Nor does the driver: llvmpipe keeps a copy of a vertex shader for each picture, where a branch on a uniform is most of
 * it, 0.5 to 3 MB. What it takes once and what it holds for the thousands of draws of `separate` comes and goes: the least
 * of some stretches counts. */
static void many_pictures_take_no_more_than_few(void **state)
{
    const uint32_t few = 6, more = 4, stretches = 3;
    const double most_bytes = 1 << 20;
    struct suite *suite = *state;
    const struct wd_renderer_params renderer_params = {.gpu = "software", .log = suite->log};
    struct wd_renderer *renderer;
    assert_int_equal(wd_renderer_create(&renderer, &renderer_params), WD_OK);
    assert_int_equal(wd_renderer_set_forest(renderer, suite->forest), WD_OK);
    for (const char *const *method = wd_method_names(); *method; method++) {
        struct wd_render_params params = suite_params(suite->forest, "over");
        if (!strcmp(*method, "separate"))
            continue;
        params.method = *method;
        params.width = params.height = 24;
        params.layers = WD_LAYER_ALL;
        draw_more(renderer, &params, few);
        double least = INFINITY;
        for (uint32_t i = 0; i < stretches; i++) {
            double before = (double)heap_bytes();
            draw_more(renderer, &params, more);
            least = fmin(least, (double)heap_bytes() - before);
        }
        if (least > most_bytes)
            fail_msg("%s: %.0f bytes more after each %u pictures", *method, least, more);
    }
    wd_renderer_destroy(&renderer);
}

int memory_tests(struct suite *suite)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(large_pictures_are_out_of_memory, suite),
        cmocka_unit_test_prestate(large_files_are_out_of_memory, suite),
        cmocka_unit_test_prestate(full_devices_are_out_of_memory, suite),
        cmocka_unit_test_prestate(many_pictures_take_no_more_than_few, suite),
    };
    return cmocka_run_group_tests_name("memory", tests, NULL, NULL);
}
