/* clip.h: the volume that a hedge is cut to, as a grid of bits. */
#ifndef WD_TREE_CLIP_H
#define WD_TREE_CLIP_H

#include "tree/grow.h"
#include "tree/vec.h"

enum { WD_CLIP_SIDE = 64 };

/* A box of that width (along x), depth and height around the foot, a little off the ground. */
struct wd_clip_volume wd_clip_box(const float size_m[3]);

struct wd_clip_grid {
    float min_m[3], max_m[3];
    bool box; /* all of it: no bits are needed */
    float area_m2; /* of its projection on the ground */
    float shell_m2; /* of its sides and top, about */
    uint64_t columns[WD_CLIP_SIDE * WD_CLIP_SIDE]; /* bit k: the k-th cell from below is inside */
};

/* False, logged, where the volume is not closed, has no size, or holds broken numbers. */
bool wd_clip_grid_init(struct wd_clip_grid *grid, const struct wd_clip_volume *volume,
                       const struct wd_log *log);

bool wd_clip_inside(const struct wd_clip_grid *grid, struct wd_vec3 p);

/* Whether the outside is within `reach_m` along one of the axes, but for downward. */
bool wd_clip_near_shell(const struct wd_clip_grid *grid, struct wd_vec3 p, float reach_m);

#endif
