/* 75,000 trees at 800 x 600 (the size of Guerrero 2006's experiment): octree against separate. */
#include "figures.h"

#include <stdio.h>
#include <string.h>

enum { FRAMES = 7 };

struct times {
    double pass_ms[16]; /* medians, by the pass's place in the frame */
    char names[16][32];
    uint32_t pass_count;
    double trees_ms; /* of the passes that draw trees: device + recording */
    double frame_ms; /* of the whole frame, untimed passes */
    uint64_t draw_calls, triangles;
};

struct bench {
    struct wd_forest *forest;
    struct wd_renderer *renderer;
    struct wd_camera camera;
    struct wd_render_defaults defaults;
};

static void bench_finish(struct bench *bench)
{
    wd_renderer_destroy(&bench->renderer);
    wd_forest_destroy(&bench->forest);
}

static bool bench_init(struct bench *bench, const char *gpu)
{
    const struct wd_forest_params forest = {.scene_path = "scenes/bench75k.json"};
    const struct wd_renderer_params renderer = {.gpu = gpu};
    *bench = (struct bench){0};
    bool ok = wd_forest_create(&bench->forest, &forest) == WD_OK &&
              wd_renderer_create(&bench->renderer, &renderer) == WD_OK &&
              wd_renderer_set_forest(bench->renderer, bench->forest) == WD_OK &&
              wd_forest_get_camera(bench->forest, "overview", &bench->camera) == WD_OK;
    if (!ok) {
        bench_finish(bench);
        return false;
    }
    struct wd_forest_info info;
    wd_forest_get_info(bench->forest, &info);
    wd_forest_get_render_defaults(bench->forest, &bench->defaults);
    printf("%llu trees, %u x %u, camera overview, 1 sample, %s\n",
           (unsigned long long)info.tree_count, bench->defaults.width, bench->defaults.height,
           wd_renderer_device_name(bench->renderer));
    return true;
}

static bool draws_trees(const char *pass)
{
    return strstr(pass, "trees") != NULL;
}

static bool draw(struct bench *bench, const char *method, enum wd_time_mode timing)
{
    const struct wd_render_params params = {
        .camera = bench->camera,
        .width = bench->defaults.width,
        .height = bench->defaults.height,
        .samples = 1,
        .method = method,
        .timing = timing,
    };
    struct wd_picture picture;
    enum wd_result result = wd_renderer_render(bench->renderer, &params, &picture);
    wd_picture_finish(&picture);
    return result == WD_OK;
}

static bool measure(struct bench *bench, const char *method, struct times *times)
{
    double pass[16][FRAMES], trees[FRAMES], frame[FRAMES];
    struct wd_frame_stats stats;
    *times = (struct times){0};
    for (int i = -1; i < FRAMES; i++) { /* the first warms up */
        if (!draw(bench, method, WD_TIME_PASSES))
            return false;
        wd_renderer_get_stats(bench->renderer, &stats);
        times->pass_count = stats.pass_count < 16 ? stats.pass_count : 16;
        if (i < 0)
            continue;
        trees[i] = 0.0;
        for (uint32_t k = 0; k < times->pass_count; k++) {
            pass[k][i] = stats.passes[k].gpu_ms + stats.passes[k].cpu_ms;
            snprintf(times->names[k], sizeof times->names[k], "%s", stats.passes[k].name);
            if (draws_trees(stats.passes[k].name))
                trees[i] += pass[k][i];
        }
    }
    for (int i = -1; i < FRAMES; i++) {
        if (!draw(bench, method, WD_TIME_OFF))
            return false;
        wd_renderer_get_stats(bench->renderer, &stats);
        if (i >= 0)
            frame[i] = stats.frame_ms;
    }
    for (uint32_t k = 0; k < times->pass_count; k++)
        times->pass_ms[k] = bench_median(pass[k], FRAMES);
    times->trees_ms = bench_median(trees, FRAMES);
    times->frame_ms = bench_median(frame, FRAMES);
    times->draw_calls = stats.draw_calls;
    times->triangles = stats.triangles;
    return true;
}

static void print_times(const char *method, const struct times *times)
{
    printf("%-10s frame %.1f ms, tree passes %.1f ms, %llu draws, %llu triangles\n", method,
           times->frame_ms, times->trees_ms, (unsigned long long)times->draw_calls,
           (unsigned long long)times->triangles);
    for (uint32_t k = 0; k < times->pass_count; k++)
        printf("    %-16s %8.2f ms\n", times->names[k], times->pass_ms[k]);
}

bool bench_octree_speedup(const char *gpu)
{
    struct bench bench;
    struct times octree, separate;
    if (!bench_init(&bench, gpu))
        return false;
    bool ok = measure(&bench, "octree", &octree) && measure(&bench, "separate", &separate);
    if (ok) {
        print_times("octree", &octree);
        print_times("separate", &separate);
        printf("octree-speedup %.2f x\n", separate.trees_ms / octree.trees_ms);
    }
    bench_finish(&bench);
    return ok;
}

bool bench_octree_frame(const char *gpu)
{
    struct bench bench;
    struct times octree;
    if (!bench_init(&bench, gpu))
        return false;
    bool ok = measure(&bench, "octree", &octree);
    if (ok) {
        print_times("octree", &octree);
        printf("octree-frame-ms %.1f ms\n", octree.frame_ms);
    }
    bench_finish(&bench);
    return ok;
}
