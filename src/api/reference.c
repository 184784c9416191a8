#include "weald/reference.h"

#include <math.h>
#include <stdlib.h>
#include <unistd.h>
#include <xxhash.h>

#include "api/arguments.h"
#include "api/forest.h"
#include "api/shown.h"
#include "base/clock.h"
#include "base/file.h"
#include "base/log.h"
#include "base/memory.h"
#include "forest/looks.h"
#include "reference/checkpoint.h"
#include "reference/display.h"
#include "shared/air.h"
#include "shared/wind.h"
#include "world/on_demand.h"
#include "world/surroundings.h"

enum { MAX_SAMPLES = 1 << 20, DEFAULT_SAMPLES = 64, DEFAULT_BOUNCES = 8 };
static const double CHECKPOINT_S = 30.0;

struct wd_reference {
    const struct wd_forest *forest;
    RTCDevice device;
    struct wd_trace_models models;
    unsigned threads;
    struct wd_progress progress;
    struct wd_log log;
    struct wd_shared_log shared_log; /* to it, for threads */
    struct wd_reference_stats stats;
};

/* --- making ------------------------------------------------------------------------------ */

static void embree_error(void *user, enum RTCError code, const char *text)
{
    const struct wd_reference *reference = user;
    wd_error(&reference->shared_log.log, "Embree: %s (error %d)", text, (int)code);
}

/* Pictures differ between instruction sets by rounding; AVX2 is what most machines have. */
static RTCDevice open_device(struct wd_reference *reference)
{
    char config[64];
    const char *isa = __builtin_cpu_supports("avx2") ? "isa=avx2," : "";
    snprintf(config, sizeof config, "%sthreads=%u", isa, reference->threads);
    RTCDevice device = rtcNewDevice(config);
    if (device)
        rtcSetDeviceErrorFunction(device, embree_error, reference);
    return device;
}

_Static_assert(WD_TRACE_MAP_BYTES == WD_LOOK_MAP_BYTES, "textures as those of pictures");

static void get_look(void *user, const struct wd_species *species, uint8_t *albedo_detail)
{
    wd_look_get(albedo_detail, user, species);
}

static bool make_models(struct wd_reference *reference, const char *cache_dir)
{
    char *directory = cache_dir ? wd_strdup(cache_dir) : wd_cache_directory();
    struct wd_bake_cache cache = {.directory = directory, .log = &reference->shared_log.log};
    const struct wd_trace_looks looks = {get_look, &cache};
    bool ok = wd_trace_models_init(&reference->models, reference->device, &reference->forest->scene, &looks,
                                   reference->threads, &reference->shared_log.log);
    free(directory);
    return ok;
}

enum wd_result wd_reference_create(struct wd_reference **result, const struct wd_forest *forest,
                                   const struct wd_reference_params *params)
{
    *result = NULL;
    if (!wd_given(params, NULL) || !wd_given(forest, &params->log))
        return WD_ERROR_INPUT;
    struct wd_reference *reference = wd_alloc(sizeof *reference);
    *reference = (struct wd_reference){.forest = forest,
                                       .threads = params->threads,
                                       .progress = params->progress,
                                       .log = params->log};
    wd_shared_log_init(&reference->shared_log, &reference->log);
    reference->device = open_device(reference);
    if (!reference->device) {
        wd_error(&reference->log, "Embree cannot be started (error %d)",
                 (int)rtcGetDeviceError(NULL));
        wd_reference_destroy(&reference);
        return WD_ERROR_MEMORY;
    }
    if (!make_models(reference, params->cache_dir)) {
        wd_reference_destroy(&reference);
        return WD_ERROR_INPUT;
    }
    *result = reference;
    return WD_OK;
}

void wd_reference_destroy(struct wd_reference **reference)
{
    if (!reference || !*reference)
        return;
    wd_trace_models_finish(&(*reference)->models);
    if ((*reference)->device)
        rtcReleaseDevice((*reference)->device);
    wd_shared_log_finish(&(*reference)->shared_log);
    free(*reference);
    *reference = NULL;
}

/* --- one picture --------------------------------------------------------------------------- */

struct work {
    struct wd_reference *reference;
    const struct wd_reference_picture_params *params;
    uint32_t samples, layers;
    struct wd_frame_uniforms frame;
    struct wd_sun sun;
    struct wd_trace_scene scene;
    struct wd_tracer tracer;
    struct wd_trace_job job;
    struct wd_trace_sums sums;
    struct wd_progress progress; /* its user is this */
    double written_s;            /* when the checkpoint was last written */
    bool pause;                  /* tracing stops only to write the checkpoint */
    uint64_t key;
};

/* Layers that no path tells of. */
static const uint32_t MISSING_LAYERS = WD_LAYER_VELOCITY | WD_LAYER_CRYPTOMATTE;

static bool check_layers(uint32_t layers, const struct wd_log *log)
{
    uint32_t missing = layers == WD_LAYER_ALL ? 0 : layers & MISSING_LAYERS;
    if (missing)
        return wd_error(log,
                        "layers asks for %s, which the path tracer lacks: all others are possible",
                        missing == WD_LAYER_VELOCITY      ? "velocity"
                        : missing == WD_LAYER_CRYPTOMATTE ? "cryptomatte"
                                                          : "velocity and cryptomatte");
    return wd_check_layers(layers, log);
}

static bool check(const struct wd_reference *reference,
                  const struct wd_reference_picture_params *params)
{
    const struct wd_log *log = &reference->log;
    return wd_check_size(params->width, params->height, log) &&
           wd_check_samples(params->samples, MAX_SAMPLES, log) &&
           wd_check_camera(&params->camera, "camera", log) &&
           wd_check_sun(params->sun, &reference->forest->world, log) &&
           wd_check_time(params->time_s, "time_s", log) &&
           wd_check_choice(params->places, WD_REFERENCE_MIDDLES + 1, "places", log) &&
           check_layers(params->layers, log);
}

/* All that the picture depends on but the number of samples. */
static uint64_t picture_key(const struct work *work)
{
    const struct wd_camera *camera = &work->params->camera;
    const struct wd_trace_models *models = &work->reference->models;
    const double numbers[] = {camera->position_m[0], camera->position_m[1], camera->position_m[2],
                              camera->yaw_rad, camera->pitch_rad, camera->fov_rad,
                              work->tracer.bounces, work->params->stream, work->params->places,
                              (double)work->job.view.lens_m,
                              (double)work->job.view.focus_m};
    uint64_t key = wd_reference_key(work->reference->forest);
    key = XXH64(&work->frame, sizeof work->frame, key);
    key = XXH64(numbers, sizeof numbers, key);
    for (uint32_t i = 0; i < models->count; i++) {
        const struct wd_tree_mesh *mesh = &models->models[i].grown.full;
        key = XXH64(mesh->vertices, mesh->vertex_count * sizeof *mesh->vertices, key);
        key = XXH64(mesh->indices, mesh->index_count * sizeof *mesh->indices, key);
    }
    return key;
}

static bool report(void *user, const char *stage, uint64_t done, uint64_t total)
{
    struct work *work = user;
    if (!wd_progress_report(&work->reference->progress, stage, done, total))
        return false;
    work->pause = work->params->checkpoint && wd_clock_s() - work->written_s > CHECKPOINT_S;
    return !work->pause;
}

static bool prepare(struct work *work)
{
    struct wd_reference *reference = work->reference;
    const struct wd_reference_picture_params *params = work->params;
    const struct wd_forest *forest = reference->forest;
    double begin_s = wd_clock_s();
    work->frame.time_s = (float)(params->time_s - wd_wind_begin_s(params->time_s));
    work->frame.wind_period = wd_wind_period_of(params->time_s);
    work->frame.width = params->width;
    work->frame.height = params->height;
    wd_surroundings_set_camera(&work->frame, params->camera.position_m);
    work->sun = params->sun ? *params->sun : wd_forest_sun(forest);
    wd_surroundings_fill(&work->frame, &forest->scene, &forest->world, &work->sun);
    work->job.view = wd_trace_view_of(&params->camera, params->width, params->height);
    work->job.view.lens_m = (float)wd_scene_lens_radius_m(&forest->scene, params->camera.fov_rad);
    work->job.view.focus_m = (float)forest->scene.lens.focus_m;
    work->tracer = (struct wd_tracer){
        .scene = &work->scene,
        .sky = wd_sky_toward,
        .sky_map = forest->world.sky.width ? &forest->world.sky : NULL,
        .bounces = params->bounces ? params->bounces : DEFAULT_BOUNCES,
        .pixel_rad = wd_trace_pixel_rad(&work->job.view),
        .is_sea = wd_water_is_sea(&forest->world.terrain, work->frame.water_level_m),
    };
    work->progress = (struct wd_progress){report, work};
    work->job.tracer = &work->tracer;
    work->job.threads = reference->threads;
    work->job.stream = params->stream;
    work->job.middles = params->places == WD_REFERENCE_MIDDLES;
    work->job.progress = &work->progress;
    if (!wd_trace_sums_init(&work->sums, params->width, params->height))
        return wd_error(&reference->log,
                        "out of memory: there is no room for the paths of %u x %u pixels",
                        params->width, params->height);
    bool ok = wd_trace_scene_init(&work->scene, &reference->models, &forest->scene, &forest->world,
                                  &work->frame, &work->job.view, &reference->log);
    reference->stats.build_s = wd_clock_s() - begin_s;
    return ok;
}

/* A picture of fewer samples than some tile has already would not be that of a run without a break. */
static bool take_samples(struct work *work, const char *path)
{
    const struct wd_trace_sums *sums = &work->sums;
    uint32_t most = 0;
    for (size_t i = 0; i < (size_t)sums->tile_columns * sums->tile_rows; i++) {
        most = sums->tile_samples[i] > most ? sums->tile_samples[i] : most;
        work->reference->stats.resumed_samples += sums->tile_samples[i];
    }
    return most <= work->samples ||
           wd_error(&work->reference->log, "%s: holds %u samples a pixel already, %u are asked for; ask for "
                    "%u or more, name another picture, or remove it to begin anew", path, most, work->samples,
                    most);
}

static bool resume(struct work *work)
{
    const char *path = work->params->checkpoint;
    if (!path)
        return true;
    work->key = picture_key(work);
    if (!wd_file_exists(path))
        return true;
    return wd_checkpoint_read(path, work->key, &work->sums, &work->reference->log) &&
           take_samples(work, path);
}

/* Told before the hours of work that it is to keep. */
static bool can_write(const char *path, const struct wd_log *log)
{
    struct wd_output_file file;
    bool ok = wd_output_open(&file, path, log);
    if (ok)
        wd_output_discard(&file);
    return ok;
}

static enum wd_result trace(struct work *work)
{
    const char *path = work->params->checkpoint;
    double begin_s = wd_clock_s();
    if (path && !can_write(path, &work->reference->log))
        return WD_ERROR_OUTPUT;
    do {
        work->written_s = wd_clock_s();
        work->job.stopped = work->pause = false;
        wd_trace_run(&work->job, &work->sums, work->samples);
        if (work->job.stopped && path &&
            !wd_checkpoint_write(path, work->key, &work->sums, &work->reference->log))
            return WD_ERROR_OUTPUT;
    } while (work->job.stopped && work->pause);
    work->reference->stats.trace_s = wd_clock_s() - begin_s;
    return work->job.stopped ? WD_ERROR_INTERRUPTED : WD_OK;
}

/* Whether any path has to be traced. */
static bool is_lit(const struct work *work)
{
    return work->layers & (WD_LAYER_COLOR | WD_LAYER_DISPLAY);
}

static enum wd_result trace_paths(struct work *work)
{
    if (!is_lit(work))
        return WD_OK;
    return resume(work) ? trace(work) : WD_ERROR_INPUT;
}

static void mean_radiance(const struct wd_trace_sums *sums, float *color)
{
    for (uint32_t y = 0; y < sums->height; y++) {
        for (uint32_t x = 0; x < sums->width; x++) {
            size_t pixel = (size_t)y * sums->width + x;
            size_t tile = (size_t)(y / WD_TRACE_TILE) * sums->tile_columns + x / WD_TRACE_TILE;
            for (size_t k = 0; k < 3; k++)
                color[3 * pixel + k] =
                    sums->radiance[3 * pixel + k] / (float)sums->tile_samples[tile];
        }
    }
}

/* What is shown follows from colour, wanted or not. */
static bool make_room(const struct work *work, struct wd_picture *picture)
{
    uint32_t shown = is_lit(work) ? WD_LAYER_COLOR : 0;
    return wd_picture_make_room(picture, work->params->width, work->params->height,
                                work->layers | shown, &work->reference->log);
}

static void fill_picture(struct work *work, struct wd_picture *picture)
{
    const struct wd_forest *forest = work->reference->forest;
    if (is_lit(work))
        mean_radiance(&work->sums, picture->color);
    wd_trace_layers(&work->job, picture);
    if (work->layers & WD_LAYER_DISPLAY)
        wd_display_map(picture->color, picture->width, picture->height,
                       (float)forest->scene.quality.exposure_ev, picture->display);
    if (!(work->layers & WD_LAYER_COLOR)) {
        free(picture->color);
        picture->color = NULL;
    }
    wd_picture_settle(picture, forest, &work->params->camera, &work->sun, work->params->time_s);
}

enum wd_result wd_reference_render(struct wd_reference *reference,
                                   const struct wd_reference_picture_params *params,
                                   struct wd_picture *picture)
{
    *picture = (struct wd_picture){0};
    if (!wd_given(params, &reference->log) || !check(reference, params) ||
        !wd_demand_is_none(&reference->forest->world.demand, "the path tracer", &reference->log))
        return WD_ERROR_INPUT;
    reference->stats = (struct wd_reference_stats){0};
    struct work work = {
        .reference = reference,
        .params = params,
        .samples = params->samples ? params->samples : DEFAULT_SAMPLES,
        .layers = params->layers ? params->layers & ~MISSING_LAYERS : WD_LAYER_DISPLAY,
    };
    bool ready = make_room(&work, picture) && prepare(&work);
    enum wd_result result = ready ? trace_paths(&work) : WD_ERROR_MEMORY;
    if (result != WD_OK) {
        wd_picture_finish(picture);
    } else {
        fill_picture(&work, picture);
        if (is_lit(&work) && params->checkpoint && wd_file_exists(params->checkpoint))
            unlink(params->checkpoint);
    }
    reference->stats.rays = work.job.counts.rays;
    reference->stats.self_hits = work.job.counts.self_hits;
    wd_trace_scene_finish(&work.scene);
    wd_trace_sums_finish(&work.sums);
    return result;
}

void wd_reference_get_stats(const struct wd_reference *reference, struct wd_reference_stats *stats)
{
    *stats = reference->stats;
}
