/* canopy_map.h: far forest drawn as a look of the ground's pixels (Bruneton and Neyret 2012). */
#ifndef WD_METHODS_CANOPY_MAP_H
#define WD_METHODS_CANOPY_MAP_H

#include "methods/view_trees.h"
#include "shared/canopy_map.h"

struct wd_canopy_map {
    struct wd_pipeline map, draw;
    struct wd_buffer cell_first, cell_trees; /* of view_trees' groups */
    struct wd_buffer pixels;                 /* struct wd_canopy_pixel a pixel of the picture */
    VkSampler sampler;
    float canopy_m, aspect; /* mean height of the trees, and over their crowns' diameter */
};
bool wd_canopy_map_init(struct wd_canopy_map *map, struct wd_gpu *gpu);
void wd_canopy_map_finish(struct wd_canopy_map *map, struct wd_gpu *gpu);
bool wd_canopy_map_use_forest(struct wd_canopy_map *map, struct wd_gpu *gpu,
                              const struct wd_forest_device *forest,
                              const struct wd_view_trees *trees);
void wd_canopy_map_drop_forest(struct wd_canopy_map *map, struct wd_gpu *gpu);

/* Outside of any rendering, with the ground in the G-buffer; then inside the G-buffer's rendering,
 * before nearer trees. */
void wd_canopy_map_select(struct wd_canopy_map *map, const struct wd_tree_draw *draw,
                          const struct wd_view_trees *trees, float range_m, float fade);
void wd_canopy_map_draw(struct wd_canopy_map *map, const struct wd_tree_draw *draw);

#endif
