/* bake.h: what baking shaders share with the CPU. */
#ifndef WD_SHARED_BAKE_H
#define WD_SHARED_BAKE_H

#include "shared/types.h"

/* An orthographic picture: rows give x and y in samples (y down) and depth 0..1 (1 nearest the
 * viewer) of a model's point (x, y, z, 1). Beyond 0..1 nothing is drawn. */
struct wd_bake_shot {
    WD_VEC4(x);
    WD_VEC4(y);
    WD_VEC4(depth);
};
WD_STATIC_ASSERT_SIZE(wd_bake_shot, 48);

/* Samples of a triangle's bounding box from which on a workgroup draws it, and how many such
 * triangles a batch of pictures may have (a dispatch's least guaranteed limit). */
#define WD_BAKE_LARGE 512.0
#define WD_BAKE_LIST 65535

/* Push constants of the baking shaders. */
struct wd_bake_push {
    uint32_t first_index, triangle_count, first_triangle; /* first_triangle: of the mesh, drawn */
    uint32_t shot_count;       /* of this batch */
    uint32_t width, height;    /* texels */
    uint32_t samples;          /* a texel, along each side */
    uint32_t wood_triangles;   /* of the mesh: those from here on are leaves */
    uint32_t look_layer;       /* the species' first */
    uint32_t cut_out;          /* 1: texels of the look below WD_LOOK_CUT are holes */
};

/* What one sample remembers while triangles are drawn. The first two are one number of 64 bits to
 * bake_raster_once.comp. */
struct wd_bake_sample {
    uint32_t triangle; /* 1 + index of the one in front */
    uint32_t front;    /* bits of the greatest depth; 0 nothing */
    uint32_t back;     /* ~bits of the least depth, or 0 where depths are not wanted, */
    uint32_t sheets;   /* leaves on the ray, likewise */
};
WD_STATIC_ASSERT_SIZE(wd_bake_sample, 16);

#endif
