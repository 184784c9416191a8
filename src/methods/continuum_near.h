/* continuum_near.h: trees whose crowns are so near that their leaves are seen one by one. */
#ifndef WD_METHODS_CONTINUUM_NEAR_H
#define WD_METHODS_CONTINUUM_NEAR_H

#include "methods/tree_draw.h"

/* How far meshes reach: wd_near_reach_m. */
struct wd_near_rule {
    const float *grains; /* [model] */
    float leaves_m, reach;
    float farthest_m;    /* of any stored tree; 0: none is a mesh */
};

/* Fills `near` with the stored trees in the view of which wd_near_mesh leaves something. Looks at
 * those octants alone that are as near, so that it does not cost more where there are more trees. */
void wd_near_trees_select(struct wd_selection *near, const struct wd_tree_draw *draw,
                          const struct wd_near_rule *rule);

#endif
