/* A hundred unique trees, grown, baked and brought to the device; and one. */
#include "figures.h"

#include <stdio.h>
#include <stdlib.h>

/* What a small picture by a method makes of a forest: all that the method needs of each model. */
static bool draw_once(struct wd_renderer *renderer, const struct wd_forest *forest,
                      const char *method)
{
    struct wd_render_params render = {.width = 64, .height = 64, .method = method};
    struct wd_picture picture = {0};
    bool ok = wd_forest_get_camera(forest, NULL, &render.camera) == WD_OK &&
              wd_renderer_render(renderer, &render, &picture) == WD_OK;
    wd_picture_finish(&picture);
    return ok;
}

/* Pictures of one tree of another species: pipelines are made. */
static bool warm_up(struct wd_renderer *renderer)
{
    const char *settings[] = {"species.oak=../species/larch.json", NULL};
    const struct wd_forest_params params = {.scene_path = "bench/oaks.json", .settings = settings};
    struct wd_forest *forest = NULL;
    bool ok = wd_forest_create(&forest, &params) == WD_OK &&
              wd_renderer_set_forest(renderer, forest) == WD_OK &&
              draw_once(renderer, forest, "continuum") && draw_once(renderer, forest, "octree") &&
              wd_renderer_set_forest(renderer, NULL) == WD_OK;
    wd_forest_destroy(&forest);
    return ok;
}

/* Seconds for growing and baking with one picture by `continuum` (meshes, leaves, discs) and one by
 * `octree` (cards). */
static bool bake(const char *gpu, const char *cache_dir, double *seconds)
{
    static const char *const methods[] = {"continuum", "octree"};
    const struct wd_forest_params forest_params = {.scene_path = "bench/trees100.json"};
    const struct wd_renderer_params renderer_params = {.gpu = gpu, .cache_dir = cache_dir};
    struct wd_forest *forest = NULL;
    struct wd_renderer *renderer = NULL;
    struct wd_frame_stats stats;
    bool ok = wd_forest_create(&forest, &forest_params) == WD_OK &&
              wd_renderer_create(&renderer, &renderer_params) == WD_OK && warm_up(renderer);
    double start = bench_now_s();
    ok = ok && wd_renderer_set_forest(renderer, forest) == WD_OK;
    for (int i = 0; i < 2 && ok; i++) {
        ok = draw_once(renderer, forest, methods[i]);
        wd_renderer_get_stats(renderer, &stats);
        *seconds = bench_now_s() - start;
        printf("%s: 100 trees ready for %s%s in %.2f s, %.0f MB of device memory\n",
               wd_renderer_device_name(renderer), i ? "this and " : "", methods[i], *seconds,
               (double)stats.device_bytes / 1e6);
    }
    wd_renderer_destroy(&renderer);
    wd_forest_destroy(&forest);
    return ok;
}

static bool make_cache(char *path)
{
    if (mkdtemp(path))
        return true;
    fprintf(stderr, "bench: no temporary directory can be made in /tmp\n");
    return false;
}

bool bench_bake_cold(const char *gpu)
{
    char cache[] = "/tmp/weald-bench-XXXXXX";
    double seconds;
    if (!make_cache(cache))
        return false;
    bool ok = bake(gpu, cache, &seconds);
    bench_remove_directory(cache);
    if (ok)
        printf("bake-100-cold-s %.2f s\n", seconds);
    return ok;
}

bool bench_bake_warm(const char *gpu)
{
    char cache[] = "/tmp/weald-bench-XXXXXX";
    double seconds[3];
    if (!make_cache(cache))
        return false;
    bool ok = bake(gpu, cache, &seconds[0]); /* fills the cache */
    for (int i = 0; i < 3 && ok; i++)
        ok = bake(gpu, cache, &seconds[i]);
    bench_remove_directory(cache);
    if (ok)
        printf("bake-100-warm-s %.2f s\n", bench_median(seconds, 3));
    return ok;
}

/* Device memory after pictures of a scene with so many variants of each species at hand: meshes, leaves,
 * cards, discs and wood of each are there, whatever the pictures show. */
static bool model_bytes(const char *gpu, const char *scene, const char *variants, double *bytes)
{
    const char *settings[] = {variants, NULL};
    const struct wd_forest_params forest_params = {.scene_path = scene, .settings = settings};
    const struct wd_renderer_params renderer_params = {.gpu = gpu};
    struct wd_forest *forest = NULL;
    struct wd_renderer *renderer = NULL;
    struct wd_frame_stats stats;
    bool ok = wd_forest_create(&forest, &forest_params) == WD_OK &&
              wd_renderer_create(&renderer, &renderer_params) == WD_OK &&
              wd_renderer_set_forest(renderer, forest) == WD_OK &&
              draw_once(renderer, forest, "continuum") && draw_once(renderer, forest, "octree");
    if (ok) {
        wd_renderer_get_stats(renderer, &stats);
        *bytes = (double)stats.device_bytes;
        printf("%s: %.2f MB of device memory\n", variants, *bytes / 1e6);
    }
    wd_renderer_destroy(&renderer);
    wd_forest_destroy(&forest);
    return ok;
}

/* What 18 more variants of five species take; frames and looks, which any number of trees shares, are not
 * in it. */
bool bench_bake_memory(const char *gpu)
{
    const char *scene = "bench/trees100.json";
    double few, all;
    if (!model_bytes(gpu, scene, "variants=2", &few) || !model_bytes(gpu, scene, "variants=20", &all))
        return false;
    printf("bake-100-gpu-mb %.0f MB\n", (all - few) / 90e6 * 100);
    return true;
}

bool bench_oak_memory(const char *gpu)
{
    const char *scene = "bench/oaks.json";
    double one, more;
    if (!model_bytes(gpu, scene, "variants=2", &one) ||
        !model_bytes(gpu, scene, "variants=10", &more))
        return false;
    printf("oak-20k-mb %.2f MB\n", (more - one) / 8e6);
    return true;
}
