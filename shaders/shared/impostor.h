/* impostor.h: octants and cells of clusters as sprites and cubes of six colours (rows G2 to G4). */
#ifndef WD_SHARED_IMPOSTOR_H
#define WD_SHARED_IMPOSTOR_H

#include "shared/octant.h"
#include "shared/types.h"

#define WD_SPRITE_VERTICES 4 /* one quad that faces the eye */
#define WD_CUBE_VERTICES 12  /* the three sides that do */

struct wd_impostor {
    WD_VEC3(min_m); /* least corner of what of the cube trees fill, local frame */
    WD_VEC3(size_m);
    uint32_t first_tree, tree_count; /* octree order: the trees it stands for */
    WD_OCTANT_LOOK look; /* shares of the sides of that box */
};
WD_STATIC_ASSERT_SIZE(wd_impostor, 112);

struct wd_impostor_push {
    uint32_t first;  /* impostor of vertex 0, where they are not listed */
    uint32_t listed; /* 1: the list says which */
    uint32_t cubes;  /* 1: cubes, 0: sprites */
    float pixels_per_radian;
};

#endif
