/* leaf_view.h: single leaves of trees near by, on the CPU. */
#ifndef WD_METHODS_LEAF_VIEW_H
#define WD_METHODS_LEAF_VIEW_H

#include "methods/tree_draw.h"
#include "shared/tree_pose.h"

/* A tree as it stands in a view. */
struct wd_stand {
    float foot[3]; /* rel */
    struct wd_tree_pose pose;
};
struct wd_stand wd_stand_of(const struct wd_tree_draw *draw, uint32_t tree);

/* Where a place in the model is, without wind: rel. */
void wd_stand_place(const struct wd_stand *stand, struct wd_vec3 in_tree, float at[3]);

/* Which of the first `count` leaves of a tree's full mesh the view may show: their numbers in the set,
 * in order, go to `list`, which has room for all. Returns how many. */
uint32_t wd_leaves_in_view(const struct wd_tree_draw *draw, uint32_t tree,
                           const struct wd_leaf_draw *set, uint32_t count, uint32_t *list);

#endif
