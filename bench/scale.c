/* Worlds of more and more trees, planted on demand, from the same camera (issue: cost follows the
 * pixels). Worlds that are compared draw their frames in turn, so that both meet the same machine. */
#include "figures.h"

#include <stdio.h>
#include <string.h>
#include <time.h>

enum { FRAMES = 7, FLIGHT_FRAMES = 48, MAX_WORLDS = 6 };
static const char *const SCENE = "scenes/scale.json";

struct world {
    double trees;        /* aimed at, as 1e6 */
    const char *setting; /* size of the ground */
    struct wd_forest *forest;
    struct wd_renderer *renderer;
    double frame_ms[FRAMES], cpu_ms[FRAMES];
};

static const struct world WORLDS[MAX_WORLDS] = {
    {.trees = 1e4, .setting = "terrain.size_m=[485,485]"},
    {.trees = 1e5, .setting = "terrain.size_m=[1530,1530]"},
    {.trees = 1e6, .setting = "terrain.size_m=[4850,4850]"},
    {.trees = 1e7, .setting = "terrain.size_m=[15300,15300]"},
    {.trees = 1e8, .setting = "terrain.size_m=[48500,48500]"},
    {.trees = 1e9, .setting = "terrain.size_m=[153000,153000]"},
};

static bool open_world(struct world *world, const char *scene, const char *gpu)
{
    const char *settings[] = {world->setting, NULL};
    const struct wd_forest_params forest = {.scene_path = scene, .settings = settings};
    const struct wd_renderer_params renderer = {.gpu = gpu};
    return wd_forest_create(&world->forest, &forest) == WD_OK &&
           wd_renderer_create(&world->renderer, &renderer) == WD_OK &&
           wd_renderer_set_forest(world->renderer, world->forest) == WD_OK;
}

static void close_world(struct world *world)
{
    wd_renderer_destroy(&world->renderer);
    wd_forest_destroy(&world->forest);
}

static double cpu_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static bool draw(struct world *world, struct wd_render_params *params, double *frame_ms,
                 double *cpu_ms)
{
    struct wd_frame_stats stats;
    struct wd_picture picture = {0};
    double start = cpu_s();
    bool ok = wd_renderer_render(world->renderer, params, &picture) == WD_OK;
    wd_picture_finish(&picture);
    wd_renderer_get_stats(world->renderer, &stats);
    *frame_ms = stats.frame_ms;
    *cpu_ms = (cpu_s() - start) * 1e3;
    return ok;
}

static bool draw_camera(struct world *world, const char *camera, int frame)
{
    struct wd_render_params params = {.samples = 1, .method = "continuum"};
    struct wd_render_defaults defaults;
    double frame_ms, cpu_ms;
    wd_forest_get_render_defaults(world->forest, &defaults);
    params.width = defaults.width;
    params.height = defaults.height;
    if (wd_forest_get_camera(world->forest, camera, &params.camera) != WD_OK ||
        !draw(world, &params, &frame_ms, &cpu_ms))
        return false;
    if (frame >= 0) {
        world->frame_ms[frame] = frame_ms;
        world->cpu_ms[frame] = cpu_ms;
    }
    return true;
}

static double peak_mb(const struct world *world)
{
    struct wd_frame_stats stats;
    wd_renderer_get_stats(world->renderer, &stats);
    return (double)stats.device_bytes_peak / 1e6;
}

static void report(struct world *world, const char *camera, double *frame_ms, double *cpu_ms)
{
    struct wd_forest_info info;
    wd_forest_get_info(world->forest, &info);
    *frame_ms = bench_median(world->frame_ms, FRAMES);
    *cpu_ms = bench_median(world->cpu_ms, FRAMES);
    printf("%-9s %11.0f trees: frame %7.1f ms, processor time %7.1f ms, device %4.0f MB\n", camera,
           (double)info.tree_count, *frame_ms, *cpu_ms, peak_mb(world));
}

/* Ratio of the second world's frame to the first one's. */
bool bench_scale_ratio(const char *gpu)
{
    struct world worlds[2] = {WORLDS[2], WORLDS[5]};
    double frame_ms[2], cpu_ms[2];
    bool ok = open_world(&worlds[0], SCENE, gpu) && open_world(&worlds[1], SCENE, gpu);
    for (int frame = -2; frame < FRAMES && ok; frame++)
        ok = draw_camera(&worlds[0], "overview", frame) &&
             draw_camera(&worlds[1], "overview", frame);
    for (int i = 0; i < 2 && ok; i++)
        report(&worlds[i], "overview", &frame_ms[i], &cpu_ms[i]);
    if (ok) {
        printf("ratio of processor time %.2f\n", cpu_ms[1] / cpu_ms[0]);
        printf("scale-1e6-1e9-ratio %.2f x\n", frame_ms[1] / frame_ms[0]);
    }
    close_world(&worlds[0]);
    close_world(&worlds[1]);
    return ok;
}

/* Device memory of every world, from near and from far. */
bool bench_scale_memory(const char *gpu)
{
    double most = 0.0;
    for (int i = 0; i < MAX_WORLDS; i++) {
        struct world world = WORLDS[i];
        double frame_ms, cpu_ms, mb = 0.0;
        bool ok = open_world(&world, SCENE, gpu);
        for (int frame = -2; frame < FRAMES && ok; frame++)
            ok = draw_camera(&world, "overview", frame);
        if (ok)
            report(&world, "overview", &frame_ms, &cpu_ms);
        ok = ok && draw_camera(&world, "walk", -1) && draw_camera(&world, "flight", -1);
        mb = ok ? peak_mb(&world) : 0.0;
        close_world(&world);
        if (!ok)
            return false;
        most = mb > most ? mb : most;
    }
    printf("scale-gpu-mb %.0f MB\n", most);
    return true;
}

/* Ten million trees along a slow path: the slowest frame over the median. */
bool bench_scale_flight(const char *gpu)
{
    struct world world = WORLDS[3];
    double frame_ms[FLIGHT_FRAMES], ignored, worst = 0.0;
    bool ok = open_world(&world, SCENE, gpu);
    struct wd_render_params params = {
        .samples = 1, .method = "continuum", .width = 640, .height = 480};
    for (int i = -2; i < FLIGHT_FRAMES && ok; i++) {
        double at_s = i < 0 ? 0.0 : i / 24.0, once_ms;
        ok = wd_forest_get_path_camera(world.forest, "slow", at_s, &params.camera, NULL) == WD_OK &&
             draw(&world, &params, &once_ms, &ignored);
        if (ok && i >= 0)
            frame_ms[i] = once_ms;
    }
    close_world(&world);
    if (!ok)
        return false;
    for (int i = 0; i < FLIGHT_FRAMES; i++)
        worst = frame_ms[i] > worst ? frame_ms[i] : worst;
    double median = bench_median(frame_ms, FLIGHT_FRAMES);
    printf("median %.1f ms, slowest of %d frames %.1f ms\n", median, FLIGHT_FRAMES, worst);
    printf("scale-flight-worst %.2f x\n", worst / median);
    return true;
}
