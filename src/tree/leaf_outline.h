/* leaf_outline.h: outlines and veins of leaf blades. */
#ifndef WD_TREE_LEAF_OUTLINE_H
#define WD_TREE_LEAF_OUTLINE_H

#include "scene/species.h"
#include "tree/vec.h"

enum wd_leaf_veins { WD_VEINS_PINNATE, WD_VEINS_PALMATE, WD_VEINS_PARALLEL };

enum { WD_OUTLINE_POINTS = 14 };

/* The right half of a blade of unit length and unit half width: from the foot on the midrib, the
 * points, to the tip at (0, 1). The left half mirrors it. */
struct wd_leaf_outline {
    float foot;                           /* where the stalk meets the blade */
    float points[WD_OUTLINE_POINTS][2];   /* x across, y along */
    int count;
    float fold;                           /* edges above the midrib, share of their distance */
    float curl;                           /* tip below the plane of the foot */
    int veins;                            /* enum wd_leaf_veins */
    float vein_pairs;
    float vein_rise;                      /* side veins: rise along the blade for its half width */
};

const struct wd_leaf_outline *wd_leaf_outline_of(const struct wd_species *species);

/* The same blade with its lobes, teeth and curves, for leaves that are seen from near. */
const struct wd_leaf_outline *wd_leaf_outline_near(const struct wd_species *species);

/* Corner i of the right half: 0 the foot, then the points, then the tip; z is 0. */
struct wd_vec3 wd_leaf_outline_corner(const struct wd_leaf_outline *shape, int i);

/* Size of one blade: of the leaf without its stalk, or of the longest leaflet. */
struct wd_leaf_size {
    float length_m, width_m;
};
struct wd_leaf_size wd_leaf_blade_size(const struct wd_species *species);

/* Area of the flat blade over length times width. */
float wd_leaf_outline_area(const struct wd_leaf_outline *shape);

/* Where along it the blade is widest. */
float wd_leaf_outline_widest(const struct wd_leaf_outline *shape);

/* Distance of (x, y) from the outline, negative outside; `width` is the whole blade's over its
 * length, distances are in blade lengths. */
float wd_leaf_outline_inside(const struct wd_leaf_outline *shape, float width, float x, float y);

#endif
