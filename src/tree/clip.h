/* clip.h: the volume that a hedge is cut to, as a grid of bits. */
#ifndef WD_TREE_CLIP_H
#define WD_TREE_CLIP_H

#include "tree/grow.h"
#include "tree/vec.h"

enum { WD_CLIP_SIDE = 64 };

struct wd_clip_grid {
    float min_m[3], max_m[3];
    bool box; /* all of it: no bits are needed */
    float area_m2; /* of its projection on the ground */
    uint64_t columns[WD_CLIP_SIDE * WD_CLIP_SIDE]; /* bit k: the k-th cell from below is inside */
};

/* False, logged, where the volume is not closed, has no size, or holds broken numbers. */
bool wd_clip_grid_init(struct wd_clip_grid *grid, const struct wd_clip_volume *volume,
                       const struct wd_log *log);

bool wd_clip_inside(const struct wd_clip_grid *grid, struct wd_vec3 p);

#endif
