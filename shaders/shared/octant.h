/* octant.h: what an octant, or a cell of a cluster, looks like from its six sides (rows G2, G4). */
#ifndef WD_SHARED_OCTANT_H
#define WD_SHARED_OCTANT_H

#include "shared/types.h"

/* Sides: seen from east (+x), west, north (+y), south, above (+z), below. */
#define WD_OCTANT_SIDES 6

/* 48 bytes. An empty side is 0. */
struct wd_octant_look {
    uint32_t color[WD_OCTANT_SIDES];  /* R in the low byte, G, B: sRGB albedo of what shows; A: share
                                         of the side that it covers */
    uint32_t normal[WD_OCTANT_SIDES]; /* its mean normal * 0.5 + 0.5, world axes; A: sky openness */
};
WD_STATIC_ASSERT_SIZE(wd_octant_look, 48);

#endif
