/* forest.h: the tables that tree shaders read: models, drawn instances, card geometry. */
#ifndef WD_SHARED_FOREST_H
#define WD_SHARED_FOREST_H

#include "shared/tree.h"

/* A model's cards: three upright through the trunk's axis, a third of a half turn apart, and one
 * level at CARD_TOP of the height (crossed billboards, Guerrero 2006, section 4; the level one
 * keeps crowns whole from above). */
#define WD_CARD_SIDES 3
#define WD_CARDS 4
#define WD_CARD_VERTICES 16  /* a tree */
#define WD_CARD_INDICES 24
#define WD_CARD_TOP 0.62
/* For the sun: one card turned to it and the level one. */
#define WD_SHADOW_CARD_VERTICES 8
#define WD_SHADOW_CARD_INDICES 12
/* Trees that one draw of cards may hold: the length of the index pattern. */
#define WD_CARD_BATCH 65536

#define WD_LEVEL_MESH 0
#define WD_LEVEL_REDUCED 1
#define WD_LEVEL_CARD 2

/* One grown individual of a species, as every method draws it. Lengths are the model's own. */
struct wd_model {
    float height_m;         /* a tree's height over this is its vertical scale */
    float crown_m;          /* a tree's crown diameter over this is its horizontal scale */
    float half_width_m;     /* of an upright card */
    float half_depth_m;     /* of the level card, both ways */
    float bottom_m, top_m;  /* of an upright card */
    float flexibility;      /* see shared/wind.h */
    uint32_t look_layer;    /* bark; the leaf's is the next */
    uint32_t card_layer;    /* of the first upright card; the level one is layer + 3 */
    WD_VEC3(transmittance); /* of a leaf over its albedo, linear */
    float crown_base_m;     /* height of the lowest living branch */
};

/* A tree drawn by itself. */
struct wd_instance {
    uint32_t tree;  /* index in octree order */
    float show;     /* noise below this shows: 1 whole, 0 nothing (G7) */
};

/* Push constants of every tree pipeline. */
struct wd_tree_push {
    uint32_t variants;  /* models a species: model = species * variants + variant */
    uint32_t cascade;   /* of a shadow pass */
    uint32_t level;     /* WD_LEVEL_* of what is drawn, for LOD colouring */
    float show;         /* for draws of ranges */
    uint32_t single;    /* 1 + tree to draw when it stands alone (separate); 0: by instance */
};

#endif
