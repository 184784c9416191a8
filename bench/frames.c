/* What the table of frame times asks for (docs/performance.md), view by view: whole frames one by one, and by a
 * GPU's own clock, each as a median and the 99th of a hundred, with the time of each pass; and how many a second
 * are drawn live, two in flight. */
#include "figures.h"
#include "live_target.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_FRAMES = 400, LEAST_FRAMES = 5, MOST_PASSES = 40 };
static const double VIEW_S = 4.0; /* frames of a view are drawn for so long, */
static const double WARM_S = 3.0; /* after so long a time, in which devices raise their clocks */

static const struct view {
    const char *scene, *setting, *camera; /* a camera, or a path of that name */
    uint32_t width, height;
    bool is_path;
} VIEWS[] = {
    {"scenes/bench75k.json", "wind.speed_mps=5", "overview", 800, 600, false},
    {"scenes/bench75k.json", "wind.speed_mps=5", "walk", 800, 600, false},
    {"scenes/scale.json", "terrain.size_m=[485,485]", "overview", 800, 600, false},
    {"scenes/scale.json", "terrain.size_m=[4850,4850]", "overview", 800, 600, false},
    {"scenes/scale.json", "terrain.size_m=[153000,153000]", "overview", 800, 600, false},
    {"scenes/road.json", "wind.speed_mps=2", "road", 1920, 1080, false},
    {"scenes/road.json", "wind.speed_mps=2", "9 km", 1920, 1080, false},
    {"scenes/scale.json", "terrain.size_m=[15300,15300]", "slow", 800, 600, true},
};
enum { VIEW_COUNT = sizeof VIEWS / sizeof *VIEWS };

struct passes {
    char names[MOST_PASSES][40];
    double gpu_ms[MOST_PASSES][MOST_FRAMES], cpu_ms[MOST_PASSES][MOST_FRAMES];
    uint32_t count;
};

struct times {
    double frame_ms[MOST_FRAMES], gpu_ms[MOST_FRAMES];
    uint32_t frames;
    double live_ms; /* a frame */
    struct passes passes;
};

struct stage {
    const char *gpu;
    struct wd_forest *forest;
    struct wd_renderer *renderer;
};

static bool open_stage(struct stage *stage, const struct view *view)
{
    const char *settings[] = {view->setting, NULL};
    const struct wd_forest_params forest = {.scene_path = view->scene, .settings = settings};
    const struct wd_renderer_params renderer = {.gpu = stage->gpu};
    return wd_forest_create(&stage->forest, &forest) == WD_OK &&
           wd_renderer_create(&stage->renderer, &renderer) == WD_OK &&
           wd_renderer_set_forest(stage->renderer, stage->forest) == WD_OK;
}

static void close_stage(struct stage *stage)
{
    wd_renderer_destroy(&stage->renderer);
    wd_forest_destroy(&stage->forest);
}

static enum wd_result params_of(const struct stage *stage, const struct view *view, uint32_t frame,
                                struct wd_render_params *params)
{
    *params = (struct wd_render_params){.samples = 1, .method = "continuum",
                                        .width = view->width, .height = view->height,
                                        .time_s = frame / 60.0};
    return view->is_path ? wd_forest_get_path_camera(stage->forest, view->camera,
                                                     fmod(frame / 60.0, 8.0), &params->camera, NULL)
                         : wd_forest_get_camera(stage->forest, view->camera, &params->camera);
}

static bool draw(struct stage *stage, const struct view *view, uint32_t frame,
                 enum wd_time_mode timing, struct wd_frame_stats *stats)
{
    struct wd_render_params params;
    struct wd_picture picture = {0};
    enum wd_result result = params_of(stage, view, frame, &params);
    params.timing = timing;
    if (result == WD_OK)
        result = wd_renderer_render(stage->renderer, &params, &picture);
    wd_picture_finish(&picture);
    wd_renderer_get_stats(stage->renderer, stats);
    return result == WD_OK;
}

/* The device's own time, 0 where it has no true clock. */
static double keep_passes(struct passes *passes, const struct wd_frame_stats *stats, uint32_t frame)
{
    double sum_ms = 0.0;
    passes->count = stats->pass_count < MOST_PASSES ? stats->pass_count : MOST_PASSES;
    for (uint32_t i = 0; i < passes->count; i++) {
        const struct wd_pass_time *pass = &stats->passes[i];
        snprintf(passes->names[i], sizeof passes->names[i], "%*s%s", 2 * (int)pass->depth, "",
                 pass->name);
        passes->gpu_ms[i][frame] = pass->gpu_ms;
        passes->cpu_ms[i][frame] = pass->cpu_ms;
        sum_ms += pass->depth ? 0.0 : pass->gpu_ms;
    }
    return sum_ms;
}

/* One frame with timers after each without. */
static bool measure(struct stage *stage, const struct view *view, struct times *times)
{
    struct wd_frame_stats stats;
    bool ok = true;
    double begin_s = bench_now_s();
    for (uint32_t frame = 0; ok && (frame < 3 || bench_now_s() - begin_s < WARM_S); frame++)
        ok = draw(stage, view, frame % 3, WD_TIME_OFF, &stats);
    begin_s = bench_now_s();
    while (ok && times->frames < MOST_FRAMES &&
           (times->frames < LEAST_FRAMES || bench_now_s() - begin_s < VIEW_S)) {
        uint32_t frame = times->frames++;
        ok = draw(stage, view, 3 + 2 * frame, WD_TIME_OFF, &stats);
        times->frame_ms[frame] = stats.frame_ms;
        ok = ok && draw(stage, view, 4 + 2 * frame, WD_TIME_PASSES, &stats);
        times->gpu_ms[frame] = keep_passes(&times->passes, &stats, frame);
    }
    return ok;
}

static bool measure_live(struct stage *stage, const struct view *view, struct times *times)
{
    struct live_target live;
    struct wd_render_params params;
    bool ok = live_target_init(&live, stage->renderer, view->width, view->height);
    double begin_s = bench_now_s();
    uint32_t frame = 0;
    while (ok && frame < MOST_FRAMES && (frame < LEAST_FRAMES || bench_now_s() - begin_s < VIEW_S)) {
        ok = params_of(stage, view, frame, &params) == WD_OK &&
             wd_renderer_draw(stage->renderer, &params, &live.target) == WD_OK;
        frame++;
    }
    ok = wd_renderer_wait(stage->renderer) == WD_OK && ok;
    times->live_ms = frame ? (bench_now_s() - begin_s) * 1e3 / frame : 0.0;
    live_target_finish(&live);
    return ok;
}

static double percentile_99(const double *sorted, uint32_t count)
{
    return sorted[(uint32_t)ceil(0.99 * count) - 1];
}

static void report(const struct view *view, struct times *times, double *gpu_ms)
{
    uint32_t count = times->frames;
    double frame_ms = bench_median(times->frame_ms, count);
    *gpu_ms = bench_median(times->gpu_ms, count);
    printf("%s %s, %s, %u x %u: %u frames, whole %.2f ms (99th %.2f), device %.2f ms (99th %.2f), live "
           "%.2f ms\n",
           view->scene, view->setting, view->camera, view->width, view->height, count, frame_ms,
           percentile_99(times->frame_ms, count), *gpu_ms, percentile_99(times->gpu_ms, count),
           times->live_ms);
    for (uint32_t i = 0; i < times->passes.count; i++)
        printf("    %-22s %8.3f ms, recorded in %.3f\n", times->passes.names[i],
               bench_median(times->passes.gpu_ms[i], count),
               bench_median(times->passes.cpu_ms[i], count));
    fflush(stdout);
}

/* The worst view of 75,000 trees. */
bool bench_frame_times(const char *gpu)
{
    double worst_ms = 0.0;
    for (int i = 0; i < VIEW_COUNT; i++) {
        struct stage stage = {.gpu = gpu};
        struct times *times = calloc(1, sizeof *times);
        double gpu_ms = 0.0;
        bool ok = times && open_stage(&stage, &VIEWS[i]) && measure(&stage, &VIEWS[i], times) &&
                  measure_live(&stage, &VIEWS[i], times);
        if (ok)
            report(&VIEWS[i], times, &gpu_ms);
        close_stage(&stage);
        free(times);
        if (!ok)
            return false;
        if (strcmp(VIEWS[i].scene, VIEWS[0].scene) == 0)
            worst_ms = fmax(worst_ms, gpu_ms);
    }
    printf("frame-times %.2f ms\n", worst_ms);
    return true;
}
