/* Z-fields (Bruneton and Neyret 2012): every tree as one quad, on which each pixel looks along its
 * ray for the tree's surface, from the depths of three views around: trees meet the ground and each
 * other pixel by pixel, and nothing is sorted. Over the last part of the range the canopy's own map
 * takes over (zfield_far.c). */
#include "methods/view_trees.h"

static bool zfield_init(void *state, struct wd_gpu *gpu)
{
    return wd_view_trees_init(state, gpu, WD_VIEW_DEPTH);
}

static void zfield_finish(void *state, struct wd_gpu *gpu)
{
    wd_view_trees_finish(state, gpu);
}

static bool zfield_use_forest(void *state, struct wd_gpu *gpu, struct wd_forest_device *forest)
{
    const struct wd_zfield_options *options = &forest->scene->methods.zfield;
    const struct wd_view_sets_params params = {
        .views = {.hemisphere = {WD_VIEWS_EVEN, (uint32_t)options->rows, 0},
                  .size = (uint32_t)options->size,
                  .samples = (uint32_t)options->samples},
        .variants = (uint32_t)options->variants,
    };
    return wd_view_trees_use_forest(state, gpu, forest, &params);
}

static void zfield_drop_forest(void *state, struct wd_gpu *gpu)
{
    wd_view_trees_drop_forest(state, gpu);
}

static void zfield_select(void *state, const struct wd_tree_draw *draw)
{
    const struct wd_zfield_options *options = &draw->forest->scene->methods.zfield;
    wd_view_trees_select(state, draw, (float)options->near_m, (float)options->range_m);
}

static void zfield_draw(void *state, const struct wd_tree_draw *draw)
{
    const struct wd_zfield_options *options = &draw->forest->scene->methods.zfield;
    wd_view_trees_draw(state, draw,
                       (struct wd_view_push){.refine = (uint32_t)options->refine,
                                             .range_m = (float)options->range_m,
                                             .fade = (float)options->fade});
}

const struct wd_method wd_method_zfield = {
    .name = "zfield",
    .state_size = sizeof(struct wd_view_trees),
    .init = zfield_init,
    .finish = zfield_finish,
    .use_forest = zfield_use_forest,
    .drop_forest = zfield_drop_forest,
    .select = zfield_select,
    .draw = zfield_draw,
};
