/* Every tree as one quad with its picture from the nearest of many views (Sterling and Justin, rows
 * R3 and R4), or blended of the three views around (row R6). */
#include "methods/view_trees.h"

static bool views_init(void *state, struct wd_gpu *gpu)
{
    return wd_view_trees_init(state, gpu, WD_VIEW_FLAT);
}

static void views_finish(void *state, struct wd_gpu *gpu)
{
    wd_view_trees_finish(state, gpu);
}

static bool views_use_forest(void *state, struct wd_gpu *gpu, struct wd_forest_device *forest)
{
    const struct wd_views_options *options = &forest->scene->methods.views;
    const struct wd_view_sets_params params = {
        .progress = &forest->progress,
        .views = {.hemisphere = {(uint32_t)options->layout, (uint32_t)options->rows,
                                 (uint32_t)options->columns},
                  .size = (uint32_t)options->size,
                  .samples = (uint32_t)options->samples},
        .variants = (uint32_t)options->variants,
    };
    return wd_view_trees_use_forest(state, gpu, forest, &params);
}

static void views_drop_forest(void *state, struct wd_gpu *gpu)
{
    wd_view_trees_drop_forest(state, gpu);
}

static void views_select(void *state, const struct wd_tree_draw *draw)
{
    const struct wd_views_options *options = &draw->forest->scene->methods.views;
    wd_view_trees_select(state, draw, options->faithful ? 0.0f : (float)options->near_m, 0.0f);
}

static void views_draw(void *state, const struct wd_tree_draw *draw)
{
    const struct wd_views_options *options = &draw->forest->scene->methods.views;
    bool nearest = options->faithful || options->blend == WD_VIEWS_NEAREST;
    wd_view_trees_draw(state, draw, (struct wd_view_push){.nearest = nearest});
}

const struct wd_method wd_method_views = {
    .name = "views",
    .cards = true,
    .eye_pictures = true,
    .state_size = sizeof(struct wd_view_trees),
    .init = views_init,
    .finish = views_finish,
    .use_forest = views_use_forest,
    .drop_forest = views_drop_forest,
    .select = views_select,
    .draw = views_draw,
};
