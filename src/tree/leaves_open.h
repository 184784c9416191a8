/* leaves_open.h: how much of the sky its tree leaves open to each leaf. */
#ifndef WD_TREE_LEAVES_OPEN_H
#define WD_TREE_LEAVES_OPEN_H

#include "shared/sun_ways.h"
#include "tree/grow.h"
#include "tree/points.h"

/* A way of an even sky or even ground, and what it brings to what faces it, over what all bring to level
 * ground. */
struct wd_sky_way {
    struct wd_vec3 toward;
    float brings;
};

/* Appends a place on each leaf and flower of the full mesh, which has its leaves as triangles, and places all over a few
 * of them. */
void wd_leaves_open_add(struct wd_tree_points *points, const struct wd_tree_model *model);

/* Tells model->leaves which ways are open to them, and how open they are by these, where the points from `first` on are
 * those of wd_leaves_open_add with what is lit of them. To be called once. */
void wd_leaves_open_set(struct wd_tree_model *model, const struct wd_tree_points *points, size_t first,
                        const struct wd_sky_way sky[WD_SUN_WAYS]);

#endif
