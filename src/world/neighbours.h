/* neighbours.h: which trees have grown in the open, told by those about them. */
#ifndef WD_WORLD_NEIGHBOURS_H
#define WD_WORLD_NEIGHBOURS_H

#include "world/placement.h"
#include "world/tree_tags.h"

/* Trees of species that have others for the open (wd_species.in_the_open) become these where neighbours leave them light
 * from the sides, with the variants and crown widths of these; crowns that an inventory has measured (`tags`) stay as
 * wide, and those of the first `inventory_end` trees that no inventory has stay as they are.
 *
 * The light is a share: of twelve sectors about the tree the mean of what the steepest top in each leaves free, all
 * where it stands 31 degrees over the tree's middle and less, nothing from 58 degrees on. Forest inventories count a
 * crown's free sides so (crown light exposure: USDA Forest Service, FIA phase 3 field guide, crowns). A tree becomes the next
 * species where its share is nearer to that one's openness than to its own.
 *
 * The same for any number of threads. False when the caller wants to stop. */
bool wd_trees_in_the_open(struct wd_tree_list *list, size_t inventory_end, const struct wd_tree_tags *tags,
                          const struct wd_placement_params *params);

#endif
