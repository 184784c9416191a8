/* view_trees.h: trees drawn by pictures from all around them, near ones as meshes: what the methods
 * views and zfield share. Shadows are those of `octree`. */
#ifndef WD_METHODS_VIEW_TREES_H
#define WD_METHODS_VIEW_TREES_H

#include "forest/model_bakes.h"
#include "methods/cells.h"
#include "methods/method.h"
#include "shared/view_draw.h"

struct wd_view_trees {
    struct wd_pipeline pipeline;
    VkSampler sampler;
    struct wd_view_sets sets;
    struct wd_cells groups;
    struct wd_cell_list seen;
    struct wd_selection selection; /* meshes */
    struct wd_instance *trees;     /* drawn by their pictures */
    size_t tree_count;
    void *shadows;                 /* state of `octree` */
};

enum wd_view_shape { WD_VIEW_FLAT, WD_VIEW_DEPTH }; /* the quad itself, or the pictures' depths */
bool wd_view_trees_init(struct wd_view_trees *trees, struct wd_gpu *gpu, enum wd_view_shape shape);
void wd_view_trees_finish(struct wd_view_trees *trees, struct wd_gpu *gpu);
bool wd_view_trees_use_forest(struct wd_view_trees *trees, struct wd_gpu *gpu,
                              struct wd_forest_device *forest,
                              const struct wd_view_sets_params *params);
void wd_view_trees_drop_forest(struct wd_view_trees *trees, struct wd_gpu *gpu);

/* Trees nearer than `near_m` are meshes, none is beyond range_m (0: no end). */
void wd_view_trees_select(struct wd_view_trees *trees, const struct wd_tree_draw *draw,
                          float near_m, float range_m);
/* `push` needs nearest, refine, range_m and fade; the rest is filled in. */
void wd_view_trees_draw(struct wd_view_trees *trees, const struct wd_tree_draw *draw,
                        struct wd_view_push push);

#endif
