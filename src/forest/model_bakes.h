/* model_bakes.h: pictures of a forest's models as device images: cards, and views from all over the
 * hemisphere. Baked from the meshes on the device, or loaded from the forest's cache. */
#ifndef WD_FOREST_MODEL_BAKES_H
#define WD_FOREST_MODEL_BAKES_H

#include "bake/views.h"
#include "forest/forest.h"

/* A model with its leaves as triangles, as it was grown or as the cache has it; the caller's to
 * finish. */
bool wd_forest_grow_model(struct wd_tree_model *grown, struct wd_forest_device *forest,
                          uint32_t model, const struct wd_log *log);

/* Of the depth plane all that it holds, or the share of leaves alone. */
enum wd_card_depth { WD_CARD_DEPTH_ALL, WD_CARD_DEPTH_LEAVES };

/* Makes images of WD_CARDS layers a model for each plane (WD_PLANE_*) whose `images` is not NULL:
 * cards of whole trees, or of wood and leaves apart (W6). They must be {0} before, and are the
 * caller's to finish, also after a failure. */
bool wd_forest_bake_cards(struct wd_forest_device *forest, struct wd_gpu *gpu,
                          enum wd_bake_parts parts, struct wd_image *images[WD_PLANES],
                          enum wd_card_depth depth);

/* Makes the forest's own cards, of whole trees, unless they are there. No frame is being recorded. */
bool wd_forest_make_cards(struct wd_forest_device *forest, struct wd_gpu *gpu);

/* View sets of all models, or of the first variants of each species. */
struct wd_view_sets {
    struct wd_view_atlas atlas;
    struct wd_image planes[WD_PLANES]; /* 2D arrays, one layer a baked model */
    struct wd_buffer models; /* struct wd_view_model[forest->model_count]; a tree of variant v has
                                the pictures of variant v % variants */
    uint32_t variants;       /* of each species, that have pictures */
    uint32_t layers;
    uint64_t baked_us, bytes;
};
struct wd_view_sets_params {
    struct wd_view_set_params views;
    uint32_t variants; /* of each species, that get pictures; 0: all */
    const struct wd_progress *progress;
};
bool wd_view_sets_init(struct wd_view_sets *sets, struct wd_gpu *gpu,
                       struct wd_forest_device *forest, const struct wd_view_sets_params *params);
void wd_view_sets_finish(struct wd_view_sets *sets, struct wd_gpu *gpu); /* accepts {0} */
/* Declares that this frame's passes read them. */
void wd_view_sets_use(struct wd_view_sets *sets, struct wd_cmd *cmd);

#endif
