#include "bench.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>

enum { MAX_FRAMES = 64 };

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

double bench_percentile(double *values, size_t count, double share)
{
    if (!count)
        return NAN;
    qsort(values, count, sizeof *values, compare);
    double at = share * (double)(count - 1);
    size_t low = (size_t)at, high = low + 1 < count ? low + 1 : low;
    return values[low] + (at - (double)low) * (values[high] - values[low]);
}

/* --- time --------------------------------------------------------------------------------- */

static void describe_passes(const struct wd_frame_stats *stats, struct bench_row *row)
{
    double gpu_ms = 0, cpu_ms = 0;
    size_t used = 0;
    for (uint32_t i = 0; i < stats->pass_count; i++) {
        const struct wd_pass_time *pass = &stats->passes[i];
        if (pass->depth > 0)
            continue;
        gpu_ms += pass->gpu_ms;
        cpu_ms += pass->cpu_ms;
        if (used < sizeof row->passes)
            used +=
                (size_t)snprintf(row->passes + used, sizeof row->passes - used, "%s%s=%.3f+%.3f",
                                 used ? ";" : "", pass->name, pass->gpu_ms, pass->cpu_ms);
    }
    row->values[BENCH_GPU_MS] = gpu_ms;
    row->values[BENCH_CPU_MS] = cpu_ms;
}

static void describe_frame(struct bench_stage *stage, struct bench_row *row)
{
    struct wd_frame_stats stats;
    struct rusage usage;
    wd_renderer_get_stats(stage->renderer, &stats);
    getrusage(RUSAGE_SELF, &usage);
    describe_passes(&stats, row);
    row->values[BENCH_DRAWS] = (double)stats.draw_calls;
    row->values[BENCH_TRIANGLES] = (double)stats.triangles;
    row->values[BENCH_DEVICE_MB] = (double)stats.device_bytes * 1e-6;
    row->values[BENCH_HOST_MB] = (double)usage.ru_maxrss * 1.024e-3;
}

static enum wd_result draw(struct bench_stage *stage, const struct wd_render_params *params,
                           double *frame_ms)
{
    struct wd_frame_stats stats;
    struct wd_picture picture;
    enum wd_result result = wd_renderer_render(stage->renderer, params, &picture);
    wd_picture_finish(&picture);
    wd_renderer_get_stats(stage->renderer, &stats);
    *frame_ms = stats.frame_ms;
    return cli_session_interrupted(stage->bench->session) ? WD_ERROR_INTERRUPTED : result;
}

/* Frames without timers first; one with them tells the passes apart. */
enum wd_result bench_measure_time(struct bench_stage *stage, const struct wd_camera *camera,
                                  struct bench_row *row)
{
    const struct bench_effort *effort = &stage->bench->effort;
    uint32_t size_px[2];
    bench_frame_size(stage->bench, row->camera, size_px);
    struct wd_render_params params = {
        .camera = *camera,
        .width = size_px[0],
        .height = size_px[1],
        .samples = 1,
        .method = row->method,
    };
    const double of_suite_s = stage->bench->suite->budget_s;
    const double budget_s = of_suite_s > 0 ? fmin(of_suite_s, effort->budget_s) : effort->budget_s;
    const uint32_t least = of_suite_s > 0 ? 1 : effort->least_frames;
    double frames[MAX_FRAMES], ignored, begin_s;
    uint32_t count = 0;
    enum wd_result result = draw(stage, &params, &ignored); /* warms up */
    begin_s = cli_seconds();
    while (result == WD_OK && count < effort->frames && count < MAX_FRAMES &&
           (count < least || cli_seconds() - begin_s < budget_s))
        result = draw(stage, &params, &frames[count++]);
    params.timing = WD_TIME_PASSES;
    if (result == WD_OK)
        result = draw(stage, &params, &ignored);
    if (result != WD_OK)
        return result;
    describe_frame(stage, row);
    row->values[BENCH_FRAME_MS] = bench_percentile(frames, count, 0.5);
    row->values[BENCH_FRAME_P95_MS] = bench_percentile(frames, count, 0.95);
    row->values[BENCH_FRAME_P99_MS] = bench_percentile(frames, count, 0.99);
    row->values[BENCH_FRAMES] = count;
    return WD_OK;
}

/* --- truth -------------------------------------------------------------------------------- */

static enum wd_result open_reference(struct bench_stage *stage)
{
    struct cli_session *session = stage->bench->session;
    const struct wd_reference_params params = {
        .threads = session->options->threads, .progress = session->progress, .log = session->log};
    return stage->reference ? WD_OK
                            : wd_reference_create(&stage->reference, stage->forest, &params);
}

/* The file's name tells what the picture depends on. */
static char *truth_path(const struct bench_stage *stage, const char *name,
                        const struct wd_reference_picture_params *params)
{
    const struct wd_camera *camera = &params->camera;
    char text[192];
    snprintf(text, sizeof text, "%.17g %.17g %.17g %.17g %.17g %.17g %u %.17g", camera->position_m[0],
             camera->position_m[1], camera->position_m[2], camera->yaw_rad, camera->pitch_rad,
             camera->fov_rad, params->bounces, params->time_s);
    return bench_path(stage->bench, "reference/%s-%s-%016llx-%ux%u-%u-%u.exr", stage->scene, name,
                      (unsigned long long)cli_key_text(stage->reference_key, text), params->width,
                      params->height, params->samples, params->stream);
}

enum wd_result bench_truth(struct bench_stage *stage, const char *name,
                           const struct wd_reference_picture_params *params,
                           struct wd_picture *picture)
{
    struct bench *bench = stage->bench;
    struct stat status;
    char *path = truth_path(stage, name, params);
    enum wd_result result = WD_OK;
    if (stat(path, &status) == 0) {
        result = wd_picture_read_exr(picture, path, &bench->session->log);
        if (result == WD_OK &&
            (picture->width != params->width || picture->height != params->height)) {
            cli_fail(bench->session, "%s: holds %u x %u pixels, not %u x %u; remove it", path,
                     picture->width, picture->height, params->width, params->height);
            result = WD_ERROR_INPUT;
        }
    } else {
        struct wd_reference_picture_params trace = *params;
        char *checkpoint = NULL;
        if (asprintf(&checkpoint, "%s.partial", path) < 0)
            abort();
        trace.checkpoint = checkpoint;
        result = open_reference(stage);
        if (result == WD_OK)
            result = wd_reference_render(stage->reference, &trace, picture);
        if (result == WD_OK)
            result = wd_picture_write(picture, path, &bench->session->log);
        free(checkpoint);
    }
    free(path);
    return result;
}

/* --- image error ------------------------------------------------------------------------ */

static enum wd_result compare_pictures(struct bench_stage *stage, struct wd_picture *truth,
                                       struct wd_picture *picture, struct bench_row *row)
{
    const struct wd_log *log = &stage->bench->session->log;
    struct wd_comparison comparison;
    char what[48];
    float *error = calloc((size_t)truth->width * truth->height, sizeof *error);
    if (!error)
        return WD_ERROR_MEMORY;
    enum wd_result result = wd_picture_compare(&comparison, truth, picture, error, log);
    for (uint32_t i = 0; result == WD_OK && wd_comparison_names()[i]; i++)
        row->values[BENCH_COMPARISON + i] = wd_comparison_value(&comparison, i);
    if (result == WD_OK)
        result = wd_picture_expose_alike(truth, picture, log);
    if (result == WD_OK)
        result = bench_keep_picture(stage, truth, row, "reference");
    if (result == WD_OK)
        result = bench_keep_picture(stage, picture, row, row->method);
    if (result == WD_OK) {
        bench_map_error(picture, error);
        snprintf(what, sizeof what, "%s-error", row->method);
        result = bench_keep_picture(stage, picture, row, what);
    }
    free(error);
    return result;
}

/* The mean of two pictures of half the samples each. What either is away from that mean has the
 * spread of what the mean is away from the truth. */
static enum wd_result trace_halves(struct bench_stage *stage,
                                   const struct wd_reference_picture_params *params,
                                   struct wd_picture *truth, struct bench_row *row)
{
    struct wd_reference_picture_params half = *params;
    struct wd_picture other = {0};
    struct wd_comparison noise;
    half.samples = (params->samples + 1) / 2;
    enum wd_result result = bench_truth(stage, row->camera, &half, truth);
    half.stream = 1;
    if (result == WD_OK)
        result = bench_truth(stage, row->camera, &half, &other);
    for (size_t i = 0; result == WD_OK && i < (size_t)3 * params->width * params->height; i++)
        truth->color[i] = 0.5f * (truth->color[i] + other.color[i]);
    if (result == WD_OK)
        result = wd_picture_compare(&noise, truth, &other, NULL, &stage->bench->session->log);
    if (result == WD_OK) {
        row->values[BENCH_NOISE_FLIP] = noise.flip;
        row->values[BENCH_NOISE_BLOCKS] = noise.block_rmse_pct;
    }
    wd_picture_finish(&other);
    return result;
}

enum wd_result bench_measure_error(struct bench_stage *stage, const struct wd_camera *camera,
                                   struct bench_row *row)
{
    const struct bench_effort *effort = &stage->bench->effort;
    const struct wd_reference_picture_params trace = {
        .camera = *camera,
        .width = effort->truth_width,
        .height = effort->truth_height,
        .samples = effort->truth_samples,
        .layers = WD_LAYER_COLOR | WD_LAYER_TREE_ID,
    };
    const struct wd_render_params params = {
        .camera = *camera,
        .width = effort->truth_width,
        .height = effort->truth_height,
        .samples = effort->samples,
        .method = row->method,
        .layers = WD_LAYER_COLOR | WD_LAYER_TREE_ID,
    };
    struct wd_picture truth = {0}, picture = {0};
    enum wd_result result = trace_halves(stage, &trace, &truth, row);
    if (result == WD_OK)
        result = wd_renderer_render(stage->renderer, &params, &picture);
    if (result == WD_OK)
        result = compare_pictures(stage, &truth, &picture, row);
    wd_picture_finish(&truth);
    wd_picture_finish(&picture);
    return result;
}
