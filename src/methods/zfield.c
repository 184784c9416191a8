/* Z-fields (Bruneton and Neyret 2012): every tree as one quad, on which each pixel looks along its
 * ray for the tree's surface, from the depths of three views around: trees meet the ground and each
 * other pixel by pixel, and nothing is sorted. Over the last part of the range the canopy's map
 * takes over. */
#include "methods/canopy_map.h"

struct zfield {
    struct wd_view_trees trees;
    struct wd_canopy_map far;
};

static bool zfield_init(void *state, struct wd_gpu *gpu)
{
    struct zfield *zfield = state;
    return wd_view_trees_init(&zfield->trees, gpu, WD_VIEW_DEPTH) &&
           wd_canopy_map_init(&zfield->far, gpu);
}

static void zfield_finish(void *state, struct wd_gpu *gpu)
{
    struct zfield *zfield = state;
    wd_view_trees_finish(&zfield->trees, gpu);
    wd_canopy_map_finish(&zfield->far, gpu);
}

static bool zfield_use_forest(void *state, struct wd_gpu *gpu, struct wd_forest_device *forest)
{
    struct zfield *zfield = state;
    const struct wd_zfield_options *options = &forest->scene->methods.zfield;
    const struct wd_view_sets_params params = {
        .progress = &forest->progress,
        .views = {.hemisphere = {WD_VIEWS_EVEN, (uint32_t)options->rows, 0},
                  .size = (uint32_t)options->size,
                  .samples = (uint32_t)options->samples},
        .variants = (uint32_t)options->variants,
    };
    return wd_view_trees_use_forest(&zfield->trees, gpu, forest, &params) &&
           wd_canopy_map_use_forest(&zfield->far, gpu, forest, &zfield->trees);
}

static void zfield_drop_forest(void *state, struct wd_gpu *gpu)
{
    struct zfield *zfield = state;
    wd_view_trees_drop_forest(&zfield->trees, gpu);
    wd_canopy_map_drop_forest(&zfield->far, gpu);
}

static bool shows_far(const struct wd_tree_draw *draw)
{
    const struct wd_zfield_options *options = &draw->forest->scene->methods.zfield;
    return draw->pass == WD_PASS_CAMERA && options->canopy_map && options->range_m > 0.0;
}

static void zfield_select(void *state, const struct wd_tree_draw *draw)
{
    struct zfield *zfield = state;
    const struct wd_zfield_options *options = &draw->forest->scene->methods.zfield;
    wd_view_trees_select(&zfield->trees, draw, (float)options->near_m, (float)options->range_m);
    if (shows_far(draw))
        wd_canopy_map_select(&zfield->far, draw, &zfield->trees, (float)options->range_m,
                             (float)options->fade);
}

static void zfield_draw(void *state, const struct wd_tree_draw *draw)
{
    struct zfield *zfield = state;
    const struct wd_zfield_options *options = &draw->forest->scene->methods.zfield;
    if (shows_far(draw))
        wd_canopy_map_draw(&zfield->far, draw);
    wd_view_trees_draw(&zfield->trees, draw,
                       (struct wd_view_push){.refine = (uint32_t)options->refine,
                                             .range_m = (float)options->range_m,
                                             .fade = (float)options->fade});
}

const struct wd_method wd_method_zfield = {
    .name = "zfield",
    .cards = true,
    .eye_pictures = true,
    .state_size = sizeof(struct zfield),
    .init = zfield_init,
    .finish = zfield_finish,
    .use_forest = zfield_use_forest,
    .drop_forest = zfield_drop_forest,
    .select = zfield_select,
    .draw = zfield_draw,
};
