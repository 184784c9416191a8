/* leaf_template.h: one leaf, shoot or flower as triangles in its own frame: x across, y along its
 * axis, z above it, in units of its length. */
#ifndef WD_TREE_LEAF_TEMPLATE_H
#define WD_TREE_LEAF_TEMPLATE_H

#include <stddef.h>

#include "scene/species.h"
#include "shared/tree.h"
#include "tree/vec.h"

struct wd_leaf_corner {
    struct wd_vec3 p, n; /* n: unit, on the upper side */
    float u, v;          /* of the look */
    float stiff;         /* 0 at the foot .. 1 at the tip: how far it follows the wind */
    uint32_t kind;       /* WD_VERTEX_LEAF, with WD_VERTEX_FLOWER for petals */
};

struct wd_leaf_template {
    struct wd_leaf_corner *corners;
    uint32_t *indices;
    size_t corner_count, corner_capacity, index_count, index_capacity;
};

enum wd_leaf_form {
    WD_LEAF_AS_KITE,  /* two triangles; needle shoots: a comb or brush of thin ones */
    WD_LEAF_AS_BLADE, /* its outline, folded and curved; leaflets one by one */
    WD_LEAF_AS_NEAR,  /* the same with lobes and teeth; several times as many triangles */
};

/* Builds one of `WD_LEAF_VARIANTS` that differ in their random numbers. All forms have the same
 * area. */
enum { WD_LEAF_VARIANTS = 4 };
void wd_leaf_template_init(struct wd_leaf_template *leaf, const struct wd_species *species,
                           enum wd_leaf_form form, uint32_t variant);
/* A flower (of petals) or panicle of unit size that faces z; a kite of it has a few large parts. */
void wd_flower_template_init(struct wd_leaf_template *flower, const struct wd_species *species,
                             enum wd_leaf_form form);
void wd_leaf_template_finish(struct wd_leaf_template *leaf);

float wd_leaf_template_area(const struct wd_leaf_template *leaf);
/* Scales it about its foot until it has this area. */
void wd_leaf_template_scale(struct wd_leaf_template *leaf, float area);

#endif
