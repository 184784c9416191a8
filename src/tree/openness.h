/* openness.h: how much of the sky lights a tree's leaves and wood, checked against its own mesh. */
#ifndef WD_TREE_OPENNESS_H
#define WD_TREE_OPENNESS_H

#include "tree/grow.h"

/* Brings the openness that vertices and leaves carry (upper byte of the tint), which takes leaves as
 * spread evenly within a cube of the grid, to what the full mesh, with its leaves as triangles, lets
 * through. Nothing changes where there are no leaves. */
void wd_tree_model_fit_openness(struct wd_tree_model *model);

#endif
