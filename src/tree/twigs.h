/* twigs.h: the thinnest twigs of a crown without leaves, and the feet of a fern's fronds. */
#ifndef WD_TREE_TWIGS_H
#define WD_TREE_TWIGS_H

#include "tree/foliage.h"

/* The first of foliage's places for twigs, a share of them, each as one shoot, or as three that fork. */
struct wd_twig_style {
    float share;
    int shoots;
    float width_m; /* at the foot */
};

/* Appends them as wood, three triangles a shoot. */
void wd_twigs_mesh(struct wd_tree_mesh *mesh, const struct wd_foliage *foliage,
                   const struct wd_tree_form *form, const struct wd_twig_style *style);

/* Appends the stipes of a fern's fronds as far up as brown scales hide their green: wood, three
 * triangles each. Other plants have none. */
void wd_stipes_mesh(struct wd_tree_mesh *mesh, const struct wd_foliage *foliage,
                    const struct wd_tree_form *form);

#endif
