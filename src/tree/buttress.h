/* buttress.h: the outline of a stem between its buttress roots. */
#ifndef WD_TREE_BUTTRESS_H
#define WD_TREE_BUTTRESS_H

#include "tree/form.h"

/* Sides of a trunk's rings that show its buttresses, more than `most`; `most` where there are less than
 * three, where they have no height or where it does not allow them. */
int wd_buttress_sides(const struct wd_species *species, int most);

/* Place of vertex i of `sides` around a ring of the trunk, in stem radii along its two axes, at
 * height z: a circle above the buttresses, fins at the ground. */
void wd_buttress_outline(const struct wd_tree_form *form, float z_m, float radius_m, int sides,
                         int i, float place[2]);

#endif
