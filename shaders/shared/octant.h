/* octant.h: what an octant, or a cell of a cluster, looks like from its six sides (rows G2, G4). */
#ifndef WD_SHARED_OCTANT_H
#define WD_SHARED_OCTANT_H

#include "shared/vec.h"

/* Sides: seen from east (+x), west, north (+y), south, above (+z), below. */
#define WD_OCTANT_SIDES 6

#ifdef __STDC_VERSION__
#define WD_OCTANT_LOOK struct wd_octant_look
#else
#define WD_OCTANT_LOOK wd_octant_look
#endif

/* 80 bytes. An empty side is 0. */
struct wd_octant_look {
    uint32_t color[WD_OCTANT_SIDES];  /* R in the low byte, G, B: sRGB albedo of what shows;
                                         A: root of the share of the side that it covers, as
                                         parts of a tree cover less than a byte could tell */
    uint32_t normal[WD_OCTANT_SIDES]; /* its mean normal * 0.5 + 0.5, world axes, shorter where they
                                         spread; A: sky openness */
    uint32_t leaf[2]; /* share of it that is leaf: bits 8 s .. of side s, four sides a word; in the
                         second word's bits 16..23: 128 times wd_octant_slant */
    uint32_t mixed[WD_OCTANT_SIDES]; /* its wood over its leaves, as shared/mixed.h packs it */
};
WD_STATIC_ASSERT_SIZE(wd_octant_look, 80);

WD_FUNC float wd_octant_coverage(uint32_t color)
{
    float root = WD_FLOAT(color >> 24) * (1.0f / 255.0f);
    return root * root;
}

/* What trees cover from half above, over the root of the mean square of what they cover seen level and
 * from above: 1 of an ellipsoid, 1.16 of a beech, whose crown lets through level rays. */
WD_FUNC float wd_octant_slant(WD_OCTANT_LOOK look)
{
    return WD_FLOAT((look.leaf[1] >> 16) & 0xffu) * (1.0f / 128.0f);
}

/* Opacity of wood in pictures of octants; that of leaves is 1, of nothing 0. */
#define WD_OCTANT_SHOWN 0.2

/* The frame of a picture from a side: right and up in it, toward the viewer. */
struct wd_octant_frame {
    WD_VECTOR right, up, toward;
};

WD_FUNC WD_STRUCT wd_octant_frame wd_octant_frame_of(uint32_t side)
{
    WD_STRUCT wd_octant_frame f;
    float sign = (side & 1u) == 0u ? 1.0f : -1.0f;
    f.toward = side < 2u ? WD_V3(sign, 0.0f, 0.0f)
               : side < 4u ? WD_V3(0.0f, sign, 0.0f)
                           : WD_V3(0.0f, 0.0f, sign);
    f.right = side < 2u ? WD_V3(0.0f, sign, 0.0f)
              : side < 4u ? WD_V3(-sign, 0.0f, 0.0f)
                          : WD_V3(1.0f, 0.0f, 0.0f);
    f.up = side < 4u ? WD_V3(0.0f, 0.0f, 1.0f) : WD_V3(0.0f, sign, 0.0f);
    return f;
}

/* A picture of a cube's slice from one side; slice 0 is the farthest from the viewer. 32 bytes. */
struct wd_octant_picture {
    int32_t corner_mm[3]; /* the cube's least */
    float size_m;
    uint32_t side;
    uint32_t slice, slices;
    uint32_t tile; /* of the atlas, row by row */
};
WD_STATIC_ASSERT_SIZE(wd_octant_picture, 32);

/* A tree in a picture. */
struct wd_octant_entry {
    uint32_t tree, picture;
};

struct wd_octant_push {
    uint32_t variants;
    uint32_t tile_pixels, tile_columns; /* the atlas is square */
    uint32_t first_entry;
};

#endif
