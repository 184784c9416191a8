/* forest.h: the tables that tree shaders read: models, drawn instances, card geometry. */
#ifndef WD_SHARED_FOREST_H
#define WD_SHARED_FOREST_H

#include "shared/packed_tree.h"
#include "shared/sunlit.h"

#ifdef __STDC_VERSION__
#define WD_FADE_STRUCT struct wd_layer_fade
#else
#define WD_FADE_STRUCT wd_layer_fade
#endif

/* A model's cards: three upright through the trunk's axis, a third of a half turn apart, and one
 * level in the middle of the crown (crossed billboards, Guerrero 2006, section 4; the level one
 * keeps crowns whole from above). */
#define WD_CARD_WIDTH_TEXELS 128 /* of the finest mip */
#define WD_CARD_HEIGHT_TEXELS 256
/* Pictures of plants that are wider than high lie on their side, what is up to the left: texels are to be as fine
 * across as up. */
#define WD_CARD_LIES(half_width_m, bottom_m, top_m) (2.0f * (half_width_m) > (top_m) - (bottom_m))
/* Normals and openness are kept from this mip on: colour and holes alone show finer ones. */
#define WD_CARD_NORMAL_MIP 1
/* The coarsest, 8 x 16 texels: of fewer, chance has too little to choose from, and trees of 8 pixels
 * were covered up to 10 % wrong. */
#define WD_CARD_LAST_MIP 4
#define WD_CARD_SIDES 3
#define WD_CARDS 4
/* Drawn are the two upright ones that face the viewer most (the third is edge on, its share is 0
 * before it could be seen to go) and the level one. */
#define WD_CARD_VERTICES 12  /* a tree */
#define WD_UPRIGHT_VERTICES 8
#define WD_LEVEL_CARD_SINE 0.25 /* of the angle above or below, at which the level card begins */
/* For the sun: one card that faces it. */
#define WD_SHADOW_CARD_VERTICES 4
/* Trees that one draw of cards may hold at most. */
#define WD_CARD_BATCH 131072

#define WD_LEVEL_MESH 0
#define WD_LEVEL_REDUCED 1
#define WD_LEVEL_CARD 2

/* Look texels with less alpha than this are holes; mips keep the share of texels that pass. */
#define WD_LOOK_CUT 0.5

/* One grown individual of a species, as every method draws it. Lengths are the model's own. */
struct wd_model {
    float height_m;         /* a tree's height over this is its vertical scale */
    float crown_m;          /* a tree's crown diameter over this is its horizontal scale */
    float half_width_m;     /* of an upright card */
    float half_depth_m;     /* of the level card, both ways */
    float bottom_m, top_m;  /* of an upright card */
    float flexibility;      /* see shared/wind.h */
    uint32_t look_layer;    /* the first of WD_LOOK_LAYERS */
    uint32_t card_layer;    /* of the first upright card; the level one is layer + 3 */
    WD_VEC3(transmittance); /* of a leaf over its albedo, linear */
    float crown_base_m;     /* height of the lowest living branch */
    float roughness;        /* of leaves, the root of GGX's alpha; minus that of a sward's blades */
    float moss;             /* share of the stem's foot that moss covers */
    float fall_mps;         /* speed of leaves on their way down; 0: they hang */
    float phase;            /* how far the individual is ahead in the season: -1..1 */
    WD_VEC3(behind);        /* factors on the leaves' colour of trees that are late in the season */
    WD_VEC3(ahead);         /* or early */
    WD_GROWTHS_STRUCT full_growth;    /* of the full mesh's leaves */
    WD_GROWTHS_STRUCT reduced_growth; /* and of the reduced one's */
    WD_VEC3(seen_m2); /* that the whole tree covers, seen from the sides of wd_seen_m2 */
    uint32_t wood_seen[2]; /* share of wood in what eyes see above the lowest living branch: a byte for each ring of
                              shared/sunlit.h, the lowest first */
    uint32_t stem_seen[2]; /* likewise, of wood below that branch in what they see of all */
    uint32_t mixed;        /* wood over leaves in its cards, as shared/mixed.h packs it; not known before they are made */
};

/* Area that a tree covers seen from elevation asin(sine), squared, of what it covers level, from half above
 * and from above, squared. An ellipsoid's squares go with the sine's; so do those of crowns seen from the
 * lower half, while from the upper half what they cover beyond an ellipsoid goes with sine and cosine. */
WD_FUNC float wd_seen_squared(float level, float half_above, float above, float sine)
{
    float low = 2.0f * sine * sine;
    if (low < 1.0f)
        return level + (half_above - level) * low;
    float cosine = WD_SQRT(1.0f - WD_MIN(sine * sine, 1.0f));
    return cosine * cosine * level + sine * sine * above
           + cosine * sine * (2.0f * half_above - level - above);
}

WD_FUNC float wd_seen_m2(float level, float half_above, float above, float sine)
{
    return WD_SQRT(wd_seen_squared(level * level, half_above * half_above, above * above, sine));
}

/* 0 up to begin, 1 from end on, linear between. */
WD_FUNC float wd_ramp(float begin, float end, float x)
{
    float t = end > begin ? (x - begin) / (end - begin) : (x >= end ? 1.0f : 0.0f);
    return t < 0.0f ? 0.0f : (t > 1.0f ? 1.0f : t);
}

/* How trees of one layer come and go with distance (I7); 0 at both ends: they do not. */
struct wd_layer_fade {
    float near_begin_m, near_end_m; /* hidden nearer than begin, whole beyond end */
    float far_begin_m, far_end_m;   /* whole nearer than begin, hidden beyond end */
};

WD_FUNC float wd_layer_show(WD_FADE_STRUCT fade, float distance_m)
{
    float show = 1.0f;
    if (fade.near_end_m > 0.0f)
        show *= wd_ramp(fade.near_begin_m, fade.near_end_m, distance_m);
    if (fade.far_end_m > 0.0f)
        show *= 1.0f - wd_ramp(fade.far_begin_m, fade.far_end_m, distance_m);
    return show;
}

/* A tree drawn by itself. */
struct wd_instance {
    uint32_t tree;  /* index in octree order */
    float show;     /* noise below this shows: 1 whole, 0 nothing (G7) */
};

/* A leaf drawn as the twig that it stands for. */
struct wd_spray_instance {
    uint32_t tree; /* index in octree order */
    uint32_t leaf; /* of its model's wd_tree_leaf */
};

/* Push constants of every tree pipeline. */
struct wd_tree_push {
    uint32_t variants;  /* models a species: model = species * variants + variant */
    uint32_t cascade;   /* of a shadow pass */
    uint32_t level;     /* WD_LEVEL_* of what is drawn, for LOD colouring */
    float show;         /* for draws of ranges */
    float pixels_per_radian; /* of the camera */
    uint32_t card_vertices;  /* a tree: WD_CARD_VERTICES, or WD_UPRIGHT_VERTICES where all are seen
                                so level that the third card shows nothing */
    float spray_reach;       /* of wd_spray_share; 0: no leaf is drawn as a twig */
    float leaf_m;            /* length of the mesh's leaves, on sprigs of each */
    uint32_t leaf_count;     /* of them, in progressive order; 0: all are drawn at any distance */
    float leaf_most;         /* of wd_leaf_stand */
};

/* Push constants of pipelines that draw meshes: those of all, then of wood the box of its vertices,
 * of leaves that of their places and the set that is drawn (src/forest/meshes.h). */
struct wd_mesh_push {
    WD_STRUCT wd_tree_push tree;
    WD_STRUCT wd_leaf_box box; /* of wood `feet` alone is read */
    float own, arch_least, arch_range; /* as in struct wd_leaf_set */
    uint32_t first_leaf, first_corner;
    uint32_t corner_count, forms; /* corners of each form */
    uint32_t corner_bits;         /* a vertex's number: leaf << corner_bits | corner */
    uint32_t first_name;          /* of the triangles' random numbers */
};

/* Push constants of twigs. */
struct wd_spray_push {
    WD_STRUCT wd_tree_push tree;
    WD_STRUCT wd_leaf_box leaves;
    WD_STRUCT wd_mesh_box twig; /* in units of the leaf's size */
};

/* Leaves in progressive order thin out with distance, and those that stay grow so that their area
 * does (stochastic simplification: Cook et al. 2007; W5): what a tree costs follows the pixels that
 * it covers. Leaves this long on screen, and longer ones, are all drawn. */
#define WD_LEAF_WHOLE_PX 3.0f
#define WD_LEAF_LEAST_SHARE 0.02f

/* Share of the leaves drawn where one is `leaf_px` long. */
WD_FUNC float wd_leaf_share(float leaf_px)
{
    float t = leaf_px / WD_LEAF_WHOLE_PX, share = t * t;
    return share > 1.0f ? 1.0f : (share < WD_LEAF_LEAST_SHARE ? WD_LEAF_LEAST_SHARE : share);
}

/* The same, of which no more than `most` are ever drawn of a tree as wide as its model; this one is `across`
 * times as wide. */
WD_FUNC float wd_leaf_stand(float leaf_px, float most, float across)
{
    return WD_MIN(wd_leaf_share(leaf_px), WD_MAX(most * across * across, WD_LEAF_LEAST_SHARE));
}

#endif
