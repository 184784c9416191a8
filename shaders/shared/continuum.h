/* continuum.h: what the passes of the method `continuum` hand to each other.
 *
 *   clusters --cull--> visible clusters --select--> visible trees and splat items
 *            --splat--> visibility buffer --resolve--> G-buffer or cascade
 *
 * Where the camera has moved, trees that the frame before hid are put off: select and splat run again
 * for those of them that what is drawn by then does not hide.
 *
 * A tree is drawn as splats: discs of equal area sampled from its surface. Its count follows the
 * pixels it covers; any window of a stratum's splats is a fair sample of that part of the crown. */
#ifndef WD_SHARED_CONTINUUM_H
#define WD_SHARED_CONTINUUM_H

#include "shared/tree.h"

/* Splats a model, in strata of equal count: those of leaves from the crown's top down, then one of
 * wood. */
#define WD_SPLATS 65536u
#define WD_SPLAT_STRATA 8u
#define WD_STRATUM_SPLATS (WD_SPLATS / WD_SPLAT_STRATA)
/* Trees' windows begin at multiples of this: few places, which small trees read again and again. */
#define WD_WINDOW_STEP 128u
#define WD_LEAF_STRATA (WD_SPLAT_STRATA - 1u)
/* The stratum of wood: half of it of all wood; half without what the first triangles of wood show,
 * for trees that have these. */
#define WD_WOOD_SPLATS (WD_STRATUM_SPLATS / 2u)
/* Splats or triangles of one item, a workgroup's work. An id in the visibility buffer is
 * item * WD_ITEM_SPLATS + splat of the item + 1, with the highest bit for triangles of wood. */
#define WD_ITEM_SPLATS 512u
#define WD_ID_WOOD 0x80000000u
/* Trees of at most so many splats are the work of one thread, so that their data are read once and
 * not by every thread of a group. Their items are stored from the end of the list. */
#define WD_SMALL_SPLATS 96u
/* So many of these are sorted by a workgroup, and so many bits hold their splats; trees' indices have
 * the rest of 32. */
#define WD_SORT_ITEMS 256u
#define WD_SORT_BITS 7u

/* A splat: its place in the model's box (unorm 16) and its face (octahedral, snorm 8): of leaves the flat
 * upper side, of wood its normal. Of leaves the last two bits of x and y and the last four of z are the
 * way along the leaf (lib/splat.glsl). */
struct wd_splat {
    uint32_t xy;       /* x in the low half */
    uint32_t z_normal; /* z in the low half, face above */
};
WD_STATIC_ASSERT_SIZE(wd_splat, 8);

/* What a splat looks like, in 32 bits: R, G, B in 5 each, exp2(value * step + least) of them the linear
 * albedo; 1 that says wood; sky openness in 4; the normal that it is shaded with, as its face, in 6 and
 * 6 with signs. Colours and openness are dithered: they are right on average. */
#define WD_SPLAT_ALBEDO_MOST 31.0f
#define WD_SPLAT_ALBEDO_LEAST -8.0f
#define WD_SPLAT_ALBEDO_STEP (8.0f / 31.0f)
#define WD_SPLAT_WOOD_BIT 15u
#define WD_SPLAT_OPENNESS_BIT 16u
#define WD_SPLAT_OPENNESS_MOST 15.0f
#define WD_SPLAT_NORMAL_BIT 20u
#define WD_SPLAT_NORMAL_MOST 31.0f

#ifdef __STDC_VERSION__
#define WD_SPLAT_STRUCT struct wd_splat
#else
#define WD_SPLAT_STRUCT wd_splat
#endif

/* A corner of triangles of bark. These follow the corners of their model, WD_WOOD_TRIANGLES of them in the
 * room of one: 63 bits each, that say thrice in 21 how far before the first triangle a corner lies. */
struct wd_splat_corner {
    WD_SPLAT_STRUCT at;
    uint32_t uv;   /* two half floats */
    uint32_t tint; /* RGB: square roots of factors of the bark's texture; A: openness */
};
WD_STATIC_ASSERT_SIZE(wd_splat_corner, 16);
#define WD_WOOD_TRIANGLES 2u
#define WD_WOOD_BITS 21u

struct wd_splat_model {
    WD_GAINS_STRUCT wood, leaf; /* what keeps the mesh's coverage */
    WD_GAINS_STRUCT light;      /* and the openness of what is seen, by which leaves are lit, */
    WD_GAINS_STRUCT wood_light; /* and of wood alone */
    WD_VEC3(min_m);
    WD_VEC3(extent_m);
    float leaf_area_m2, wood_area_m2;     /* of the surface that the splats stand for */
    float strata_top_m[WD_SPLAT_STRATA];  /* height below which a stratum's splats lie */
    WD_VEC3(lower_over_upper);            /* albedo of leaves' lower sides over that of upper ones */
    float lower[WD_GAIN_SIDES];           /* share of the leaves seen that show the lower side */
    float wood_falls;                     /* power of n with which what the first n triangles leave of the bark falls */
    float grain;                          /* root of a mean triangle's area over the crown's width,
                                             times `finer` */
    float finer;                          /* 1 .. 4: plants of few triangles are drawn as if they
                                             were so many times as near */
    uint32_t wood_first;                  /* place of the first triangle among all corners */
    uint32_t wood_count, wood_corners;    /* triangles: of the stem, of its likeness for small trees, and all others; of
                                             each those that show most first */
    uint32_t wood_stem, wood_far_stem;    /* so many of the former two; 0: the stem is among the others */
    float leaf_past_bark;                 /* factor on leaves' gains where these are all the wood */
    float thin_share;                     /* of the bark that is seen: what the first wd_first_wood triangles do not show */
    float thin_wood;                      /* factor on the gains of discs of wood that stand for as much */
    float bare_thin;                      /* of trees without leaves: the same beside all triangles; 0 of others */
};
WD_STATIC_ASSERT_SIZE(wd_splat_model, 712);
/* Its words, to be fetched one by one. */
#define WD_SPLAT_MODEL_WORDS 178u
#define WD_WORD_WOOD_GAINS 0u
#define WD_WORD_LEAF_GAINS 36u
#define WD_WORD_LIGHT_GAINS 72u
#define WD_WORD_WOOD_LIGHT_GAINS 108u
#define WD_WORD_MIN_M 144u
#define WD_WORD_EXTENT_M 147u
#define WD_WORD_LEAF_AREA_M2 150u
#define WD_WORD_WOOD_AREA_M2 151u
#define WD_WORD_STRATA_TOP_M 152u
#define WD_WORD_LOWER_OVER_UPPER 160u
#define WD_WORD_LOWER 163u
#define WD_WORD_WOOD_FALLS 166u
#define WD_WORD_GRAIN 167u
#define WD_WORD_FINER 168u
#define WD_WORD_WOOD_FIRST 169u
#define WD_WORD_WOOD_COUNT 170u
#define WD_WORD_WOOD_STEM 172u
#define WD_WORD_WOOD_FAR_STEM 173u
#define WD_WORD_LEAF_PAST_BARK 174u
#define WD_WORD_THIN_SHARE 175u
#define WD_WORD_THIN_WOOD 176u
#define WD_WORD_BARE_THIN 177u

/* Trees that are culled together: at most WD_CLUSTER_TREES, next to each other in octree order. */
#define WD_CLUSTER_TREES 64u
#define WD_CLUSTER_BITS 6u
/* Where trees cover fewer pixels than this, fewer of them stand for all, wider than they are: more lit tops. */
#define WD_LEAST_TREE_PX 4.0
/* Height of a tree that covers so many: its square's fifth. */
#define WD_WHOLE_TREE_PX 4.4721360f
struct wd_cluster {
    int32_t min_mm[3], max_mm[3]; /* bounds of its trees */
    uint32_t first;
    uint32_t count; /* bits 0..6: trees. Bit 7: of a page: all WD_CLUSTER_TREES records count, those
                       without a tree have size 0; a tree stands for 4^level (bits 8..12); what
                       view.typical_m is, in cm, in bits 16..31 */
};
WD_STATIC_ASSERT_SIZE(wd_cluster, 32);
#define WD_CLUSTERS_A_PAGE 16u
#define WD_CLUSTER_PAGED 0x80u
#define WD_CLUSTER_OF_PAGE(trees, level, grain_cm)                                                \
    ((trees) | WD_CLUSTER_PAGED | ((level) << 8) | ((grain_cm) << 16))
#define WD_CLUSTER_COUNT(cluster) ((cluster).count & 0x7fu)
#define WD_CLUSTER_LEVEL(cluster) (((cluster).count >> 8) & 0x1fu)
#define WD_CLUSTER_GRAIN_M(cluster) (WD_FLOAT((cluster).count >> 16) * 0.01f)

/* Crowns nearer than a distance are drawn leaf by leaf, up to this many times it also: from there
 * leaves come in by noise while all splats stand, then the splats thin out. */
#define WD_NEAR_REACH 1.25f

/* So many of the triangles of wood that small trees have are the first: some of the far stem's, whose share of the
 * bark is known. */
WD_FUNC uint32_t wd_first_wood(uint32_t count)
{
    return count / 2u < 38u ? count / 2u : 38u;
}

/* From the eye to a crown, taken for an upright cylinder. `foot` of the tree, as seen from the eye;
 * `base`: height of its lowest living branch over its own. */
WD_FUNC float wd_near_distance_m(WD_STRUCT wd_tree tree, float base, WD_VECTOR foot)
{
    float height_m = WD_TREE_HEIGHT_M(tree);
    float above_m = foot.z + base * height_m, below_m = -foot.z - height_m;
    float beside_m = WD_SQRT(foot.x * foot.x + foot.y * foot.y) - 0.5f * WD_TREE_CROWN_M(tree);
    float up_m = WD_MAX(WD_MAX(above_m, below_m), 0.0f), side_m = WD_MAX(beside_m, 0.0f);
    return WD_SQRT(up_m * up_m + side_m * side_m);
}

/* Distance up to which a tree is drawn leaf by leaf. */
WD_FUNC float wd_near_reach_m(WD_STRUCT wd_tree tree, float grain, float leaves_m, float grains)
{
    return WD_MAX(leaves_m, grain * WD_TREE_CROWN_M(tree) * grains);
}

/* Shares that show of a tree's mesh and of its splats: together all of its leaves. Were both whole where they meet, a
 * crown would cover up to a sixth more there. */
WD_FUNC float wd_near_splats(float distance_m, float near_m)
{
    return WD_CLAMP((distance_m - near_m) / ((WD_NEAR_REACH - 1.0f) * near_m), 0.0f, 1.0f);
}

WD_FUNC float wd_near_mesh(float distance_m, float near_m)
{
    return 1.0f - wd_near_splats(distance_m, near_m);
}

/* Of the splats' triangles of wood, large ones first: stems are whole before the mesh's go. */
WD_FUNC float wd_near_wood(float splats)
{
    return WD_MIN(2.0f * splats, 1.0f);
}

/* Levels of the depth pyramid. A texel of level l holds the farthest depth of a square of 2^(l + 1)
 * pixels; rows of a level follow each other, levels begin at pyramid_first. */
#define WD_PYRAMID_LEVELS 7

#define WD_SPLAT_PLANES 12
#define WD_SPLAT_SIDES 8

/* One view of a frame. */
struct wd_splat_view {
    WD_MAT4(clip_from_rel);
    WD_VEC4(planes[WD_SPLAT_PLANES]); /* see struct wd_frustum */
    uint32_t plane_count;
    uint32_t calm;           /* 1: trees stand as the mean wind bends them */
    float pixels;            /* of a metre at w = 1 */
    float near_m;
    float typical_m;         /* height of a tree, to tell how many a far cluster needs */
    uint32_t width, height;
    uint32_t texels;         /* of the target for one of the view's pixels, each way */
    float density;           /* splats a pixel that a tree covers */
    float detail;            /* level of detail is chosen as if the picture had so many times its pixels
                                each way: what the error bound asks for */
    uint32_t min_splats;     /* of a tree */
    float near_leaves_m;     /* crowns as near are drawn leaf by leaf */
    float near_grains;       /* or within so many times their grain; both 0: none */
    float wood_px;           /* trees taller than about this have triangles of wood */
    uint32_t cluster_count, variants;
    uint32_t page_count;     /* their clusters follow the others */
    WD_VEC2(slopes_scale);   /* slopes image: coordinates = rel * scale + offset */
    WD_VEC2(slopes_offset);
    float slopes_texel_m;
    uint32_t tree_capacity, item_capacity;
    /* What the frame before saw, to leave out what it hid. 0: nothing is known. */
    uint32_t has_history;
    uint32_t moved;              /* what it hid may be seen by now: it is put off */
    uint32_t still;              /* the camera has not turned since either */
    uint32_t put_off_words;      /* masks of 32 trees each that are put off, two a cluster; then their
                                    list */
    WD_MAT4(history_from_rel);   /* clip coordinates then of what is at rel now */
    WD_VEC4(slice[WD_SPLAT_SIDES]); /* of a cascade: a, b, c of sides in clip coordinates, within which lies
                                       what may shade anything that the camera sees; 0: none */
    uint32_t cascade_records;    /* of a cluster of stored trees, that cascades draw: all, unless the world has
                                    more trees than a view can hold; */
    float cascade_whole_m;       /* and all that are this tall */
    uint32_t pyramid_first[WD_PYRAMID_LEVELS];
};

struct wd_splat_counts {
    uint32_t clusters, trees, items, small_items, wood_items;
    uint32_t put_off;                             /* words of masks */
    uint32_t done_items, done_small, done_wood;   /* that are in the visibility buffer already */
};
/* What found no room there, of the view in which that was most. */
struct wd_splat_lost {
    uint32_t trees, items;
};
/* Indirect dispatches that follow from them. */
struct wd_splat_groups {
    uint32_t select[3], splat[3], small[3], all_splats[3], wood[3], sort[3];
};

/* A visible tree, ready to be splatted. Rows give clip coordinates of a place in the model's box,
 * (x, y, z in 0..1, 1); `sway` is added times z squared. */
struct wd_splat_tree {
    WD_VEC4(clip_x); WD_VEC4(clip_y); WD_VEC4(clip_w); /* clip_w: w, or z of a cascade */
    WD_VEC3(sway);
    float radius;          /* of a disc of leaves, in pixels at w = 1, */
    WD_VEC3(facing);       /* dot normal of the model: what a m^2 of it shows the eye, in m^2 */
    float wood_radius;     /* and of one of wood that faces the eye */
    uint32_t tree;         /* in octree order */
    uint32_t first_splat;  /* of the model */
    uint32_t offset;       /* bits 0..12: of the window in each stratum; 16..23: WD_TREE_UPPER; 24: all are
                              twigs; bit 31: of wood, from its second half */
    uint32_t strata;       /* bits 0..3: of how many it has splats; 4..7: WD_DISC_CLOSE, in fifteenths;
                              8..10: the first of them; 11: the last is that of wood; 12..31: the layer
                              of its bark among looks */
    uint32_t first_wood;   /* of the model: wood_first */
    uint32_t turn;         /* cosine and sine of the tree's yaw, half floats */
    uint32_t shape;        /* 1 or -1 mirrored, vertical over horizontal scale, half floats */
    uint32_t tint;         /* half of each factor of the leaves' colour and of openness, unorm 8 */
    uint32_t lower;        /* a fourth of each factor of the colour of lower sides, and half of that of the light
                              of wood, unorm 8 */
    uint32_t sun, eye;     /* wd_sun_mix of where they are, seen from the model */
    float nearer_m;        /* discs that nothing of the tree hides are drawn so much nearer */
};
WD_STATIC_ASSERT_SIZE(wd_splat_tree, 128);
#define WD_SPLAT_TREE_TEXELS 8
#define WD_TREE_STRATA(tree) ((tree).strata & 0xfu)
#define WD_TREE_CLOSE(tree) (WD_FLOAT((tree).strata >> 4 & 0xfu) * (1.0f / 15.0f))
#define WD_TREE_FIRST_STRATUM(tree) ((tree).strata >> 8 & 0x7u)
/* Factor on the area of discs that show their upper side. */
#define WD_TREE_UPPER(tree) (WD_FLOAT((tree).offset >> 16 & 0xffu) * (1.0f / 255.0f))
#define WD_TREE_TWIGS(tree) (((tree).offset >> 24 & 1u) != 0u)
#define WD_TREE_WOOD_LAST(tree) ((tree).strata >> 11 & 1u)
#define WD_TREE_BARK(tree) ((tree).strata >> 12)
#define WD_TREE_WOOD_HALF(tree) ((tree).offset >> 31)
/* And the other way: `offset` and `strata` of such parts, whole numbers that fit. */
#define WD_TREE_OFFSET_OF(window, upper, twigs, wood_half)                                         \
    ((window) | (upper) << 16 | (twigs) << 24 | (wood_half) << 31)
#define WD_TREE_STRATA_OF(count, close, first, wood_last, bark)                                    \
    ((count) | (close) << 4 | (first) << 8 | (wood_last) << 11 | (bark) << 12)

/* Large triangles of wood are drawn by a group for each part of so many pixels of their bounds; as many parts as
 * find room, all other triangles by a thread. */
#define WD_LARGE_PART_PX 1024u
#define WD_LARGE_MOST 65535u
struct wd_large_part {
    uint32_t id, part;
};

struct wd_cascade_push {
    uint32_t layer;     /* of the maps */
    uint32_t has_drawn; /* 1: meshes have been drawn there, too */
};

/* Splats of its strata in turn, or triangles of its wood. */
struct wd_splat_item {
    uint32_t tree;  /* index of a wd_splat_tree */
    uint32_t parts; /* bits 0..9: their count, WD_ITEM_SPLATS at most; 10..31: the first */
};
WD_STATIC_ASSERT_SIZE(wd_splat_item, 8);
#define WD_ITEM_FIRST(item) ((item).parts >> 10)
#define WD_ITEM_COUNT(item) ((item).parts & 0x3ffu)
#define WD_ITEM_PARTS(first, count) ((count) | (first) << 10)

#endif
