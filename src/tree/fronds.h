/* fronds.h: leaves of plants without branches: palms, ferns, grasses. */
#ifndef WD_TREE_FRONDS_H
#define WD_TREE_FRONDS_H

#include "tree/foliage.h"

/* Whether leaves grow from the stem's top or foot in their real size, not on twigs. */
bool wd_species_has_fronds(const struct wd_species *species);

/* Sets the leaves, their sizes in metres, directions and area; the crown's light is filled. */
void wd_fronds_place(struct wd_foliage *foliage, const struct wd_skeleton *skeleton,
                     const struct wd_tree_form *form);

#endif
