/* buttress.h: the outline of a stem where its roots leave it: buttresses, or lobes of the root flare. */
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

/* Lobes lie on some of so many places around a stem, where a foot of as many sides, or twice as many, has corners. */
enum { WD_MOST_LOBES = 7, WD_LOBE_PLACES = 16 };

/* Ridges that run down a grown stem into its roots. */
struct wd_root_lobes {
    float strength; /* 0: the flare is round */
    float dbh_m;
    int count;
    float turn[WD_MOST_LOBES];                       /* where they lie around the stem */
    float low[WD_MOST_LOBES], high[WD_MOST_LOBES];   /* how far they stand out at the ground, and above */
};

/* How a ring at some height differs from the round stem, in its radii: `flare` all around, `low` and
 * `high` times what wd_root_lobes_at says of a place around it. */
struct wd_root_shape {
    float flare, low, high;
};

/* Of a tree with one stem, by its key: none on palms, young and thin stems and between buttresses. */
struct wd_root_lobes wd_root_lobes_of(const struct wd_tree_form *form, float dbh_m);

/* How far lobes stand out at a place around the stem, at the ground and above: before the mean is taken off. */
void wd_root_lobes_at(const struct wd_root_lobes *lobes, float turn, float *low, float *high);

/* At height z above the ground. */
struct wd_root_shape wd_root_shape_at(const struct wd_root_lobes *lobes, const struct wd_tree_form *form,
                                      float z_m);

#endif
