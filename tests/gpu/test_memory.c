#include "gpu_test.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

static uint32_t noise(uint32_t x)
{
    x = (x ^ (x >> 15)) * 0x2c1b3c6du;
    x = (x ^ (x >> 12)) * 0x297a2d39u;
    return x ^ (x >> 15);
}

static void fill_noise(void *data, size_t size, uint32_t seed)
{
    for (size_t i = 0; i < size; i++)
        ((uint8_t *)data)[i] = (uint8_t)noise((uint32_t)i + seed);
}

static void check_round_trip(struct gpu_test *test, VkDeviceSize size, VkDeviceSize offset)
{
    struct wd_buffer buffer = make_buffer(test, size + offset);
    char *sent = wd_alloc(size), *received = wd_alloc(size);
    fill_noise(sent, size, (uint32_t)size);
    assert_true(wd_buffer_upload(&test->gpu, &buffer, offset, sent, size));
    assert_true(wd_buffer_read(&test->gpu, &buffer, offset, received, size));
    assert_memory_equal(sent, received, size);
    free(sent);
    free(received);
    wd_buffer_finish(&buffer, &test->gpu);
}

static void buffers_round_trip(void **state)
{
    struct gpu_test *test = *state;
    check_round_trip(test, 4, 0);
    check_round_trip(test, 4099, 12);
    check_round_trip(test, (40 << 20) + 3, 8);
}

static void empty_transfer_is_fine(void **state)
{
    struct gpu_test *test = *state;
    struct wd_buffer buffer = make_buffer(test, 16);
    assert_true(wd_buffer_upload(&test->gpu, &buffer, 16, NULL, 0));
    wd_buffer_finish(&buffer, &test->gpu);
}

static void mapped_memory_is_shared(void **state)
{
    struct gpu_test *test = *state;
    struct wd_buffer up, down;
    struct wd_buffer_params params = {.name = "up", .size = 64, .memory = WD_MEMORY_UPLOAD};
    assert_true(wd_buffer_init(&up, &test->gpu, &params));
    params.memory = WD_MEMORY_READBACK;
    assert_true(wd_buffer_init(&down, &test->gpu, &params));
    fill_noise(up.mapped, 64, 5);
    struct wd_cmd cmd = begin_frame(test);
    wd_cmd_use_buffer(&cmd, &up, WD_USE_TRANSFER_READ);
    wd_cmd_use_buffer(&cmd, &down, WD_USE_TRANSFER_WRITE);
    vkCmdCopyBuffer(cmd.vk, up.buffer, down.buffer, 1, &(VkBufferCopy){0, 0, 64});
    wd_cmd_use_buffer(&cmd, &down, WD_USE_HOST_READ);
    finish_frame(test, &cmd);
    assert_memory_equal(up.mapped, down.mapped, 64);
    wd_buffer_finish(&up, &test->gpu);
    wd_buffer_finish(&down, &test->gpu);
}

static void check_image(struct gpu_test *test, const struct wd_image_params *params)
{
    struct wd_image image;
    assert_true(wd_image_init(&image, &test->gpu, params));
    uint32_t texel = wd_format_texel_bytes(params->format);
    size_t largest = (size_t)image.width * image.height * texel;
    uint8_t *sent = wd_alloc(largest), *received = wd_alloc(largest);
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t i = 0; i < image.layers * image.mips; i++) {
            uint32_t layer = i / image.mips, mip = i % image.mips;
            uint32_t width = image.width >> mip, height = image.height >> mip;
            size_t size = (size_t)(width ? width : 1) * (height ? height : 1) * texel;
            fill_noise(sent, size, i * 7919);
            if (pass == 0) {
                assert_true(wd_image_upload(&test->gpu, &image, layer, mip, sent, size));
                continue;
            }
            assert_true(wd_image_read(&test->gpu, &image, layer, mip, received, size));
            assert_memory_equal(sent, received, size);
        }
    }
    free(sent);
    free(received);
    wd_image_finish(&image, &test->gpu);
}

static void images_round_trip(void **state)
{
    struct gpu_test *test = *state;
    const VkImageUsageFlags sampled = VK_IMAGE_USAGE_SAMPLED_BIT;
    const uint32_t most = test->gpu.properties.limits.maxImageDimension2D; /* a power of two */
    const struct wd_image_params images[] = {
        {"layers and mips", VK_FORMAT_R8G8B8A8_UNORM, 37, 20, 5, WD_ALL_MIPS, sampled, 0},
        {"one texel", VK_FORMAT_R32_UINT, 1, 1, 0, 0, sampled, WD_IMAGE_ARRAY},
        {"several bands", VK_FORMAT_R32G32B32A32_SFLOAT, 1531, 1100, 1, 1, sampled, 0},
        {"bytes", VK_FORMAT_R8_UNORM, 13, 7, 3, 1, sampled, 0},
        {"depth", VK_FORMAT_D32_SFLOAT, 33, 9, 2, 1,
         sampled | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, 0},
        {"only moved", VK_FORMAT_R8G8B8A8_UNORM, 8, 8, 1, 1, 0, 0},
        {"larger than asked for", VK_FORMAT_R32_UINT, 64, 16, 1, 1, sampled, 0, 0, true},
        {"no larger than can be", VK_FORMAT_R8_UNORM, most, 3, 1, 1, sampled, 0, 0, true},
    };
    for (size_t i = 0; i < sizeof images / sizeof images[0]; i++)
        check_image(test, &images[i]);
}

static void odd_sides_are_no_powers_of_two(void **state)
{
    static const uint32_t sides[][2] = {{1, 3}, {2, 3}, {3, 3}, {64, 65}, {65, 65}, {100, 100}, {16384, 16385}};
    (void)state;
    for (size_t i = 0; i < sizeof sides / sizeof sides[0]; i++)
        assert_int_equal(wd_image_odd_side(sides[i][0]), sides[i][1]);
}

static void all_mips_go_down_to_one_texel(void **state)
{
    struct gpu_test *test = *state;
    struct wd_image image;
    const struct wd_image_params params = {
        .name = "mips", .format = VK_FORMAT_R8_UNORM, .width = 100, .height = 3,
        .mips = WD_ALL_MIPS, .usage = VK_IMAGE_USAGE_SAMPLED_BIT};
    assert_true(wd_image_init(&image, &test->gpu, &params));
    assert_int_equal(image.mips, 7);
    VkImageView view;
    assert_true(wd_image_layer_view(&test->gpu, &image, 0, 6, &view));
    vkDestroyImageView(test->gpu.device, view, NULL);
    wd_image_finish(&image, &test->gpu);
}

static void absurd_buffer_is_out_of_memory(void **state)
{
    struct gpu_test *test = *state;
    struct wd_buffer held = make_buffer(test, 3 << 20), buffer;
    struct wd_buffer_params params = {
        .name = "moon", .size = 1ull << 60, .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT};
    assert_false(wd_buffer_init(&buffer, &test->gpu, &params));
    assert_logged(test, "out of device memory: \"moon\" wants 1099511627776.0 MiB, 3.0 MiB");
    assert_int_equal(test->errors, 1);
    assert_null(buffer.buffer);
    wd_buffer_finish(&buffer, &test->gpu);
    wd_buffer_finish(&held, &test->gpu);
    assert_int_equal(test->gpu.bytes_allocated, 0);
    assert_true(test->gpu.bytes_peak >= 3 << 20);
}

/* As if the heaps were nearly full. */
static void full_heap_is_out_of_memory(void **state)
{
    struct gpu_test *test = *state;
    for (uint32_t i = 0; i < test->gpu.memory.memoryHeapCount; i++)
        test->gpu.memory.memoryHeaps[i].size = 5 << 20;
    struct wd_buffer first = make_buffer(test, 3 << 20), second;
    const struct wd_buffer_params params = {
        .name = "second", .size = 3 << 20, .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT};
    assert_false(wd_buffer_init(&second, &test->gpu, &params));
    assert_logged(test, "\"second\" wants 3.0 MiB, 3.0 MiB are held already");
    struct wd_image image;
    assert_false(wd_image_init(&image, &test->gpu, &(struct wd_image_params){
        .name = "wall", .format = VK_FORMAT_R8G8B8A8_UNORM, .width = 1024, .height = 1024,
        .usage = VK_IMAGE_USAGE_SAMPLED_BIT}));
    assert_logged(test, "\"wall\" wants 4.0 MiB");
    assert_null(image.image);
    wd_buffer_finish(&first, &test->gpu);
    first = make_buffer(test, 4 << 20);
    wd_buffer_finish(&first, &test->gpu);
}

static void object_limit_is_an_error(void **state)
{
    struct gpu_test *test = *state;
    test->gpu.properties.limits.maxMemoryAllocationCount = 1;
    struct wd_buffer first = make_buffer(test, 16), second;
    assert_false(wd_buffer_init(&second, &test->gpu, &(struct wd_buffer_params){
        .name = "second", .size = 16, .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT}));
    assert_logged(test, "\"second\" would be GPU object 2");
    wd_buffer_finish(&first, &test->gpu);
}

static void bad_images_are_named(void **state)
{
    struct gpu_test *test = *state;
    struct wd_image image;
    struct wd_image_params params = {
        .name = "tower", .format = VK_FORMAT_R8G8B8A8_UNORM, .width = 100000, .height = 1,
        .usage = VK_IMAGE_USAGE_SAMPLED_BIT};
    assert_false(wd_image_init(&image, &test->gpu, &params));
    assert_logged(test, "\"tower\" of 100000x1");
    params.width = 0;
    assert_false(wd_image_init(&image, &test->gpu, &params));
    assert_logged(test, "\"tower\" of 0x1");
    params.width = 1;
    params.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    assert_false(wd_image_init(&image, &test->gpu, &params));
    assert_logged(test, "cannot use format R8G8B8A8_UNORM (VkFormat 37) as depth target");
    params.format = VK_FORMAT_D24_UNORM_S8_UINT;
    assert_false(wd_image_init(&image, &test->gpu, &params));
    assert_logged(test, "not among the renderer's formats");
}

static void wrong_image_size_is_an_error(void **state)
{
    struct gpu_test *test = *state;
    struct wd_image image;
    assert_true(wd_image_init(&image, &test->gpu, &(struct wd_image_params){
        .name = "small", .format = VK_FORMAT_R8G8B8A8_UNORM, .width = 4, .height = 4,
        .usage = VK_IMAGE_USAGE_SAMPLED_BIT}));
    char data[63] = {0};
    assert_false(wd_image_upload(&test->gpu, &image, 0, 0, data, sizeof data));
    assert_logged(test, "63 bytes where 4x4 texels of 4 bytes are due");
    wd_image_finish(&image, &test->gpu);
}

static void empty_buffer_is_an_error(void **state)
{
    struct gpu_test *test = *state;
    struct wd_buffer buffer;
    assert_false(wd_buffer_init(&buffer, &test->gpu, &(struct wd_buffer_params){.name = "void"}));
    assert_logged(test, "\"void\" would be empty");
}

static void samplers_of_each_kind(void **state)
{
    struct gpu_test *test = *state;
    for (int kind = WD_SAMPLER_NEAREST_CLAMP; kind <= WD_SAMPLER_SHADOW; kind++) {
        VkSampler sampler;
        assert_true(wd_sampler_init(&sampler, &test->gpu, (enum wd_sampler_kind)kind));
        vkDestroySampler(test->gpu.device, sampler, NULL);
    }
}

int main(void)
{
#define GPU_TEST(f) cmocka_unit_test_setup_teardown(f, gpu_setup, gpu_teardown)
    const struct CMUnitTest tests[] = {
        GPU_TEST(buffers_round_trip),
        GPU_TEST(empty_transfer_is_fine),
        GPU_TEST(mapped_memory_is_shared),
        GPU_TEST(images_round_trip),
        GPU_TEST(odd_sides_are_no_powers_of_two),
        GPU_TEST(all_mips_go_down_to_one_texel),
        GPU_TEST(absurd_buffer_is_out_of_memory),
        GPU_TEST(full_heap_is_out_of_memory),
        GPU_TEST(object_limit_is_an_error),
        GPU_TEST(bad_images_are_named),
        GPU_TEST(wrong_image_size_is_an_error),
        GPU_TEST(empty_buffer_is_an_error),
        GPU_TEST(samplers_of_each_kind),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
