/* From nothing to the first frame of the default scene, and the memory it takes. */
#include "figures.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>

struct start {
    double forest_s, device_s, trees_s, frame_s, total_s;
    uint64_t tree_count, device_bytes, device_bytes_peak;
};

/* Scene, placement, device, trees and one frame of one sample. */
static bool first_frame(const char *gpu, const char *cache_dir, struct start *start)
{
    const struct wd_forest_params forest_params = {.scene_path = "scenes/valley.json"};
    const struct wd_renderer_params renderer_params = {.gpu = gpu, .cache_dir = cache_dir};
    struct wd_forest *forest = NULL;
    struct wd_renderer *renderer = NULL;
    struct wd_picture picture = {0};
    struct wd_render_params render = {.samples = 1};
    double t[5];
    t[0] = bench_now_s();
    bool ok = wd_forest_create(&forest, &forest_params) == WD_OK;
    t[1] = bench_now_s();
    ok = ok && wd_renderer_create(&renderer, &renderer_params) == WD_OK;
    t[2] = bench_now_s();
    ok = ok && wd_renderer_set_forest(renderer, forest) == WD_OK;
    t[3] = bench_now_s();
    if (ok) {
        struct wd_render_defaults defaults;
        wd_forest_get_render_defaults(forest, &defaults);
        render.width = defaults.width;
        render.height = defaults.height;
        ok = wd_forest_get_camera(forest, NULL, &render.camera) == WD_OK &&
             wd_renderer_render(renderer, &render, &picture) == WD_OK;
    }
    t[4] = bench_now_s();
    if (ok) {
        struct wd_forest_info info;
        struct wd_frame_stats stats;
        wd_forest_get_info(forest, &info);
        wd_renderer_get_stats(renderer, &stats);
        *start = (struct start){t[1] - t[0],     t[2] - t[1],        t[3] - t[2],
                                t[4] - t[3],     t[4] - t[0],        info.tree_count,
                                stats.device_bytes, stats.device_bytes_peak};
        printf("%llu trees, %u x %u, %s: scene and placement %.2f s, device %.2f s, trees %.2f s, "
               "frame %.2f s\n",
               (unsigned long long)info.tree_count, render.width, render.height,
               wd_renderer_device_name(renderer), start->forest_s, start->device_s, start->trees_s,
               start->frame_s);
    }
    wd_picture_finish(&picture);
    wd_renderer_destroy(&renderer);
    wd_forest_destroy(&forest);
    return ok;
}

bool bench_first_frame_cold(const char *gpu)
{
    char cache[] = "/tmp/weald-bench-XXXXXX";
    struct start start;
    if (!mkdtemp(cache)) {
        fprintf(stderr, "bench: no temporary directory can be made in /tmp\n");
        return false;
    }
    bool ok = first_frame(gpu, cache, &start);
    bench_remove_directory(cache);
    if (ok)
        printf("first-frame-cold-s %.2f s\n", start.total_s);
    return ok;
}

bool bench_first_frame_warm(const char *gpu)
{
    char cache[] = "/tmp/weald-bench-XXXXXX";
    struct start start;
    double total[3];
    if (!mkdtemp(cache)) {
        fprintf(stderr, "bench: no temporary directory can be made in /tmp\n");
        return false;
    }
    bool ok = first_frame(gpu, cache, &start); /* fills the cache */
    for (int i = 0; i < 3 && ok; i++) {
        ok = first_frame(gpu, cache, &start);
        total[i] = start.total_s;
    }
    bench_remove_directory(cache);
    if (ok)
        printf("first-frame-warm-s %.2f s\n", bench_median(total, 3));
    return ok;
}

bool bench_peak_memory(const char *gpu)
{
    struct start start;
    struct rusage usage;
    if (!first_frame(gpu, "", &start) || getrusage(RUSAGE_SELF, &usage) != 0)
        return false;
    printf("device memory %.0f MB at the end, %.0f MB at its peak (software devices take it from "
           "the process)\n",
           (double)start.device_bytes / 1e6, (double)start.device_bytes_peak / 1e6);
    printf("peak-memory-mb %.0f MB\n", (double)usage.ru_maxrss * 1024.0 / 1e6);
    return true;
}
