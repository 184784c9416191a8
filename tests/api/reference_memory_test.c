/* Memory of the path tracer: 75,000 trees in half a gigabyte, a million in one. Peaks of the whole
 * program, so the smaller forest comes first. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <sys/resource.h>

#include "weald/reference.h"

struct outcome {
    uint64_t trees;
    double peak_mb;
};

static struct outcome trace(const char *root, const char *scene, const char *const *settings)
{
    char path[512];
    struct wd_forest *forest;
    struct wd_reference *reference;
    struct wd_forest_info info;
    struct wd_picture picture;
    struct rusage usage;
    snprintf(path, sizeof path, "%s/scenes/%s.json", root, scene);
    const struct wd_forest_params params = {.scene_path = path, .settings = settings};
    const struct wd_reference_params tracing = {0};
    struct wd_reference_picture_params picture_params = {
        .width = 160, .height = 120, .samples = 1, .layers = WD_LAYER_COLOR};
    assert_int_equal(wd_forest_create(&forest, &params), WD_OK);
    wd_forest_get_info(forest, &info);
    assert_int_equal(wd_forest_get_camera(forest, "overview", &picture_params.camera), WD_OK);
    assert_int_equal(wd_reference_create(&reference, forest, &tracing), WD_OK);
    assert_int_equal(wd_reference_render(reference, &picture_params, &picture), WD_OK);
    getrusage(RUSAGE_SELF, &usage);
    wd_picture_finish(&picture);
    wd_reference_destroy(&reference);
    wd_forest_destroy(&forest);
    print_message("%s: %llu trees, %.0f MB\n", scene, (unsigned long long)info.tree_count,
                  (double)usage.ru_maxrss * 1.024e-3);
    return (struct outcome){info.tree_count, (double)usage.ru_maxrss * 1.024e-3};
}

static void test_memory(void **state)
{
    static const char *const stored[] = {"planting=stored", NULL};
    struct outcome small = trace(*state, "bench75k", NULL);
    assert_in_range(small.trees, 74000, 76000);
    assert_true(small.peak_mb <= 500);
    struct outcome large = trace(*state, "scale", stored);
    assert_in_range(large.trees, 900000, 1100000);
    assert_true(large.peak_mb <= 1000);
}

int main(int argc, char **argv)
{
    if (argc != 2)
        return 1;
    const struct CMUnitTest tests[] = {cmocka_unit_test_prestate(test_memory, argv[1])};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
