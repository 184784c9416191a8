#include "bench.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>

enum { BLOCK = 4, MAX_FRAMES = 64, LEAST_FRAMES = 3 };

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

/* --- time ---------------------------------------------------------------------------------------- */

static void describe_passes(const struct wd_frame_stats *stats, struct bench_row *row)
{
    double gpu_ms = 0, cpu_ms = 0;
    size_t used = 0;
    for (uint32_t i = 0; i < stats->pass_count; i++) {
        const struct wd_pass_time *pass = &stats->passes[i];
        gpu_ms += pass->gpu_ms;
        cpu_ms += pass->cpu_ms;
        if (used < sizeof row->passes)
            used += (size_t)snprintf(row->passes + used, sizeof row->passes - used,
                                     "%s%s=%.3f+%.3f", i ? ";" : "", pass->name, pass->gpu_ms,
                                     pass->cpu_ms);
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
    struct wd_render_params params = {
        .camera = *camera,
        .width = effort->width,
        .height = effort->height,
        .samples = 1,
        .method = row->method,
    };
    double frames[MAX_FRAMES], ignored, begin_s;
    uint32_t count = 0;
    enum wd_result result = draw(stage, &params, &ignored); /* warms up */
    begin_s = cli_seconds();
    while (result == WD_OK && count < effort->frames && count < MAX_FRAMES &&
           (count < LEAST_FRAMES || cli_seconds() - begin_s < effort->budget_s))
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
    return WD_OK;
}

/* --- truth --------------------------------------------------------------------------------------- */

static enum wd_result open_reference(struct bench_stage *stage)
{
    struct cli_session *session = stage->bench->session;
    const struct wd_reference_params params = {.threads = session->options->threads,
                                               .progress = session->progress,
                                               .log = session->log};
    return stage->reference ? WD_OK
                            : wd_reference_create(&stage->reference, stage->forest, &params);
}

/* The file's name tells what the picture depends on, but for changes of light in the scene file. */
enum wd_result bench_truth(struct bench_stage *stage, const char *name,
                           const struct wd_reference_picture_params *params,
                           struct wd_picture *picture)
{
    struct bench *bench = stage->bench;
    struct wd_forest_info info;
    struct stat status;
    wd_forest_get_info(stage->forest, &info);
    char *path = bench_path(bench, "reference/%s-%s-%016llx-%ux%u-%u.exr", stage->scene, name,
                            (unsigned long long)info.hash, params->width, params->height,
                            params->samples);
    enum wd_result result = WD_OK;
    if (stat(path, &status) == 0) {
        result = wd_picture_read_exr(picture, path, &bench->session->log);
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

/* --- image error ---------------------------------------------------------------------------------- */

/* From black over violet and orange to pale yellow. */
static void map_error(struct wd_picture *picture, const float *error)
{
    static const float ramp[5][3] = {
        {0, 0, 4}, {81, 18, 124}, {183, 55, 121}, {252, 137, 97}, {252, 253, 191}};
    size_t pixels = (size_t)picture->width * picture->height;
    for (size_t i = 0; i < pixels; i++) {
        float at = fminf(fmaxf(error[i], 0), 1) * 4;
        int low = at < 3 ? (int)at : 3;
        for (size_t k = 0; k < 3; k++)
            picture->display[4 * i + k] =
                (uint8_t)(ramp[low][k] + (at - (float)low) * (ramp[low + 1][k] - ramp[low][k]));
    }
}

static enum wd_result keep_picture(struct bench_stage *stage, const struct wd_picture *picture,
                                   const struct bench_row *row, const char *what)
{
    char *path = bench_path(stage->bench, "pictures/%s-%s-%s.png", row->scene, row->camera, what);
    enum wd_result result = wd_picture_write(picture, path, &stage->bench->session->log);
    free(path);
    return result;
}

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
        result = keep_picture(stage, truth, row, "reference");
    if (result == WD_OK)
        result = keep_picture(stage, picture, row, row->method);
    if (result == WD_OK) {
        map_error(picture, error);
        snprintf(what, sizeof what, "%s-error", row->method);
        result = keep_picture(stage, picture, row, what);
    }
    free(error);
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
    enum wd_result result = bench_truth(stage, row->camera, &trace, &truth);
    if (result == WD_OK)
        result = wd_renderer_render(stage->renderer, &params, &picture);
    if (result == WD_OK)
        result = compare_pictures(stage, &truth, &picture, row);
    wd_picture_finish(&truth);
    wd_picture_finish(&picture);
    return result;
}

/* --- popping -------------------------------------------------------------------------------------- */

/* A slow walk ahead: two hundredths of a degree of change a frame for things 25 m off. */
static struct wd_camera step_camera(const struct wd_camera *camera, uint32_t step)
{
    struct wd_camera moved = *camera;
    double way_m = 0.25 * step, level = cos(camera->pitch_rad);
    moved.position_m[0] += way_m * sin(camera->yaw_rad) * level;
    moved.position_m[1] += way_m * cos(camera->yaw_rad) * level;
    moved.position_m[2] += way_m * sin(camera->pitch_rad);
    return moved;
}

/* Mean luma of blocks, 0..100. */
static void block_luma(const struct wd_picture *picture, double *means)
{
    uint32_t columns = picture->width / BLOCK, rows = picture->height / BLOCK;
    for (uint32_t i = 0; i < columns * rows; i++)
        means[i] = 0;
    for (uint32_t y = 0; y < rows * BLOCK; y++)
        for (uint32_t x = 0; x < columns * BLOCK; x++) {
            const uint8_t *p = picture->display + 4 * ((size_t)y * picture->width + x);
            means[y / BLOCK * columns + x / BLOCK] +=
                (0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2]) * (100.0 / 255 / (BLOCK * BLOCK));
        }
}

struct popping {
    size_t blocks;
    double *truth[2], *drawn[2]; /* luma of the frame before and of this one */
    double *excess;
    size_t count;
};

static bool popping_init(struct popping *popping, const struct bench_effort *effort)
{
    *popping = (struct popping){
        .blocks = (size_t)(effort->step_width / BLOCK) * (effort->step_height / BLOCK)};
    for (int i = 0; i < 2; i++) {
        popping->truth[i] = calloc(popping->blocks, sizeof(double));
        popping->drawn[i] = calloc(popping->blocks, sizeof(double));
    }
    popping->excess = calloc(popping->blocks * effort->steps, sizeof(double));
    return popping->truth[0] && popping->truth[1] && popping->drawn[0] && popping->drawn[1] &&
           popping->excess;
}

static void popping_finish(struct popping *popping)
{
    for (int i = 0; i < 2; i++) {
        free(popping->truth[i]);
        free(popping->drawn[i]);
    }
    free(popping->excess);
}

static void add_step(struct popping *popping, uint32_t step)
{
    const double *truth = popping->truth[step % 2], *truth_before = popping->truth[1 - step % 2];
    const double *drawn = popping->drawn[step % 2], *drawn_before = popping->drawn[1 - step % 2];
    for (size_t i = 0; step > 0 && i < popping->blocks; i++)
        popping->excess[popping->count++] =
            fmax(fabs(drawn[i] - drawn_before[i]) - fabs(truth[i] - truth_before[i]), 0);
}

/* Both are shown at the exposure of the first true frame. */
static enum wd_result take_step(struct bench_stage *stage, const struct wd_camera *camera,
                                const struct bench_row *row, uint32_t step, struct popping *popping)
{
    const struct bench_effort *effort = &stage->bench->effort;
    const uint32_t layers = WD_LAYER_COLOR | WD_LAYER_TREE_ID;
    const struct wd_camera moved = step_camera(camera, step);
    const struct wd_reference_picture_params trace = {
        .camera = moved, .width = effort->step_width, .height = effort->step_height,
        .samples = effort->step_samples, .layers = layers};
    const struct wd_render_params params = {
        .camera = moved, .width = effort->step_width, .height = effort->step_height,
        .samples = effort->samples, .method = row->method, .layers = layers};
    struct wd_picture truth = {0}, picture = {0};
    char name[96];
    snprintf(name, sizeof name, "%s-step%u", row->camera, step);
    enum wd_result result = bench_truth(stage, name, &trace, &truth);
    if (result == WD_OK)
        result = wd_renderer_render(stage->renderer, &params, &picture);
    if (result == WD_OK)
        result = wd_picture_expose_alike(&truth, &picture, &stage->bench->session->log);
    if (result == WD_OK) {
        block_luma(&truth, popping->truth[step % 2]);
        block_luma(&picture, popping->drawn[step % 2]);
        add_step(popping, step);
    }
    wd_picture_finish(&truth);
    wd_picture_finish(&picture);
    return cli_session_interrupted(stage->bench->session) ? WD_ERROR_INTERRUPTED : result;
}

enum wd_result bench_measure_popping(struct bench_stage *stage, const struct wd_camera *camera,
                                     struct bench_row *row)
{
    const struct bench_effort *effort = &stage->bench->effort;
    struct popping popping;
    enum wd_result result = popping_init(&popping, effort) ? WD_OK : WD_ERROR_MEMORY;
    for (uint32_t step = 0; step < effort->steps && result == WD_OK; step++)
        result = take_step(stage, camera, row, step, &popping);
    if (result == WD_OK) {
        double sum = 0;
        for (size_t i = 0; i < popping.count; i++)
            sum += popping.excess[i];
        row->values[BENCH_POPPING_MEAN] = popping.count ? sum / (double)popping.count : NAN;
        row->values[BENCH_POPPING_P999] = bench_percentile(popping.excess, popping.count, 0.999);
        row->values[BENCH_POPPING_STEP] = bench_percentile(popping.excess, popping.count, 1);
    }
    popping_finish(&popping);
    return result;
}
