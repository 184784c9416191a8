#include "gpu_test.h"

#include <string.h>

static const uint32_t triangles_vert[] =
#include "triangles.vert.inc"
    ;
static const uint32_t triangles_frag[] =
#include "triangles.frag.inc"
    ;
static const uint32_t shadow_vert[] =
#include "shadow.vert.inc"
    ;

enum { SIZE = 32 };
struct vertex {
    float position[4], color[4];
};

/* Each covers the lower left half of the target, counter-clockwise as seen. */
#define HALF(depth, r, g, b, a)                                                                    \
    {{-1, -1, depth, 1}, {r, g, b, a}}, {{-1, 1, depth, 1}, {r, g, b, a}},                         \
    {{1, 1, depth, 1}, {r, g, b, a}}
/* The same seen from behind. */
#define HALF_BACK(depth, r, g, b, a)                                                               \
    {{1, 1, depth, 1}, {r, g, b, a}}, {{-1, 1, depth, 1}, {r, g, b, a}},                           \
    {{-1, -1, depth, 1}, {r, g, b, a}}

struct scene {
    struct wd_image color, id, depth;
    struct wd_buffer vertices;
    struct wd_pipeline pipeline;
};

static struct wd_image make_target(struct gpu_test *test, VkFormat format, VkImageUsageFlags usage)
{
    struct wd_image image;
    assert_true(wd_image_init(&image, &test->gpu, &(struct wd_image_params){
        .name = "target", .format = format, .width = SIZE, .height = SIZE,
        .usage = usage | VK_IMAGE_USAGE_SAMPLED_BIT}));
    return image;
}

static struct wd_graphics_params usual_params(void)
{
    return (struct wd_graphics_params){
        .vertex = SPIRV(triangles_vert),
        .fragment = SPIRV(triangles_frag),
        .bindings = BINDINGS(STORAGE),
        .color_count = 2,
        .color_formats = {VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32_UINT},
        .depth_format = VK_FORMAT_D32_SFLOAT,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST,
    };
}

static void make_scene(struct scene *scene, struct gpu_test *test,
                       const struct wd_graphics_params *params, const struct vertex *vertices,
                       size_t size)
{
    const VkImageUsageFlags color = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    scene->color = make_target(test, VK_FORMAT_R32G32B32A32_SFLOAT, color);
    scene->id = make_target(test, VK_FORMAT_R32_UINT, color);
    scene->depth = make_target(test, VK_FORMAT_D32_SFLOAT,
                               VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
    scene->vertices = make_buffer(test, size);
    assert_true(wd_buffer_upload(&test->gpu, &scene->vertices, 0, vertices, size));
    assert_true(wd_pipeline_init_graphics(&scene->pipeline, &test->gpu, params));
}

static void finish_scene(struct scene *scene, struct gpu_test *test)
{
    wd_image_finish(&scene->color, &test->gpu);
    wd_image_finish(&scene->id, &test->gpu);
    wd_image_finish(&scene->depth, &test->gpu);
    wd_buffer_finish(&scene->vertices, &test->gpu);
}

static void draw_into(struct scene *scene, struct wd_cmd *cmd, enum wd_load load)
{
    const struct wd_rendering rendering = {
        .width = SIZE,
        .height = SIZE,
        .color_count = 2,
        .color = {{.image = &scene->color, .load = load, .clear = {.float32 = {0, 0, 0.5f, 1}}},
                  {.image = &scene->id, .load = load, .clear = {.uint32 = {99}}}},
        .depth = &scene->depth,
        .depth_load = load,
    };
    wd_cmd_use_buffer(cmd, &scene->vertices, WD_USE_GRAPHICS_READ);
    wd_cmd_begin_rendering(cmd, &rendering);
    wd_cmd_bind(cmd, &scene->pipeline, (struct wd_binding[]){WD_BIND_BUFFER(&scene->vertices)});
}

static void draw(struct scene *scene, struct gpu_test *test)
{
    struct wd_cmd cmd = begin_frame(test);
    draw_into(scene, &cmd, WD_LOAD_CLEAR);
    wd_cmd_draw(&cmd, (uint32_t)(scene->vertices.size / sizeof(struct vertex)), 1);
    wd_cmd_end_rendering(&cmd);
    finish_frame(test, &cmd);
}

/* In the covered half and in the free half. */
static void check(struct scene *scene, struct gpu_test *test, const float color[2][4],
                  const uint32_t id[2], const float depth[2])
{
    static float colors[SIZE][SIZE][4], depths[SIZE][SIZE];
    static uint32_t ids[SIZE][SIZE];
    assert_true(wd_image_read(&test->gpu, &scene->color, 0, 0, colors, sizeof colors));
    assert_true(wd_image_read(&test->gpu, &scene->id, 0, 0, ids, sizeof ids));
    assert_true(wd_image_read(&test->gpu, &scene->depth, 0, 0, depths, sizeof depths));
    const int at[2][2] = {{SIZE * 3 / 4, SIZE / 4}, {SIZE / 4, SIZE * 3 / 4}}; /* y, x */
    for (int i = 0; i < 2; i++) {
        assert_memory_equal(colors[at[i][0]][at[i][1]], color[i], 16);
        assert_int_equal(ids[at[i][0]][at[i][1]], id[i]);
        assert_true(depths[at[i][0]][at[i][1]] == depth[i]);
    }
}

#define COLORS(...) ((const float[2][4]){{__VA_ARGS__}, {0, 0, 0.5f, 1}})

static void nearer_wins_with_reversed_depth(void **state)
{
    struct gpu_test *test = *state;
    const struct vertex vertices[] = {
        HALF(0.25f, 1, 0, 0, 1), HALF(0.75f, 0, 1, 0, 1), HALF(0.5f, 1, 1, 1, 1)};
    struct scene scene;
    struct wd_graphics_params params = usual_params();
    make_scene(&scene, test, &params, vertices, sizeof vertices);
    draw(&scene, test);
    check(&scene, test, COLORS(0, 1, 0, 1), (uint32_t[]){2, 99}, (float[]){0.75f, 0});
    finish_scene(&scene, test);
}

static void contents_are_kept_between_passes(void **state)
{
    struct gpu_test *test = *state;
    const struct vertex vertices[] = {HALF(0.25f, 1, 0, 0, 1), HALF(0.125f, 0, 1, 0, 1)};
    struct scene scene;
    struct wd_graphics_params params = usual_params();
    make_scene(&scene, test, &params, vertices, sizeof vertices);
    struct wd_cmd cmd = begin_frame(test);
    for (int i = 0; i < 2; i++) {
        draw_into(&scene, &cmd, i ? WD_LOAD_KEEP : WD_LOAD_CLEAR);
        vkCmdDraw(cmd.vk, 3, 1, i ? 3 : 0, 0);
        wd_cmd_end_rendering(&cmd);
    }
    finish_frame(test, &cmd);
    check(&scene, test, COLORS(1, 0, 0, 1), (uint32_t[]){1, 99}, (float[]){0.25f, 0});
    finish_scene(&scene, test);
}

static void back_faces_are_culled(void **state)
{
    struct gpu_test *test = *state;
    const struct vertex vertices[] = {HALF(0.25f, 1, 0, 0, 1), HALF_BACK(0.75f, 0, 1, 0, 1)};
    struct scene scene;
    struct wd_graphics_params params = usual_params();
    params.cull = WD_CULL_BACK;
    make_scene(&scene, test, &params, vertices, sizeof vertices);
    draw(&scene, test);
    check(&scene, test, COLORS(1, 0, 0, 1), (uint32_t[]){1, 99}, (float[]){0.25f, 0});
    finish_scene(&scene, test);
}

/* The integer target of the same pipeline cannot blend and must not try. */
static void blending_is_premultiplied(void **state)
{
    struct gpu_test *test = *state;
    const struct vertex vertices[] = {HALF(0.25f, 0.25f, 0, 0, 0.5f), HALF(0.75f, 0, 0, 0, 0)};
    struct scene scene;
    struct wd_graphics_params params = usual_params();
    params.blend = WD_BLEND_PREMULTIPLIED;
    make_scene(&scene, test, &params, vertices, sizeof vertices);
    draw(&scene, test);
    check(&scene, test, COLORS(0.25f, 0, 0.25f, 1), (uint32_t[]){1, 99}, (float[]){0.25f, 0});
    finish_scene(&scene, test);
}

static void depth_can_be_tested_without_writing(void **state)
{
    struct gpu_test *test = *state;
    const struct vertex vertices[] = {HALF(0.25f, 1, 0, 0, 1)};
    struct scene scene;
    struct wd_graphics_params params = usual_params();
    params.depth_read_only = true;
    params.depth_compare = VK_COMPARE_OP_GREATER_OR_EQUAL;
    make_scene(&scene, test, &params, vertices, sizeof vertices);
    draw(&scene, test);
    check(&scene, test, COLORS(1, 0, 0, 1), (uint32_t[]){1, 99}, (float[]){0, 0});
    finish_scene(&scene, test);
}

/* As a shadow cascade is drawn: no fragment shader, one layer of a depth array, biased. */
static void depth_only_into_a_layer(void **state)
{
    struct gpu_test *test = *state;
    const struct vertex vertices[] = {HALF(0.5f, 0, 0, 0, 0)};
    struct wd_buffer buffer = make_buffer(test, sizeof vertices);
    assert_true(wd_buffer_upload(&test->gpu, &buffer, 0, vertices, sizeof vertices));
    struct wd_image image;
    assert_true(wd_image_init(&image, &test->gpu, &(struct wd_image_params){
        .name = "cascades", .format = VK_FORMAT_D32_SFLOAT, .width = SIZE, .height = SIZE,
        .layers = 3,
        .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT}));
    VkImageView view;
    assert_true(wd_image_layer_view(&test->gpu, &image, 1, 0, &view));
    struct wd_pipeline pipeline;
    assert_true(wd_pipeline_init_graphics(&pipeline, &test->gpu, &(struct wd_graphics_params){
        .vertex = SPIRV(shadow_vert), .bindings = BINDINGS(STORAGE),
        .depth_format = VK_FORMAT_D32_SFLOAT, .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST,
        .depth_bias_constant = -4096}));
    struct wd_cmd cmd = begin_frame(test);
    wd_cmd_use_buffer(&cmd, &buffer, WD_USE_GRAPHICS_READ);
    wd_cmd_begin_rendering(&cmd, &(struct wd_rendering){
        .width = SIZE, .height = SIZE, .depth = &image, .depth_view = view,
        .depth_load = WD_LOAD_CLEAR});
    wd_cmd_bind(&cmd, &pipeline, (struct wd_binding[]){WD_BIND_BUFFER(&buffer)});
    wd_cmd_draw(&cmd, 3, 1);
    wd_cmd_end_rendering(&cmd);
    finish_frame(test, &cmd);
    float depth[SIZE][SIZE];
    assert_true(wd_image_read(&test->gpu, &image, 1, 0, depth, sizeof depth));
    assert_true(depth[SIZE / 4][SIZE * 3 / 4] == 0);
    assert_true(depth[SIZE * 3 / 4][SIZE / 4] < 0.5f && depth[SIZE * 3 / 4][SIZE / 4] > 0.49f);
    vkDestroyImageView(test->gpu.device, view, NULL);
    wd_image_finish(&image, &test->gpu);
    wd_buffer_finish(&buffer, &test->gpu);
}

/* Each changes one thing. */
static void other_cull(struct wd_graphics_params *params) { params->cull = WD_CULL_BACK; }
static void other_blend(struct wd_graphics_params *params) { params->blend = WD_BLEND_PREMULTIPLIED; }
static void other_writes(struct wd_graphics_params *params) { params->color_writes = WD_COLORS_KEPT; }
static void other_compare(struct wd_graphics_params *params) { params->depth_compare = VK_COMPARE_OP_ALWAYS; }
static void other_depth(struct wd_graphics_params *params) { params->depth_read_only = true; }
static void other_bias(struct wd_graphics_params *params) { params->depth_bias_slope = 1; }
static void other_push(struct wd_graphics_params *params) { params->push_size = 16; }
static void other_format(struct wd_graphics_params *params) { params->color_formats[0] = VK_FORMAT_R16G16B16A16_SFLOAT; }
static void other_topology(struct wd_graphics_params *params)
{
    params->topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
}

static void other_parameters_give_other_pipelines(void **state)
{
    struct gpu_test *test = *state;
    void (*const changes[])(struct wd_graphics_params *) = {
        other_cull, other_blend, other_writes, other_compare, other_depth,
        other_bias, other_push,  other_format, other_topology};
    enum { CHANGES = sizeof changes / sizeof *changes };
    struct wd_pipeline pipelines[CHANGES + 1], again;
    struct wd_graphics_params params = usual_params();
    assert_true(wd_pipeline_init_graphics(&pipelines[CHANGES], &test->gpu, &params));
    for (int i = 0; i < CHANGES; i++) {
        params = usual_params();
        changes[i](&params);
        assert_true(wd_pipeline_init_graphics(&pipelines[i], &test->gpu, &params));
        assert_true(wd_pipeline_init_graphics(&again, &test->gpu, &params));
        assert_true(again.kept == pipelines[i].kept);
    }
    for (int i = 0; i <= CHANGES; i++)
        for (int k = 0; k < i; k++)
            assert_true(pipelines[i].kept != pipelines[k].kept);
}

int main(void)
{
#define GPU_TEST(f) cmocka_unit_test_setup_teardown(f, gpu_setup, gpu_teardown)
    const struct CMUnitTest tests[] = {
        GPU_TEST(nearer_wins_with_reversed_depth),
        GPU_TEST(contents_are_kept_between_passes),
        GPU_TEST(back_faces_are_culled),
        GPU_TEST(blending_is_premultiplied),
        GPU_TEST(depth_can_be_tested_without_writing),
        GPU_TEST(depth_only_into_a_layer),
        GPU_TEST(other_parameters_give_other_pipelines),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
