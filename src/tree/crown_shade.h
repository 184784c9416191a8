/* crown_shade.h: the ellipsoid of leaves whose shade on the ground is nearest to a tree's own. */
#ifndef WD_TREE_CROWN_SHADE_H
#define WD_TREE_CROWN_SHADE_H

#include "tree/mesh.h"

/* In it light falls off with the way that it has come (Guerrero 2006, section 5). It may reach into the ground and beyond
 * the tree's top: crowns are not ellipsoids, and what counts is what of the sky they leave to the ground about them. */
struct wd_crown_shade {
    float radius_m, half_m; /* half its width and half its height */
    float middle_m;         /* height of its middle over the foot */
    float per_m;            /* extinction; 0: the tree has no shade */
};

/* Fits it to a tree's mesh, whose bounds are set: shares of the sky that reach level ground, for rings of the sky
 * (shared/sky_rings.h) and distances from the foot. */
struct wd_crown_shade wd_crown_shade_of(const struct wd_tree_mesh *mesh);

/* What such a crown leaves of a ring of the sky, mean over all sides, to a place so far from its axis, `over_m` over the
 * foot. */
double wd_crown_shade_leaves(const struct wd_crown_shade *shade, int ring, double away_m, double over_m);

#endif
