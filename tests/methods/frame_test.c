#include "frame_test.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/file.h"
#include "base/memory.h"
#include "world/sun.h"

/* One device for all tests that ask for the same, with the pipelines that it keeps. */
enum { MOST_DEVICES = 4 };
static struct device {
    struct wd_gpu gpu; /* closed: 0 */
    uint32_t disabled, asked;
} devices[MOST_DEVICES];

/* Of devices: warnings at their end tell what was never destroyed. */
static void count_warning(void *user, enum wd_log_level level, const char *message)
{
    if (level > WD_LOG_WARNING)
        return;
    ++*(int *)user;
    print_message("%s\n", message);
}

static int warnings;
static const struct wd_log device_log = {count_warning, &warnings};

static struct wd_gpu *open_device(const struct frame_test_params *params)
{
    const struct wd_gpu_params gpu = {.name = "software",
                                      .validation = WD_GPU_VALIDATION_ON,
                                      .disabled_features = params->disabled,
                                      .asked_features = params->asked};
    struct device *device = devices;
    while (device->gpu.device && (device->disabled != params->disabled || device->asked != params->asked))
        assert_true(++device < devices + MOST_DEVICES);
    if (!device->gpu.device) {
        assert_true(wd_gpu_init(&device->gpu, &gpu, &device_log));
        device->disabled = params->disabled;
        device->asked = params->asked;
    }
    return &device->gpu;
}

int frame_tests_finish(void **state)
{
    (void)state;
    warnings = 0;
    for (int i = 0; i < MOST_DEVICES; i++)
        wd_gpu_finish(&devices[i].gpu);
    return warnings;
}

void frame_test_init(struct frame_test *test, const char *root,
                     const struct frame_test_params *params)
{
    const struct wd_scene_params scene = {.settings = params->settings};
    char *path = wd_format("%s/tests/api/small.json", root), *cache = wd_cache_directory();
    *test = (struct frame_test){0};
    assert_true(wd_scene_load_with(&test->scene, path, &scene, &test->log));
    assert_true(wd_world_init(&test->world, &test->scene,
                              &(struct wd_world_params){.log = &test->log}));
    test->gpu = open_device(params);
    const struct wd_forest_device_params forest = {
        .scene = &test->scene, .world = &test->world, .cache_dir = cache, .log = &test->log};
    assert_true(wd_forest_device_init(&test->forest, test->gpu, &forest));
    assert_true(wd_frame_init(&test->frame, test->gpu));
    free(cache);
    free(path);
}

void frame_test_finish(struct frame_test *test)
{
    wd_frame_drop_forest(&test->frame);
    wd_frame_finish(&test->frame);
    wd_forest_device_finish(&test->forest, test->gpu);
    wd_world_finish(&test->world);
    wd_scene_finish(&test->scene);
}

static void *read_image(struct frame_test *test, struct wd_image *image)
{
    size_t size = (size_t)4 * image->width * image->height;
    void *data = wd_alloc(size);
    assert_true(wd_image_read(test->gpu, image, 0, 0, data, size));
    return data;
}

/* As the scene's file gives it: these tests use cameras with absolute heights of their own. */
static struct wd_camera camera_of(const struct wd_scene_camera *from)
{
    struct wd_camera camera = {.yaw_rad = from->yaw_deg * 0.017453292519943295,
                               .pitch_rad = from->pitch_deg * 0.017453292519943295,
                               .fov_rad = from->fov_deg * 0.017453292519943295};
    memcpy(camera.position_m, from->position_m, sizeof camera.position_m);
    return camera;
}

static void record(struct frame_test *test, const char *method, uint32_t camera, struct wd_cmd *cmd)
{
    struct wd_frame_params params = {
        .forest = &test->forest,
        .method = wd_method_find(method),
        .camera = camera_of(&test->scene.cameras[camera]),
        .sun = wd_sun_of(&test->scene),
        .width = 320,
        .height = test->height ? test->height : 240,
        .samples = 1,
        .page_budget = test->page_budget,
        .max_error_px = test->max_error_px,
        .time_s = test->time_s,
        .previous_time_s = test->time_s,
    };
    params.camera.position_m[2] += (double)wd_terrain_height(
        &test->world.terrain, params.camera.position_m[0], params.camera.position_m[1]);
    params.previous_camera = params.camera;
    assert_true(wd_frame_prepare(&test->frame, &params));
    assert_true(wd_frame_begin(&test->frame.ring, cmd));
    wd_frame_record(&test->frame, cmd, 0);
}

void frame_test_abandon(struct frame_test *test, const char *method, uint32_t camera)
{
    struct wd_cmd cmd;
    record(test, method, camera, &cmd);
    cmd.failed = true;
    assert_false(wd_frame_submit(&cmd, VK_NULL_HANDLE, VK_NULL_HANDLE));
    wd_frame_abandoned(&test->frame);
}

void frame_test_draw(struct frame_test *test, const char *method, uint32_t camera,
                     struct frame_picture *picture)
{
    struct wd_cmd cmd;
    record(test, method, camera, &cmd);
    assert_true(wd_frame_submit(&cmd, VK_NULL_HANDLE, VK_NULL_HANDLE));
    assert_true(wd_frames_wait(&test->frame.ring));
    struct wd_targets *targets = &test->frame.targets;
    *picture = (struct frame_picture){
        .width = targets->width,
        .height = targets->height,
        .surface = read_image(test, &targets->surface),
        .albedo = read_image(test, &targets->albedo),
        .depth = read_image(test, &targets->depth),
    };
}

void frame_picture_finish(struct frame_picture *picture)
{
    free(picture->surface);
    free(picture->albedo);
    free(picture->depth);
    *picture = (struct frame_picture){0};
}
