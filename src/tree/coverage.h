/* coverage.h: reduced meshes that cover as much of a picture as the full one. */
#ifndef WD_TREE_COVERAGE_H
#define WD_TREE_COVERAGE_H

#include "tree/leaf_set.h"
#include "tree/mesh.h"

/* Fills the areas that the mesh covers (bounds set), seen level (the mean of the sides that cards are
 * taken from), from half above and from above: wd_seen_m2. */
void wd_tree_mesh_measure_seen(float seen_m2[WD_GAIN_SIDES], const struct wd_tree_mesh *mesh);

/* Scales each leaf of `reduced` (triangles that share vertices are one) about its middle by one
 * factor, so that the mesh covers as much as `full` from the side and from half above, and before that
 * each part of a flower by another one, so that flowers do by themselves. Keeping their area alone does
 * not: fewer, larger ones overlap less. Flowers come after all else. Bounds of `full` are set; those of
 * `reduced` are updated. Fills the factors: 1 of what there is none of. */
void wd_tree_mesh_fit_coverage(struct wd_tree_mesh *reduced, const struct wd_tree_mesh *full,
                               float factors[WD_LEAF_SETS]);

#endif
