/* crown_shade.h: the ellipsoid of leaves whose shade on the ground is nearest to a tree's own. */
#ifndef WD_TREE_CROWN_SHADE_H
#define WD_TREE_CROWN_SHADE_H

#include "tree/mesh.h"

/* In it light falls off with the way that it has come (Guerrero 2006, section 5). It may reach into the ground and
 * beyond the tree's top: crowns are not ellipsoids, and what counts is what of the sky they leave to the ground about
 * them. */
struct wd_crown_shade {
    float radius_m, half_m; /* half its width and half its height */
    float middle_m;         /* height of its middle over the foot */
    float per_m;            /* extinction, of ways with a sine of WD_SHADE_SINE; 0: the tree has no shade */
    float steeper;          /* change of ln(extinction) by a way's sine; positive where leaves lie flat */
};

/* Fits it to a tree's mesh, whose bounds are set: to pictures of what lies before six rings of the sky
 * (shared/sky_rings.h). */
struct wd_crown_shade wd_crown_shade_of(const struct wd_tree_mesh *mesh);

/* Share of light that comes to a place from a direction, a unit vector; both in the tree's own frame, metres.
 * Both radii are over 0. */
double wd_crown_shade_transmittance(const struct wd_crown_shade *shade, struct wd_vec3 from, struct wd_vec3 toward);

#endif
