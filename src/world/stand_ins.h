/* stand_ins.h: trees that are drawn as another species, since they are young or have grown in the open. */
#ifndef WD_WORLD_STAND_INS_H
#define WD_WORLD_STAND_INS_H

#include "world/placement.h"
#include "world/tree_tags.h"

/* First, trees of species that have others for the young (wd_species.when_young) become these where they are lower than
 * the lowest variants of their own, WD_HALF_GROWN of the typical height.
 *
 * Then trees of species that have others for the open (wd_species.in_the_open) become these where neighbours leave them
 * light from the sides, with crowns as wide as these have. The light is a share: of twelve sectors about the tree the mean
 * of what the steepest top in each leaves free, all where it stands 31 degrees over the tree's middle and less, nothing
 * from 58 degrees on. Forest inventories count a crown's free sides so (crown light exposure: USDA Forest Service, FIA
 * phase 3 field guide, crowns). A tree becomes the next species where its share is nearer to that one's openness than to
 * its own.
 *
 * Crowns that an inventory has measured (`tags`) stay as wide, and those of the first `inventory_end` trees that no
 * inventory has stay as they are. The same for any number of threads. False when the caller wants to stop. */
bool wd_trees_stand_in(struct wd_tree_list *list, size_t inventory_end, const struct wd_tree_tags *tags,
                       const struct wd_placement_params *params);

#endif
