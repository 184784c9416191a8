/* terrain_patch.h: the tiles that the ground is drawn with: CDLOD (Strugar 2009).
 *
 * A patch is a grid of 8 x 8 cells, each 2^level terrain cells wide. A patch of level k is drawn
 * beyond range[k - 1] and morphs into level k + 1 before range[k] ends; see src/frame/passes/
 * terrain.c for why no cracks are left. */
#ifndef WD_SHARED_TERRAIN_PATCH_H
#define WD_SHARED_TERRAIN_PATCH_H

#include "shared/types.h"

#define WD_PATCH_CELLS 8
#define WD_TERRAIN_LEVELS 16

/* values of wd_terrain_patch.edge */
#define WD_EDGE_NONE 0
#define WD_EDGE_SOUTH 1 /* a curtain that hangs from that side of the patch */
#define WD_EDGE_EAST 2
#define WD_EDGE_NORTH 3
#define WD_EDGE_WEST 4
/* In the surface target, before the ground is shaded: this, and that value more. No tree has such a number. */
#define WD_GROUND_MARK 0xfffffff0u

struct wd_terrain_patch {
    uint32_t column, row; /* of its south-west sample */
    uint32_t level;
    uint32_t edge;
};
WD_STATIC_ASSERT_SIZE(wd_terrain_patch, 16);

/* How the ground lies about the camera. */
struct wd_terrain_view {
    int32_t camera_cell[2];     /* the camera stands over this cell, */
    WD_VEC2(camera_offset_m);   /* so far from its south-west sample */
    float cell_m;
    float above_m;              /* of the camera over the highest ground; 0 below */
    float curtain_m;            /* where curtains end, above the world's zero */
    uint32_t width, height;     /* samples */
    WD_VEC2(extent_m);
    WD_VEC2(slopes_scale);      /* slopes image: coordinates = metres * scale + offset */
    WD_VEC2(slopes_offset);
    WD_VEC2(cover_scale);       /* cover image: coordinates = metres * scale */
    WD_VEC2(camera_m);          /* local; for image coordinates only */
    float slopes_texel_m, cover_texel_m;
    float pixel_rad;            /* angle that a pixel spans, */
    float sample_rad;           /* and one of its samples, for what is small on the ground */
    WD_VEC2(morph[WD_TERRAIN_LEVELS]); /* distance at which morphing begins; 1 / its span */
};

#endif
