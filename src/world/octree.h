/* octree.h: loose and tight octants over the trees, in one structure (Guerrero 2006, row G1). */
#ifndef WD_WORLD_OCTREE_H
#define WD_WORLD_OCTREE_H

#include "base/log.h"
#include "shared/tree.h"

#include <stdbool.h>
#include <stddef.h>

/* Octants are stored depth-first. A tree lives in exactly one loose octant, chosen by its bounding
 * box's centre and extent (loose overlap 0.5), and trees are ordered by that: the range of an
 * octant holds its own trees first, then those of its descendants. The tight list of an octant
 * holds every tree of the same depth whose box touches the octant's own cube. No octant is empty. */
struct wd_octant {
    float min_m[3], max_m[3];       /* bounds of the trees in [begin, end): for culling */
    float cube_min_m[3], cube_size_m; /* the tight cube */
    uint32_t first_child, child_count; /* indices into octants; children are not adjacent in
                                          depth-first order: follow next_sibling */
    uint32_t next_sibling;          /* 0: none (the root is nobody's sibling) */
    uint32_t depth;                 /* the root's is 0 */
    uint32_t begin, own_end, end;   /* trees [begin, own_end) are its own, to `end` its subtree's */
    uint32_t tight_begin, tight_end; /* range of tight_trees */
};
struct wd_octree {
    struct wd_octant *octants;      /* octants[0] is the root */
    uint32_t count;
    uint32_t depth;                 /* greatest depth present */
    uint32_t *tight_trees;          /* indices of trees */
    uint32_t tight_count;
};

struct wd_octree_params {
    uint32_t max_depth;     /* 0: 8 */
    uint32_t leaf_trees;    /* an octant with fewer trees is not split; 0: 64 */
};
/* Orders trees[count] in place and builds the octree over them. count may be 0: then the octree is
 * empty ({0}). */
void wd_octree_init(struct wd_octree *octree, struct wd_tree *trees, size_t count,
                    const struct wd_octree_params *params);
void wd_octree_finish(struct wd_octree *octree);

/* A tree's bounding box in local metres. */
void wd_tree_bounds(const struct wd_tree *tree, float min_m[3], float max_m[3]);

/* From the origin to the nearest place of a box; 0 within. */
float wd_box_distance(const float min[3], const float max[3]);

#endif
