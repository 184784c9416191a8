/* sprays.h: what is drawn of leaves close to the camera: the twigs that they stand for. */
#ifndef WD_FOREST_SPRAYS_H
#define WD_FOREST_SPRAYS_H

#include "gpu/command.h"
#include "tree/grow.h"

/* Of one model; leaf_count 0: its drawn leaves are single leaves. Firsts of leaves and vertices are
 * multiples of WD_SPRAY_ALIGNMENT; indices count from the first vertex. */
struct wd_spray_range {
    uint32_t first_leaf, leaf_count;
    uint32_t first_vertex, vertex_count;
    uint32_t first_index, index_count;
    float reach; /* of wd_spray_share; 0 without leaves */
};
#define WD_SPRAY_ALIGNMENT 64 /* elements: of every storage buffer alignment that Vulkan allows */

struct wd_forest_sprays {
    struct wd_buffer leaves;   /* struct wd_tree_leaf[]; never empty */
    struct wd_buffer vertices; /* struct wd_tree_vertex[] of the twigs; never empty */
    struct wd_buffer indices;  /* uint32_t[] */
    struct wd_tree_leaf *host_leaves;
    struct wd_spray_range *ranges; /* [model] */
};

bool wd_forest_sprays_init(struct wd_forest_sprays *sprays, struct wd_gpu *gpu,
                           const struct wd_tree_model *models, uint32_t count);
void wd_forest_sprays_finish(struct wd_forest_sprays *sprays, struct wd_gpu *gpu);
/* Declares that the frame's passes read all of it. */
void wd_forest_sprays_use(struct wd_forest_sprays *sprays, struct wd_cmd *cmd);

#endif
