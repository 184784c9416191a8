/* packed_trees.h: the corners and steps of blocks of trees (shaders/shared/packed_tree.h). */
#ifndef WD_WORLD_PACKED_TREES_H
#define WD_WORLD_PACKED_TREES_H

#include "shared/packed_tree.h"

#include <stdbool.h>
#include <stddef.h>

/* Whether records can tell so many models apart. */
bool wd_packed_models_fit(size_t species, uint32_t variants);

/* The block of trees that stand in a box, with the finest steps that span it. `variants`: of a
 * species, at most 256. */
struct wd_tree_block wd_tree_block_in(const int64_t least_mm[3], const int64_t most_mm[3],
                                      uint32_t variants);

/* Records and heads that so many trees take. */
size_t wd_packed_count(size_t trees);
/* Packs all of them, in their order, into packed[wd_packed_count(count)]. */
void wd_trees_pack(struct wd_packed_tree *packed, const struct wd_tree *trees, size_t count,
                   uint32_t variants);

#endif
