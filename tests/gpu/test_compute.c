#include "gpu_test.h"

#include <stdlib.h>

#include "base/memory.h"

static const uint32_t fill_comp[] =
#include "fill.comp.inc"
    ;
static const uint32_t count_comp[] =
#include "count.comp.inc"
    ;
static const uint32_t paint_comp[] =
#include "paint.comp.inc"
    ;
static const uint32_t sample_comp[] =
#include "sample.comp.inc"
    ;

static void dispatch_writes_a_buffer(void **state)
{
    struct gpu_test *test = *state;
    enum { COUNT = 100003 };
    struct wd_pipeline pipeline;
    const struct wd_compute_params params = {
        .shader = SPIRV(fill_comp),
        .bindings = BINDINGS(STORAGE),
        .push_size = 8,
        .constants = {1, (const uint32_t[]){5}},
    };
    assert_true(wd_pipeline_init_compute(&pipeline, &test->gpu, &params));
    struct wd_buffer buffer = make_buffer(test, COUNT * 4);
    struct wd_cmd cmd = begin_frame(test);
    wd_cmd_use_buffer(&cmd, &buffer, WD_USE_COMPUTE_WRITE);
    wd_cmd_bind(&cmd, &pipeline, (struct wd_binding[]){WD_BIND_BUFFER(&buffer)});
    wd_cmd_push(&cmd, &pipeline, (uint32_t[]){1000, COUNT}, 8);
    wd_cmd_dispatch_1d(&cmd, (COUNT + 63) / 64);
    finish_frame(test, &cmd);
    uint32_t *values = wd_alloc(COUNT * 4);
    assert_true(wd_buffer_read(&test->gpu, &buffer, 0, values, COUNT * 4));
    for (uint32_t i = 0; i < COUNT; i++)
        assert_int_equal(values[i], 1000 + 5 * i);
    free(values);
    wd_buffer_finish(&buffer, &test->gpu);
}

static void more_groups_than_one_dimension_holds(void **state)
{
    struct gpu_test *test = *state;
    const uint32_t groups = 3 * 65535 + 1234;
    struct wd_pipeline pipeline = make_compute(test, SPIRV(count_comp), BINDINGS(STORAGE), 0);
    struct wd_buffer buffer = make_buffer(test, 8);
    struct wd_cmd cmd = begin_frame(test);
    wd_cmd_fill_buffer(&cmd, &buffer, 0);
    wd_cmd_use_buffer(&cmd, &buffer, WD_USE_COMPUTE_WRITE);
    wd_cmd_bind(&cmd, &pipeline, (struct wd_binding[]){WD_BIND_BUFFER(&buffer)});
    wd_cmd_dispatch_1d(&cmd, groups);
    finish_frame(test, &cmd);
    uint32_t total[2];
    assert_true(wd_buffer_read(&test->gpu, &buffer, 0, total, sizeof total));
    assert_in_range(total[0], groups, groups + 4); /* the last row may be a little too long */
    assert_int_equal(total[1], total[0] - 1);
    wd_buffer_finish(&buffer, &test->gpu);
}

static void absurd_dispatch_fails_the_frame(void **state)
{
    struct gpu_test *test = *state;
    struct wd_cmd cmd = begin_frame(test);
    wd_cmd_dispatch_1d(&cmd, 0);
    assert_false(cmd.failed);
    wd_cmd_dispatch_1d(&cmd, 1ull << 40);
    assert_logged(test, "1099511627776 workgroups");
    assert_false(wd_frame_submit(&cmd, VK_NULL_HANDLE, VK_NULL_HANDLE));
}

static void too_long_a_binding_fails_the_frame(void **state)
{
    struct gpu_test *test = *state;
    test->gpu.properties.limits.maxStorageBufferRange = 1024;
    struct wd_pipeline pipeline = make_compute(test, SPIRV(count_comp), BINDINGS(STORAGE), 0);
    struct wd_buffer buffer = make_buffer(test, 2048);
    struct wd_cmd cmd = begin_frame(test);
    wd_cmd_bind(&cmd, &pipeline, (struct wd_binding[]){{.buffer = &buffer, .offset = 1024}});
    assert_false(cmd.failed);
    wd_cmd_bind(&cmd, &pipeline, (struct wd_binding[]){WD_BIND_BUFFER(&buffer)});
    assert_logged(test, "binding 0 is 2048 bytes long");
    wd_cmd_dispatch(&cmd, 1, 1, 1);
    assert_false(wd_frame_submit(&cmd, VK_NULL_HANDLE, VK_NULL_HANDLE));
    wd_buffer_finish(&buffer, &test->gpu);
}

static void indirect_dispatch(void **state)
{
    struct gpu_test *test = *state;
    struct wd_pipeline pipeline = make_compute(test, SPIRV(count_comp), BINDINGS(STORAGE), 0);
    struct wd_buffer total = make_buffer(test, 8), arguments = make_buffer(test, 12);
    struct wd_cmd cmd = begin_frame(test);
    wd_cmd_fill_buffer(&cmd, &total, 0);
    wd_cmd_fill_buffer(&cmd, &arguments, 3);
    wd_cmd_use_buffer(&cmd, &total, WD_USE_COMPUTE_WRITE);
    wd_cmd_use_buffer(&cmd, &arguments, WD_USE_INDIRECT);
    wd_cmd_bind(&cmd, &pipeline, (struct wd_binding[]){WD_BIND_BUFFER(&total)});
    wd_cmd_dispatch_indirect(&cmd, &arguments, 0);
    finish_frame(test, &cmd);
    uint32_t count;
    assert_true(wd_buffer_read(&test->gpu, &total, 0, &count, 4));
    assert_int_equal(count, 27);
    wd_buffer_finish(&total, &test->gpu);
    wd_buffer_finish(&arguments, &test->gpu);
}

static void storage_image_is_painted(void **state)
{
    struct gpu_test *test = *state;
    enum { WIDTH = 50, HEIGHT = 30 };
    struct wd_pipeline pipeline =
        make_compute(test, SPIRV(paint_comp), BINDINGS(STORAGE_IMAGE, STORAGE), 0);
    struct wd_image image;
    assert_true(wd_image_init(&image, &test->gpu, &(struct wd_image_params){
        .name = "canvas", .format = VK_FORMAT_R8G8B8A8_UNORM, .width = WIDTH, .height = HEIGHT,
        .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT}));
    struct wd_buffer dummy = make_buffer(test, 16);
    struct wd_cmd cmd = begin_frame(test);
    wd_cmd_use_image(&cmd, &image, WD_USE_COMPUTE_WRITE);
    wd_cmd_bind(&cmd, &pipeline, (struct wd_binding[]){WD_BIND_STORAGE_IMAGE(&image),
                                                       WD_BIND_BUFFER(&dummy)});
    wd_cmd_dispatch(&cmd, (WIDTH + 7) / 8, (HEIGHT + 7) / 8, 1);
    finish_frame(test, &cmd);
    uint8_t texels[HEIGHT][WIDTH][4];
    assert_true(wd_image_read(&test->gpu, &image, 0, 0, texels, sizeof texels));
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++)
            assert_memory_equal(texels[y][x], ((uint8_t[]){(uint8_t)x, (uint8_t)y, 7, 255}), 4);
    }
    wd_image_finish(&image, &test->gpu);
    wd_buffer_finish(&dummy, &test->gpu);
}

static void fill_layers(struct gpu_test *test, struct wd_image *image)
{
    for (uint32_t i = 0; i < 4; i++) {
        uint32_t layer = i / 2, mip = i % 2, side = 2 >> mip;
        float texels[4][4];
        for (uint32_t t = 0; t < side * side; t++) {
            for (uint32_t c = 0; c < 4; c++)
                texels[t][c] = (float)(100 * layer + 10 * mip + t);
        }
        assert_true(wd_image_upload(&test->gpu, image, layer, mip, texels, side * side * 16));
    }
}

static void layers_and_mips_are_sampled(void **state)
{
    struct gpu_test *test = *state;
    struct wd_pipeline pipeline =
        make_compute(test, SPIRV(sample_comp), BINDINGS(SAMPLED, STORAGE, UNIFORM), 0);
    struct wd_image image;
    assert_true(wd_image_init(&image, &test->gpu, &(struct wd_image_params){
        .name = "layers", .format = VK_FORMAT_R32G32B32A32_SFLOAT, .width = 2, .height = 2,
        .layers = 2, .mips = 2, .usage = VK_IMAGE_USAGE_SAMPLED_BIT}));
    fill_layers(test, &image);
    VkSampler sampler;
    assert_true(wd_sampler_init(&sampler, &test->gpu, WD_SAMPLER_NEAREST_CLAMP));
    struct wd_buffer result = make_buffer(test, 64);
    struct wd_cmd cmd = begin_frame(test);
    const float places[16] = {0.25f, 0.25f, 0, 0.75f, 0.25f, 1, 0.5f, 0.5f, 0, 0.25f, 0.75f, 1,
                              0,     0,     1, 0};
    struct wd_binding where;
    float *upload = wd_cmd_upload(&cmd, sizeof places, &where);
    assert_non_null(upload);
    for (int i = 0; i < 16; i++)
        upload[i] = places[i];
    wd_cmd_use_image(&cmd, &image, WD_USE_COMPUTE_READ);
    wd_cmd_use_buffer(&cmd, &result, WD_USE_COMPUTE_WRITE);
    wd_cmd_bind(&cmd, &pipeline, (struct wd_binding[]){WD_BIND_IMAGE(&image, sampler),
                                                       WD_BIND_BUFFER(&result), where});
    wd_cmd_dispatch(&cmd, 4, 1, 1);
    finish_frame(test, &cmd);
    float values[4][4];
    assert_true(wd_buffer_read(&test->gpu, &result, 0, values, sizeof values));
    const float expected[4] = {0, 101, 10, 102};
    for (int i = 0; i < 4; i++)
        assert_true(values[i][0] == expected[i]);
    vkDestroySampler(test->gpu.device, sampler, NULL);
    wd_buffer_finish(&result, &test->gpu);
    wd_image_finish(&image, &test->gpu);
}

static void what_is_not_spirv_is_refused(void **state)
{
    struct gpu_test *test = *state;
    struct wd_pipeline pipeline;
    const uint32_t junk[8] = {1, 2, 3};
    assert_false(wd_pipeline_init_compute(&pipeline, &test->gpu, &(struct wd_compute_params){
        .shader = SPIRV(junk)}));
    assert_logged(test, "shader \"junk\" is not SPIR-V");
    assert_null(pipeline.layout);
}

static void equal_parameters_give_the_same_pipeline(void **state)
{
    struct gpu_test *test = *state;
    uint32_t constants[] = {5};
    struct wd_compute_params params = {
        .shader = SPIRV(fill_comp), .bindings = BINDINGS(STORAGE), .push_size = 8, .constants = {1, constants}};
    struct wd_pipeline first, same, other;
    assert_true(wd_pipeline_init_compute(&first, &test->gpu, &params));
    assert_true(wd_pipeline_init_compute(&same, &test->gpu, &params));
    assert_true(same.kept == first.kept && same.layout == first.layout);
    constants[0] = 6;
    assert_true(wd_pipeline_init_compute(&other, &test->gpu, &params));
    assert_true(other.kept != first.kept);
    constants[0] = 5;
    assert_true(wd_pipeline_init_compute(&same, &test->gpu, &params));
    assert_true(same.kept == first.kept);
}

/* Drivers make pipelines as they are bound. */
static void what_cannot_be_made_fails_the_frame(void **state)
{
    struct gpu_test *test = *state;
    struct wd_pipeline pipeline = make_compute(test, SPIRV(count_comp), BINDINGS(STORAGE), 0);
    struct wd_buffer buffer = make_buffer(test, 2048);
    struct wd_cmd cmd = begin_frame(test);
    test->gpu.lost = true;
    wd_cmd_bind(&cmd, &pipeline, (struct wd_binding[]){WD_BIND_BUFFER(&buffer)});
    assert_true(cmd.failed);
    test->gpu.lost = false;
    assert_false(wd_frame_submit(&cmd, VK_NULL_HANDLE, VK_NULL_HANDLE));
    assert_true(wd_pipeline_make(&pipeline, &test->gpu));
    cmd = begin_frame(test);
    test->gpu.lost = true;
    wd_cmd_bind(&cmd, &pipeline, (struct wd_binding[]){WD_BIND_BUFFER(&buffer)});
    test->gpu.lost = false;
    assert_false(cmd.failed); /* it was there */
    finish_frame(test, &cmd);
    wd_buffer_finish(&buffer, &test->gpu);
}

static void frames_tell_what_making_pipelines_took(void **state)
{
    struct gpu_test *test = *state;
    struct wd_pipeline pipeline = make_compute(test, SPIRV(count_comp), BINDINGS(STORAGE), 0);
    struct wd_buffer buffer = make_buffer(test, 2048);
    assert_true(test->gpu.making_s == 0);
    struct wd_cmd cmd = begin_frame(test);
    wd_cmd_bind(&cmd, &pipeline, (struct wd_binding[]){WD_BIND_BUFFER(&buffer)});
    double first_s = test->gpu.making_s;
    assert_true(first_s > 0 && test->gpu.making_processor_s > 0);
    wd_cmd_bind(&cmd, &pipeline, (struct wd_binding[]){WD_BIND_BUFFER(&buffer)});
    assert_true(test->gpu.making_s == first_s);
    finish_frame(test, &cmd);
    wd_buffer_finish(&buffer, &test->gpu);
}

int main(void)
{
#define GPU_TEST(f) cmocka_unit_test_setup_teardown(f, gpu_setup, gpu_teardown)
    const struct CMUnitTest tests[] = {
        GPU_TEST(dispatch_writes_a_buffer),
        GPU_TEST(more_groups_than_one_dimension_holds),
        GPU_TEST(absurd_dispatch_fails_the_frame),
        GPU_TEST(too_long_a_binding_fails_the_frame),
        GPU_TEST(indirect_dispatch),
        GPU_TEST(storage_image_is_painted),
        GPU_TEST(layers_and_mips_are_sampled),
        GPU_TEST(what_is_not_spirv_is_refused),
        GPU_TEST(equal_parameters_give_the_same_pipeline),
        GPU_TEST(what_cannot_be_made_fails_the_frame),
        GPU_TEST(frames_tell_what_making_pipelines_took),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
