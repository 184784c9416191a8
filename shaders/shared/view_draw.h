/* view_draw.h: trees drawn by their view sets (methods views and zfield). */
#ifndef WD_SHARED_VIEW_DRAW_H
#define WD_SHARED_VIEW_DRAW_H

#include "shared/forest.h"
#include "shared/view_set.h"

struct wd_view_push {
    WD_STRUCT wd_view_atlas atlas;
    uint32_t variants;       /* models a species */
    uint32_t baked_variants; /* of them, that have pictures */
    float pixels_per_radian;
    uint32_t nearest;        /* 1: the nearest view alone, else the three around */
    uint32_t refine;         /* times that depth is looked up again where it was found */
    float range_m;           /* trees are gone beyond it; 0: it has no end */
    float fade;              /* over this last share of the range they go */
};

#endif
