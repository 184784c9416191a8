/* foliage.h: where leaves and needle shoots sit, how they are turned, and their meshes. */
#ifndef WD_TREE_FOLIAGE_H
#define WD_TREE_FOLIAGE_H

#include "tree/leaf_set.h"
#include "tree/skeleton.h"

struct wd_leaf {
    struct wd_vec3 position_m; /* of its base */
    struct wd_vec3 axis;       /* unit, base to tip */
    struct wd_vec3 normal;     /* unit, square to the axis: the upper side */
    struct wd_vec3 shading;    /* unit: how the crown faces the light here */
    float size_m;              /* length of the leaf or shoot */
    float flexibility;
    float tint[3];
    float sky;
    uint32_t key;
};

/* Leaves in progressive order: any prefix is a fair sample, spread over the crown as the whole. */
struct wd_foliage {
    struct wd_leaf *leaves;
    size_t count;
    size_t twig_count; /* without leaves: of `leaves`, where bare twigs stand in their stead */
    struct wd_leaf *flowers; /* places of flowers: leaves that they stand before, or would */
    size_t flower_count;
    struct wd_tree_density crown; /* leaf area, with its light swept */
    float area_m2;
    uint32_t sprig_triangles; /* of a drawn leaf that stands for many, at most, */
    uint32_t all_sprig_triangles; /* or more where these are not used up */
};

void wd_foliage_grow(struct wd_foliage *foliage, const struct wd_skeleton *skeleton,
                     const struct wd_tree_form *form);
void wd_foliage_finish(struct wd_foliage *foliage);

/* Brings places and sizes to another size. */
void wd_foliage_scale(struct wd_foliage *foliage, float factor);

/* Area of one leaf or shoot of unit length as drawn, one side. */
float wd_leaf_unit_area(const struct wd_species *species);

/* Drawn leaves that stand for at least so many are sprigs (leaf_sprig.h). */
#define WD_SPRIG_FROM 2.25f

/* Root of the mean of the drawn leaves' squared lengths. */
float wd_foliage_mean_m(const struct wd_foliage *foliage);

/* How far a drawn leaf reaches along its axis, in lengths. */
float wd_foliage_reach(const struct wd_foliage *foliage, const struct wd_species *species);

/* Triangles of a leaf or shoot where there are too many for outlines: 1 or more. */
size_t wd_leaf_least_triangles(const struct wd_species *species);

/* Packs the leaves, then the flowers: foliage->count + foliage->flower_count of them. */
void wd_foliage_pack(struct wd_tree_leaf *leaves, struct wd_leaf_box *box,
                     const struct wd_foliage *foliage, const struct wd_species *species);

/* Every leaf and flower as drawn near. */
void wd_foliage_sets(struct wd_leaf_set sets[WD_LEAF_SETS], const struct wd_foliage *foliage,
                     const struct wd_species *species);

/* The first `count` leaves as plain kites or sprigs of two triangles that together have the area of
 * all, and flowers of few triangles; fronds keep their form. */
void wd_foliage_sets_reduced(struct wd_leaf_set sets[WD_LEAF_SETS],
                             const struct wd_foliage *foliage, const struct wd_species *species,
                             size_t count);

#endif
