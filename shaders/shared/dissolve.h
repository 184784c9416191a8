/* dissolve.h: leaves that thin out with distance, in shaders and on the CPU (rows W5, W6). */
#ifndef WD_SHARED_DISSOLVE_H
#define WD_SHARED_DISSOLVE_H

#include "shared/forest.h"

/* Of a vertex of a leaf. 16 bytes. */
struct wd_leaf_place {
    WD_VEC3(center_m); /* of its leaf, model space */
    float rank;        /* of its leaf in progressive order, 0..1: shown while below the kept share */
};
WD_STATIC_ASSERT_SIZE(wd_leaf_place, 16);

/* A tree whose leaves are drawn. */
struct wd_leafy_instance {
    uint32_t tree;
    float show;  /* as in wd_instance */
    float kept;  /* share of its leaves */
    float scale; /* of each leaf about its centre */
};

/* Push constants of one-view billboards. */
struct wd_one_view_push {
    uint32_t variants;
    float pixels_per_radian;
    uint32_t one_view; /* 1: every side of a tree shows the same picture */
};

#endif
