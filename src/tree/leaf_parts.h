/* leaf_parts.h: what leaves are put together from. */
#ifndef WD_TREE_LEAF_PARTS_H
#define WD_TREE_LEAF_PARTS_H

#include "tree/leaf_outline.h"
#include "tree/leaf_template.h"
#include "tree/random.h"

/* Where a blade is: its foot, unit axes, and size. `above` = across x along. */
struct wd_blade_place {
    struct wd_vec3 foot, across, along, above;
    float length, width;
    float stiff; /* of its foot; its tip is 1 */
};

/* A place that leaves `foot` along `along`, its upper side toward `up`. */
struct wd_blade_place wd_blade_place(struct wd_vec3 foot, struct wd_vec3 along, struct wd_vec3 up,
                                     float length, float width);

uint32_t wd_leaf_add_corner(struct wd_leaf_template *leaf, struct wd_vec3 p, struct wd_vec3 n,
                            float u, float v, float stiff);
void wd_leaf_add_triangle(struct wd_leaf_template *leaf, uint32_t a, uint32_t b, uint32_t c);

/* The outline as triangles, folded along the midrib, its tip bent down. */
void wd_leaf_add_blade(struct wd_leaf_template *leaf, const struct wd_leaf_outline *outline,
                       const struct wd_blade_place *place);
/* Two triangles with the outline's area. */
void wd_leaf_add_kite(struct wd_leaf_template *leaf, const struct wd_leaf_outline *outline,
                      const struct wd_blade_place *place);
/* A thin triangle with its tip at `to`. */
void wd_leaf_add_stalk(struct wd_leaf_template *leaf, struct wd_vec3 from, struct wd_vec3 to,
                       struct wd_vec3 across, float width);
/* A needle: a thin triangle. */
void wd_leaf_add_needle(struct wd_leaf_template *leaf, struct wd_vec3 foot,
                        struct wd_vec3 direction, struct wd_vec3 across, float length,
                        float width);

/* Compound leaves and blades that arch (leaf_compound.c). */
void wd_leaf_add_pinnate(struct wd_leaf_template *leaf, const struct wd_species *species,
                         const struct wd_leaf_outline *outline, enum wd_leaf_form form, uint32_t variant);
void wd_leaf_add_palmate(struct wd_leaf_template *leaf, const struct wd_species *species,
                         const struct wd_leaf_outline *outline);
void wd_leaf_add_arching_blade(struct wd_leaf_template *leaf, const struct wd_species *species);

/* Needle-bearing shoots as few triangles (leaf_needles.c). */
void wd_leaf_add_needles(struct wd_leaf_template *leaf, const struct wd_species *species,
                         uint32_t variant);

#endif
