/* bake.h: what baking shaders share with the CPU. */
#ifndef WD_SHARED_BAKE_H
#define WD_SHARED_BAKE_H

#include "shared/vec.h"

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

/* Up to so many texels a triangle looks alike all over. */
#define WD_BAKE_FLAT_TEXELS 2.0

/* Samples of a texel along each side: of large triangles they are bits of two words. */
#define WD_BAKE_SAMPLES_MAX 8

/* Push constants of the baking shaders. */
struct wd_bake_push {
    WD_STRUCT wd_bake_shot shot;
    uint32_t shot_index;       /* of this batch */
    uint32_t triangle_count, first_triangle; /* first_triangle: of the mesh, drawn */
    uint32_t width, height;    /* texels */
    uint32_t samples;          /* a texel, along each side */
    uint32_t wood_triangles;   /* of the mesh: those from here on are leaves */
    uint32_t look_layer;       /* the species' first */
    uint32_t leaf_sums;        /* after the texels of the batch: four words a shot, of what its leaves show of linear
                                  colour and openness, in WD_BAKE_LEAF_STEPS of a texel that is nothing else */
};
WD_STATIC_ASSERT_SIZE(wd_bake_push, 84);
#define WD_BAKE_LEAF_STEPS 8192.0

/* What one sample remembers while triangles are drawn: one number of 64 bits to
 * bake_raster_once.comp. */
struct wd_bake_sample {
    uint32_t seen;  /* WD_BAKE_SEEN of the triangle in front; 0 nothing */
    uint32_t front; /* bits of the greatest depth */
};
WD_STATIC_ASSERT_SIZE(wd_bake_sample, 8);

/* `turned`: 1 seen from behind; `alike`: 1 where its wd_bake_flat says what it shows. */
#define WD_BAKE_SEEN(triangle, turned, alike) (((triangle) + 1u) << 2 | (alike) << 1 | (turned))
#define WD_BAKE_TRIANGLE(seen) (((seen) >> 2) - 1u)
#define WD_BAKE_IS_FLAT(seen) (((seen) & 2u) != 0u)
#define WD_BAKE_IS_TURNED(seen) (((seen) & 1u) != 0u)

/* And, where depths are wanted, */
struct wd_bake_ray {
    uint32_t back;   /* ~bits of the least depth */
    uint32_t sheets; /* leaves on the ray */
};
WD_STATIC_ASSERT_SIZE(wd_bake_ray, 8);

/* The mean of what a triangle shows: linear colour as half floats, from before R, G in `before` and B in
 * the low half of `blues`, from behind likewise; `around`: normal * 0.5 + 0.5 and sky openness, a
 * byte each. */
struct wd_bake_flat {
    uint32_t before, behind, blues, around;
};
WD_STATIC_ASSERT_SIZE(wd_bake_flat, 16);

#endif
