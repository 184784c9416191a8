#include "api/renderer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "api/arguments.h"
#include "api/shown.h"
#include "base/clock.h"
#include "base/file.h"
#include "base/memory.h"
#include "scene/nearest.h"
#include "weald/vulkan.h"

enum { MAX_SAMPLES = 65536 };

_Static_assert((int)WD_VIEW_LIT == WD_MODE_LIT && (int)WD_VIEW_LOD == WD_MODE_LOD &&
                   (int)WD_VIEW_ALBEDO == WD_MODE_ALBEDO && (int)WD_VIEW_NORMAL == WD_MODE_NORMAL &&
                   (int)WD_VIEW_TREE_ID == WD_MODE_TREE_ID && (int)WD_VIEW_SHADOW == WD_MODE_SHADOW,
               "shaders are handed the view as it is");

enum wd_result wd_renderer_failure(const struct wd_renderer *renderer)
{
    bool no_memory = renderer->no_memory || renderer->gpu.no_memory;
    return no_memory && !renderer->gpu.lost ? WD_ERROR_MEMORY : WD_ERROR_DEVICE;
}

/* --- making ------------------------------------------------------------------------------ */

static enum wd_result create(struct wd_renderer **result, const struct wd_gpu_params *gpu,
                             const struct wd_renderer_params *params)
{
    struct wd_renderer *renderer = wd_alloc(sizeof *renderer);
    renderer->log = params->log;
    renderer->progress = params->progress;
    renderer->threads = params->threads;
    renderer->cache_dir = params->cache_dir ? wd_strdup(params->cache_dir) : wd_cache_directory();
    if (!wd_gpu_init(&renderer->gpu, gpu, &renderer->log) ||
        !wd_frame_init(&renderer->frame, &renderer->gpu)) {
        enum wd_result failure = wd_renderer_failure(renderer);
        wd_renderer_destroy(&renderer);
        return failure;
    }
    renderer->gpu.threads = params->threads;
    *result = renderer;
    return WD_OK;
}

static bool check_create(struct wd_renderer **renderer, const struct wd_renderer_params *params,
                         const char *function)
{
    *renderer = NULL;
    return wd_check_given(params, function, "params", NULL) &&
           wd_check_choice(params->validation, WD_VALIDATION_ON + 1, "validation", &params->log);
}

static struct wd_gpu_params gpu_params(const struct wd_renderer_params *params)
{
    return (struct wd_gpu_params){
        .name = params->gpu,
        .validation =
            params->validation == WD_VALIDATION_ON ? WD_GPU_VALIDATION_ON : WD_GPU_VALIDATION_OFF,
    };
}

enum wd_result wd_renderer_create(struct wd_renderer **renderer,
                                  const struct wd_renderer_params *params)
{
    if (!check_create(renderer, params, __func__))
        return WD_ERROR_INPUT;
    const struct wd_gpu_params gpu = gpu_params(params);
    return create(renderer, &gpu, params);
}

enum wd_result wd_renderer_create_presenting(struct wd_renderer **renderer,
                                             const char *const *instance_extensions,
                                             uint32_t instance_extension_count,
                                             const struct wd_renderer_params *params)
{
    if (!check_create(renderer, params, __func__) ||
        (instance_extension_count && !wd_given(instance_extensions, &params->log)))
        return WD_ERROR_INPUT;
    struct wd_gpu_params gpu = gpu_params(params);
    gpu.instance_extensions = instance_extensions;
    gpu.instance_extension_count = instance_extension_count;
    gpu.presentation = WD_GPU_PRESENT;
    return create(renderer, &gpu, params);
}

enum wd_result wd_renderer_create_vulkan(struct wd_renderer **renderer,
                                         const struct wd_vulkan_handles *handles,
                                         const struct wd_renderer_params *params)
{
    if (!check_create(renderer, params, __func__) || !wd_given(handles, &params->log))
        return WD_ERROR_INPUT;
    const struct wd_gpu_external external = {handles->instance, handles->physical_device,
                                             handles->device, handles->queue,
                                             handles->queue_family, handles->enabled};
    const struct wd_gpu_params gpu = {.external = &external};
    return create(renderer, &gpu, params);
}

void wd_renderer_destroy(struct wd_renderer **renderer)
{
    if (!renderer || !*renderer)
        return;
    struct wd_renderer *r = *renderer;
    wd_frame_finish(&r->frame);
    if (r->forest)
        wd_forest_device_finish(&r->device, &r->gpu);
    wd_gpu_finish(&r->gpu);
    free(r->cache_dir);
    free(r);
    *renderer = NULL;
}

/* --- the forest -------------------------------------------------------------------------- */

static bool stopped_report(void *user, const char *stage, uint64_t done, uint64_t total)
{
    struct wd_renderer *renderer = user;
    bool go_on = wd_progress_report(&renderer->progress, stage, done, total);
    renderer->stopped |= !go_on;
    return go_on;
}

enum wd_result wd_renderer_set_forest(struct wd_renderer *renderer, const struct wd_forest *forest)
{
    renderer->no_memory = renderer->gpu.no_memory = false;
    if (!wd_frames_wait(&renderer->frame.ring))
        return wd_renderer_failure(renderer);
    if (renderer->forest) {
        wd_frame_drop_forest(&renderer->frame);
        wd_forest_device_finish(&renderer->device, &renderer->gpu);
        renderer->gpu.bytes_peak = renderer->gpu.bytes_allocated;
    }
    renderer->forest = NULL;
    if (!forest)
        return WD_OK;
    const struct wd_progress progress = {stopped_report, renderer};
    const struct wd_forest_device_params params = {
        .scene = &forest->scene,
        .world = &forest->world,
        .cache_dir = renderer->cache_dir,
        .threads = renderer->threads,
        .progress = &progress,
        .log = &renderer->log,
    };
    renderer->stopped = false;
    if (!wd_forest_device_init(&renderer->device, &renderer->gpu, &params))
        return renderer->stopped ? WD_ERROR_INTERRUPTED : wd_renderer_failure(renderer);
    renderer->device.progress = progress;
    renderer->forest = forest;
    return WD_OK;
}

/* --- pictures ---------------------------------------------------------------------------- */

static bool check_motion(const struct wd_render_params *params, const struct wd_log *log)
{
    return wd_check_time(params->previous_time_s, "previous_time_s", log) &&
           (!params->previous_camera ||
            wd_check_camera(params->previous_camera, "previous_camera", log));
}

static bool check(const struct wd_renderer *renderer, const struct wd_render_params *params)
{
    const struct wd_log *log = &renderer->log;
    if (!renderer->forest)
        return wd_error(log, "no forest is set to be drawn: call wd_renderer_set_forest first");
    double error_px = params->max_error_px;
    if (error_px != 0.0 && !(error_px >= WD_LEAST_ERROR_PX && error_px <= WD_MOST_ERROR_PX))
        return wd_error(log, "an error of %g pixels: %g to %g are possible", error_px,
                        WD_LEAST_ERROR_PX, WD_MOST_ERROR_PX);
    return wd_check_size(params->width, params->height, log) &&
           wd_check_samples(params->samples, MAX_SAMPLES, log) &&
           wd_check_choice(params->view, WD_VIEW_SHADOW + 1, "view", log) &&
           wd_check_choice(params->accumulation, WD_ACCUMULATE + 1, "accumulation", log) &&
           wd_check_choice(params->timing, WD_TIME_PASSES + 1, "timing", log) &&
           wd_check_camera(&params->camera, "camera", log) &&
           wd_check_sun(params->sun, &renderer->forest->world, log) &&
           wd_check_time(params->time_s, "time_s", log) &&
           (params->accumulation == WD_ACCUMULATE || check_motion(params, log));
}

static uint32_t layers_of(const struct wd_render_params *params)
{
    return params->layers ? params->layers : WD_LAYER_DISPLAY;
}

/* Before anything is drawn, so that the largest blocks are the first to be refused. */
static bool make_room(struct wd_renderer *renderer, const struct wd_render_params *params,
                      struct wd_picture *picture)
{
    uint32_t layers = layers_of(params);
    if (!wd_picture_make_room(picture, params->width, params->height, layers, &renderer->log))
        return false;
    size_t pixels = (size_t)params->width * params->height;
    return !(layers & WD_LAYER_CRYPTOMATTE) || wd_coverage_init(&renderer->coverage, pixels) ||
           wd_error(&renderer->log, "out of memory: there is no room to count the trees of %zu pixels",
                    pixels);
}

static enum wd_result no_such_method(const char *name, const struct wd_log *log)
{
    const char *const *names = wd_method_names();
    size_t count = 0;
    while (names[count])
        count++;
    const char *nearest = wd_nearest_name(name, names, count);
    char *list = wd_join(names, count, ", ");
    wd_error(log, "no method \"%.200s\"%s%s%s; there are: %s", name, nearest ? ", did you mean \"" : "",
             nearest ? nearest : "", nearest ? "\"" : "", list);
    free(list);
    return WD_ERROR_INPUT;
}

static enum wd_gbuffer_use gbuffer_use(uint32_t layers)
{
    const uint32_t lit = WD_LAYER_DISPLAY | WD_LAYER_COLOR;
    if (layers & WD_LAYER_CRYPTOMATTE)
        return WD_GBUFFER_READ_EACH;
    return layers & ~lit ? WD_GBUFFER_READ : WD_GBUFFER_OWN;
}

enum wd_result wd_renderer_prepare(struct wd_renderer *renderer,
                                   const struct wd_render_params *params, uint32_t max_samples,
                                   enum wd_frame_light light, struct wd_picture *picture)
{
    if (renderer->gpu.lost) {
        wd_error(&renderer->log, "the device was lost: make a new renderer");
        return WD_ERROR_DEVICE;
    }
    if (!check(renderer, params))
        return WD_ERROR_INPUT;
    const char *name = params->method ? params->method : renderer->forest->scene.method;
    const struct wd_method *method = wd_method_find(name);
    if (!method)
        return no_such_method(name, &renderer->log);
    if (!wd_method_can_draw(method, &renderer->forest->world, &renderer->log))
        return WD_ERROR_INPUT;
    renderer->no_memory = renderer->gpu.no_memory = false;
    if (picture && !make_room(renderer, params, picture))
        return WD_ERROR_MEMORY;
    uint32_t samples = params->samples ? params->samples : 1;
    const struct wd_frame_params frame = {
        .forest = &renderer->device,
        .method = method,
        .camera = params->camera,
        .previous_camera = params->previous_camera ? *params->previous_camera : params->camera,
        .sun = params->sun ? *params->sun : wd_forest_sun(renderer->forest),
        .time_s = params->time_s,
        .previous_time_s = params->previous_time_s,
        .width = params->width,
        .height = params->height,
        .samples = samples < max_samples ? samples : max_samples,
        .view_mode = (uint32_t)params->view,
        .max_error_px = (float)params->max_error_px,
        .gbuffer = gbuffer_use(params->layers),
        .light = light,
        .gathering = params->accumulation == WD_ACCUMULATE ? WD_GATHER_ON : WD_GATHER_OFF,
        .velocity = params->layers & WD_LAYER_VELOCITY ? WD_VELOCITY_ON : WD_VELOCITY_OFF,
    };
    renderer->frame.ring.timing = params->timing == WD_TIME_PASSES ? WD_TIMING_ON : WD_TIMING_OFF;
    renderer->stopped = false; /* a method may bake first */
    if (wd_frame_prepare(&renderer->frame, &frame))
        return WD_OK;
    return renderer->stopped ? WD_ERROR_INTERRUPTED : wd_renderer_failure(renderer);
}

/* The pass to count a scope in: one of the same name within the same scope, or a new one. */
static struct wd_pass_time *pass_of(struct wd_renderer *renderer,
                                    const struct wd_scope_time *scope)
{
    for (uint32_t i = renderer->pass_count; i-- > 0 && renderer->passes[i].depth >= scope->depth;) {
        struct wd_pass_time *pass = &renderer->passes[i];
        if (pass->depth == scope->depth && !strcmp(pass->name, scope->name))
            return pass;
    }
    if (renderer->pass_count == WD_MAX_PASSES)
        return NULL;
    char *name = renderer->pass_names[renderer->pass_count];
    struct wd_pass_time *pass = &renderer->passes[renderer->pass_count++];
    memcpy(name, scope->name, sizeof scope->name);
    *pass = (struct wd_pass_time){.name = name, .depth = scope->depth};
    return pass;
}

/* Takes the finished sample's times as those per sample. */
void wd_renderer_keep_times(struct wd_renderer *renderer)
{
    const struct wd_frames *ring = &renderer->frame.ring;
    renderer->pass_count = 0;
    for (uint32_t i = 0; i < ring->last_scope_count; i++) {
        const struct wd_scope_time *scope = &ring->last_scopes[i];
        struct wd_pass_time *pass = pass_of(renderer, scope);
        if (!pass)
            continue;
        pass->gpu_ms += scope->gpu_us * 1e-3;
        pass->cpu_ms += scope->cpu_us * 1e-3;
        pass->processor_ms += scope->processor_us * 1e-3;
    }
}

static enum wd_result render_samples(struct wd_renderer *renderer)
{
    struct wd_frame *frame = &renderer->frame;
    uint32_t samples = frame->params.samples;
    bool only_last = frame->params.light == WD_FRAME_UNLIT && frame->params.gbuffer != WD_GBUFFER_READ_EACH;
    uint32_t first = only_last ? samples - 1 : 0; /* layers are those of the last */
    double start = wd_clock_s() - renderer->gpu.making_s;
    for (uint32_t i = first; i < samples; i++) {
        struct wd_cmd cmd;
        if (samples - first > 1 && !wd_progress_report(&renderer->progress, "samples", i, samples))
            return WD_ERROR_INTERRUPTED;
        if (!wd_frame_begin(&frame->ring, &cmd))
            return wd_renderer_failure(renderer);
        wd_frame_record(frame, &cmd, i);
        if (!wd_frame_submit(&cmd, VK_NULL_HANDLE, VK_NULL_HANDLE)) {
            wd_frame_abandoned(frame);
            return wd_renderer_failure(renderer);
        }
        if (i == first && !wd_frames_wait(&frame->ring))
            return wd_renderer_failure(renderer);
        if (i == first)
            wd_renderer_keep_times(renderer);
        if (renderer->coverage.first && !wd_picture_count_trees(renderer))
            return wd_renderer_failure(renderer);
    }
    if (!wd_frames_wait(&frame->ring))
        return wd_renderer_failure(renderer);
    renderer->samples = samples - first;
    renderer->frame_ms = (wd_clock_s() - renderer->gpu.making_s - start) * 1e3 / renderer->samples;
    if (frame->params.method->check)
        frame->params.method->check(frame->method_state, &renderer->gpu);
    renderer->discs = 0;
    if (frame->ring.timing == WD_TIMING_ON && frame->params.method->discs)
        renderer->discs = frame->params.method->discs(frame->method_state, &renderer->gpu);
    return WD_OK;
}

enum wd_result wd_renderer_render(struct wd_renderer *renderer,
                                  const struct wd_render_params *params, struct wd_picture *picture)
{
    *picture = (struct wd_picture){0};
    if (!wd_given(params, &renderer->log) || !wd_check_layers(params->layers, &renderer->log))
        return WD_ERROR_INPUT;
    uint32_t layers = layers_of(params);
    bool lit = layers & (WD_LAYER_DISPLAY | WD_LAYER_COLOR) || params->accumulation == WD_ACCUMULATE;
    enum wd_result result = wd_renderer_prepare(renderer, params, UINT32_MAX,
                                                lit ? WD_FRAME_LIT : WD_FRAME_UNLIT, picture);
    if (result == WD_OK)
        result = render_samples(renderer);
    if (result == WD_OK && !wd_picture_read(picture, renderer, layers))
        result = wd_renderer_failure(renderer);
    wd_coverage_finish(&renderer->coverage);
    if (result == WD_OK)
        wd_picture_settle(picture, renderer->forest, &params->camera, &renderer->frame.params.sun, params->time_s);
    else
        wd_picture_finish(picture);
    return result;
}

/* --- facts ------------------------------------------------------------------------------- */

void wd_renderer_get_stats(const struct wd_renderer *renderer, struct wd_frame_stats *stats)
{
    const struct wd_frame *frame = &renderer->frame;
    *stats = (struct wd_frame_stats){
        .frame_ms = renderer->frame_ms,
        .samples = renderer->samples,
        .gpu_ms = renderer->gpu_ms,
        .discs = renderer->discs,
        .pass_count = renderer->pass_count,
        .passes = renderer->passes,
        .draw_calls = frame->stats.draw_calls,
        .triangles = frame->stats.triangles,
        .trees_mesh = frame->camera_stats.trees[WD_LEVEL_MESH],
        .trees_reduced = frame->camera_stats.trees[WD_LEVEL_REDUCED],
        .trees_billboard = frame->camera_stats.trees[WD_LEVEL_CARD],
        .device_bytes = renderer->gpu.bytes_allocated,
        .device_bytes_peak = renderer->gpu.bytes_peak,
    };
}

const char *wd_renderer_device_name(const struct wd_renderer *renderer)
{
    return renderer->gpu.properties.deviceName;
}

uint64_t wd_renderer_key(const struct wd_renderer *renderer)
{
    const VkPhysicalDeviceProperties *device = &renderer->gpu.properties;
    uint64_t key = renderer->forest ? wd_forest_key(renderer->forest) : wd_code_key();
    key = XXH64(device->deviceName, strlen(device->deviceName), key);
    key = XXH64(device->pipelineCacheUUID, sizeof device->pipelineCacheUUID, key);
    return XXH64(&device->driverVersion, sizeof device->driverVersion, key);
}

char *wd_device_list(void)
{
    return wd_gpu_list(NULL);
}
