/* wood.h: tubes around a skeleton. */
#ifndef WD_TREE_WOOD_H
#define WD_TREE_WOOD_H

#include "tree/mesh.h"
#include "tree/skeleton.h"

struct wd_wood_style {
    float least_radius_m; /* branches thinner than this at their base are left out */
    int node_step;        /* 1: a ring at every node; n: at every n-th and at the ends */
    int most_sides;       /* of the trunk; thinner branches have fewer, down to 3 */
    int foot_sides;       /* of a trunk's foot with root lobes: 32 or 16; with fewer the flare is round */
};

/* Appends the wood; of a mesh that has none yet, a stem with root lobes first. `crown` gives the sky openness of each
 * place (its light already swept). */
void wd_wood_mesh(struct wd_tree_mesh *mesh, const struct wd_skeleton *skeleton,
                  const struct wd_tree_form *form, const struct wd_tree_density *crown,
                  const struct wd_wood_style *style);

/* Leaves out the thinnest branches until the rest has no more than `triangles`. Stems are never left
 * out: where they alone are too much they get fewer sides and rings. */
void wd_wood_style_fit(struct wd_wood_style *style, const struct wd_skeleton *skeleton,
                       const struct wd_tree_form *form, size_t triangles);

#endif
