/* Geometry in several levels and billboards last, chosen by the distance of each tree with thresholds
 * that the user sets (Jia, Wang, Song: "Lots of dynamic trees based on OSG"; row O1). A scene graph's
 * switch nodes change at once; here levels blend by noise unless `faithful`. Trees hang in groups, as
 * under a scene graph's nodes: what of those a view misses is culled whole. */
#include "methods/method.h"

#include "methods/cells.h"

static const double GROUP_TREES = 64.0;

struct lod {
    struct wd_cells groups;
    struct wd_cell_list seen;
    struct wd_selection selection;
};

static bool lod_use_forest(void *state, struct wd_gpu *gpu, struct wd_forest_device *forest)
{
    struct lod *lod = state;
    (void)gpu;
    if (forest->world->tree_count)
        wd_cells_init(&lod->groups, forest->world, wd_cells_size(forest->world, GROUP_TREES));
    return true;
}

static void lod_drop_forest(void *state, struct wd_gpu *gpu)
{
    struct lod *lod = state;
    (void)gpu;
    wd_cells_finish(&lod->groups);
    wd_cell_list_finish(&lod->seen);
    wd_selection_finish(&lod->selection);
}

/* Far cascades keep the coarser levels that all methods give them. */
static struct wd_level_rule rule_of(const struct wd_tree_draw *draw)
{
    const struct wd_lod_options *options = &draw->forest->scene->methods.lod;
    struct wd_level_rule rule = wd_level_rule_of(draw->forest, draw->view, draw->pass);
    if (rule.finest == WD_LEVEL_MESH) {
        float scale = options->faithful ? 1.0f : draw->view->lod_scale;
        rule.mesh_m = (float)options->full_m * scale;
        rule.reduced_m = (float)options->reduced_m * scale;
        rule.plain = true;
    }
    rule.blend = options->faithful ? 0.0f : (float)options->blend;
    return rule;
}

static void lod_select(void *state, const struct wd_tree_draw *draw)
{
    struct lod *lod = state;
    const struct wd_level_rule rule = rule_of(draw);
    wd_selection_clear(&lod->selection);
    wd_cell_list_fill(&lod->seen, &lod->groups, draw->view);
    for (size_t i = 0; i < lod->seen.count; i++) {
        uint32_t group = lod->seen.items[i].cell;
        for (uint32_t k = lod->groups.first[group]; k < lod->groups.first[group + 1]; k++)
            wd_selection_add_tree(&lod->selection, draw->forest, draw->view, &rule,
                                  lod->groups.trees[k]);
    }
}

static void lod_draw(void *state, const struct wd_tree_draw *draw)
{
    struct lod *lod = state;
    wd_tree_draw_selection(draw, &lod->selection, WD_DRAW_GROUPED);
}

const struct wd_method wd_method_lod = {
    .name = "lod",
    .cards = true,
    .state_size = sizeof(struct lod),
    .use_forest = lod_use_forest,
    .drop_forest = lod_drop_forest,
    .select = lod_select,
    .draw = lod_draw,
};
