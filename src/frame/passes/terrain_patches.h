/* terrain_patches.h: which tiles of which size show the ground (CDLOD, Strugar 2009). */
#ifndef WD_FRAME_PASSES_TERRAIN_PATCHES_H
#define WD_FRAME_PASSES_TERRAIN_PATCHES_H

#include "forest/ground.h"
#include "frame/view.h"

struct wd_patch_list {
    struct wd_terrain_patch *items; /* near ones first */
    size_t count, capacity;
    size_t detailed; /* so many at the beginning are near enough for what is strewn on the ground */
};
void wd_patch_list_finish(struct wd_patch_list *list);

/* Distances from the camera at which levels end and begin to morph, and where the camera is over
 * the grid. `range_m[k]` is where level k ends. */
struct wd_patch_ranges {
    float range_m[WD_TERRAIN_LEVELS];
    double above_m; /* of the camera over the highest ground */
};
void wd_patch_ranges_init(struct wd_patch_ranges *ranges, const struct wd_ground *ground,
                          const struct wd_view *view, float error_px);

/* Replaces the list by the patches that `view` sees, with curtains round the terrain's edge. */
void wd_patches_select(struct wd_patch_list *list, const struct wd_patch_ranges *ranges,
                       const struct wd_ground *ground, const struct wd_view *view);

/* What the shaders need to know besides the patches. */
void wd_terrain_view_init(struct wd_terrain_view *out, const struct wd_patch_ranges *ranges,
                          const struct wd_ground *ground, const struct wd_view *view);

#endif
