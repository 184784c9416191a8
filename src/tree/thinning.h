/* thinning.h: how large the leaves that stay have to be where the others are left out. */
#ifndef WD_TREE_THINNING_H
#define WD_TREE_THINNING_H

#include "tree/grow.h"

/* Fills model->leaf_growth: factors on a leaf's length besides the one that keeps all leaves' area,
 * with which the first leaf_count >> k of each level's leaves cover as much as those of the full mesh,
 * from each of the sides. Few large leaves hide one another less where the way through the crown is
 * long: with one factor for all sides they cover too much from above. The meshes have their leaves. */
void wd_tree_thinning_fit(struct wd_tree_model *model);

#endif
