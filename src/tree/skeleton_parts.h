/* skeleton_parts.h: how the files that grow a skeleton add to it; for them only. */
#ifndef WD_TREE_SKELETON_PARTS_H
#define WD_TREE_SKELETON_PARTS_H

#include "tree/skeleton.h"

/* What a chain of nodes is grown by. */
struct wd_stem {
    int order, parent;
    size_t parent_node;
    struct wd_vec3 start, direction;
    float length_m, along_m;
    float upturn, tip_upturn, wander; /* radians per metre */
    int steps;
    uint32_t key;
};

void wd_skeleton_add_node(struct wd_skeleton *skeleton, struct wd_vec3 position,
                          struct wd_vec3 direction, float along_m);
/* Begins a branch: its nodes follow, then its count and length are to be set. */
struct wd_branch *wd_skeleton_add_branch(struct wd_skeleton *skeleton, const struct wd_stem *stem);

/* Share of the crown's length up to which there is a trunk: above, it has dissolved into limbs. */
float wd_tree_trunk_end(const struct wd_tree_form *form);

/* The trunk, or all stems of a shrub: branches of order WD_TRUNK, the first of the skeleton. */
void wd_skeleton_grow_stems(struct wd_skeleton *skeleton, const struct wd_tree_form *form);

#endif
