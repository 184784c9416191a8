/* 75,000 trees at 800 x 600, lit and shadowed, in wind: continuum against octree, frame by frame in
 * turn so that both meet the same machine, and against the same view without trees. */
#include "figures.h"

#include <math.h>
#include <stdio.h>
#include <time.h>

enum { FRAMES = 9, MAX_SUBJECTS = 2, PASS_FRAMES = 5, MAX_PASSES = 32 };
static const char *const SCENE = "scenes/bench75k.json";
static const char *const VIEWS[] = {"overview", "walk"};
enum { VIEW_COUNT = sizeof VIEWS / sizeof VIEWS[0] };

/* Medians of the passes of a view, of frames drawn for these alone. */
struct passes {
    double ms[MAX_PASSES][PASS_FRAMES];
    char names[MAX_PASSES][40];
    uint32_t count;
};

/* A renderer with its forest, to be drawn by one method. */
struct subject {
    const char *label, *method;
    const char *setting; /* besides the wind; NULL: none */
    struct wd_forest *forest;
    struct wd_renderer *renderer;
    double frame_ms[FRAMES], cpu_ms[FRAMES];
    double step_m; /* that the camera goes from frame to frame; 0: it stands still */
};

static bool open_subject(struct subject *subject, const char *gpu)
{
    const char *settings[] = {"wind.speed_mps=5", subject->setting, NULL};
    const struct wd_forest_params forest = {.scene_path = SCENE, .settings = settings};
    const struct wd_renderer_params renderer = {.gpu = gpu};
    return wd_forest_create(&subject->forest, &forest) == WD_OK &&
           wd_renderer_create(&subject->renderer, &renderer) == WD_OK &&
           wd_renderer_set_forest(subject->renderer, subject->forest) == WD_OK;
}

static double cpu_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* A walker goes where he looks. */
static void walk(struct wd_camera *camera, double way_m)
{
    camera->position_m[0] += sin(camera->yaw_rad) * way_m;
    camera->position_m[1] += cos(camera->yaw_rad) * way_m;
}

static bool draw(struct subject *subject, const char *view, int frame, enum wd_time_mode timing)
{
    struct wd_render_params params = {.samples = 1, .method = subject->method, .timing = timing};
    struct wd_render_defaults defaults;
    struct wd_frame_stats stats;
    struct wd_picture picture = {0};
    wd_forest_get_render_defaults(subject->forest, &defaults);
    params.width = defaults.width;
    params.height = defaults.height;
    params.time_s = 0.04 * frame;
    double start = cpu_s();
    bool ok = wd_forest_get_camera(subject->forest, view, &params.camera) == WD_OK;
    walk(&params.camera, subject->step_m * frame);
    ok = ok && wd_renderer_render(subject->renderer, &params, &picture) == WD_OK;
    wd_picture_finish(&picture);
    wd_renderer_get_stats(subject->renderer, &stats);
    if (ok && frame >= 0) {
        subject->frame_ms[frame] = stats.frame_ms;
        subject->cpu_ms[frame] = (cpu_s() - start) * 1e3;
    }
    return ok;
}

static void keep_passes(struct passes *passes, const struct wd_frame_stats *stats, int frame)
{
    passes->count = stats->pass_count < MAX_PASSES ? stats->pass_count : MAX_PASSES;
    for (uint32_t k = 0; k < passes->count; k++) {
        const struct wd_pass_time *pass = &stats->passes[k];
        passes->ms[k][frame] = pass->processor_ms > 0 ? pass->processor_ms : pass->gpu_ms;
        snprintf(passes->names[k], sizeof passes->names[k], "%*s%s", 2 * (int)pass->depth, "",
                 pass->name);
    }
}

/* On software devices processor time, so that other work on the machine does not count; else the device's. */
static bool print_passes(struct subject *subject, const char *view)
{
    struct passes passes = {0};
    struct wd_frame_stats stats;
    for (int frame = 0; frame < PASS_FRAMES; frame++) {
        if (!draw(subject, view, frame, WD_TIME_PASSES))
            return false;
        wd_renderer_get_stats(subject->renderer, &stats);
        keep_passes(&passes, &stats, frame);
    }
    printf("%-9s %-12s time of passes\n", view, subject->label);
    for (uint32_t k = 0; k < passes.count; k++)
        printf("    %-20s %7.1f ms\n", passes.names[k],
               bench_median(passes.ms[k], PASS_FRAMES));
    return true;
}

/* Medians over the frames of one view; each subject draws each frame in turn. */
struct result {
    double frame_ms[MAX_SUBJECTS], cpu_ms[MAX_SUBJECTS];
};

static bool measure_view(struct subject *subjects, int count, const char *view,
                         struct result *result)
{
    for (int frame = -2; frame < FRAMES; frame++) { /* the first two warm up */
        for (int i = 0; i < count; i++) {
            if (!draw(&subjects[i], view, frame, WD_TIME_OFF))
                return false;
        }
    }
    for (int i = 0; i < count; i++) {
        result->frame_ms[i] = bench_median(subjects[i].frame_ms, FRAMES);
        result->cpu_ms[i] = bench_median(subjects[i].cpu_ms, FRAMES);
        printf("%-9s %-12s frame %7.1f ms, processor time %7.1f ms\n", view, subjects[i].label,
               result->frame_ms[i], result->cpu_ms[i]);
    }
    for (int i = 0; i < count; i++) {
        if (!print_passes(&subjects[i], view))
            return false;
    }
    return true;
}

static bool measure(struct subject *subjects, int count, const char *gpu,
                    struct result results[VIEW_COUNT])
{
    bool ok = true;
    for (int i = 0; i < count && ok; i++)
        ok = open_subject(&subjects[i], gpu);
    for (int view = 0; view < VIEW_COUNT && ok; view++)
        ok = measure_view(subjects, count, VIEWS[view], &results[view]);
    return ok;
}

static void close_subjects(struct subject *subjects, int count)
{
    for (int i = 0; i < count; i++) {
        wd_renderer_destroy(&subjects[i].renderer);
        wd_forest_destroy(&subjects[i].forest);
    }
}

static double worst_ratio(const struct result results[VIEW_COUNT])
{
    double worst = 0.0;
    for (int view = 0; view < VIEW_COUNT; view++) {
        double ratio = results[view].frame_ms[0] / results[view].frame_ms[1];
        printf("%-9s ratio %.2f, of processor time %.2f\n", VIEWS[view], ratio,
               results[view].cpu_ms[0] / results[view].cpu_ms[1]);
        worst = ratio > worst ? ratio : worst;
    }
    return worst;
}

/* Against one other subject; the worst view counts. */
static bool compare(const struct subject *other, const char *gpu, const char *name)
{
    struct subject subjects[] = {{.label = "continuum", .method = "continuum"}, *other};
    struct result results[VIEW_COUNT];
    bool ok = measure(subjects, 2, gpu, results);
    if (ok)
        printf("%s %.2f x\n", name, worst_ratio(results));
    close_subjects(subjects, 2);
    return ok;
}

bool bench_continuum_vs_octree(const char *gpu)
{
    const struct subject octree = {.label = "octree", .method = "octree"};
    return compare(&octree, gpu, "continuum-vs-octree");
}

/* The least a frame can cost: cleared, one ground sample and one light a pixel, no tree. */
bool bench_continuum_floor(const char *gpu)
{
    const struct subject bare = {
        .label = "without trees", .method = "continuum", .setting = "layers.0.density=0"};
    return compare(&bare, gpu, "continuum-floor-ratio");
}

static bool measure_alone(const char *gpu, struct result results[VIEW_COUNT],
                          struct wd_frame_stats *stats)
{
    struct subject subject = {.label = "continuum", .method = "continuum"};
    bool ok = measure(&subject, 1, gpu, results);
    if (ok)
        wd_renderer_get_stats(subject.renderer, stats);
    close_subjects(&subject, 1);
    return ok;
}

bool bench_continuum_frame(const char *gpu)
{
    struct result results[VIEW_COUNT];
    struct wd_frame_stats stats;
    if (!measure_alone(gpu, results, &stats))
        return false;
    double worst = results[0].frame_ms[0];
    for (int view = 1; view < VIEW_COUNT; view++)
        worst = results[view].frame_ms[0] > worst ? results[view].frame_ms[0] : worst;
    printf("continuum-frame-ms %.1f ms\n", worst);
    return true;
}

/* At a walker's pace, 1.4 m/s at 25 frames a second, against a camera that stands still. */
bool bench_continuum_moving(const char *gpu)
{
    const struct subject still = {.label = "still", .method = "continuum"};
    struct subject subjects[] = {{.label = "moving", .method = "continuum", .step_m = 0.056}, still};
    struct result results[VIEW_COUNT];
    bool ok = measure(subjects, 2, gpu, results);
    if (ok)
        printf("continuum-moving-ratio %.2f x\n", worst_ratio(results));
    close_subjects(subjects, 2);
    return ok;
}

bool bench_continuum_memory(const char *gpu)
{
    struct result results[VIEW_COUNT];
    struct wd_frame_stats stats;
    if (!measure_alone(gpu, results, &stats))
        return false;
    printf("continuum-gpu-mb %.0f MB\n", (double)stats.device_bytes_peak / 1e6);
    return true;
}
