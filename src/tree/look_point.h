/* look_point.h: one point of a look, before it is put into texels. */
#ifndef WD_TREE_LOOK_POINT_H
#define WD_TREE_LOOK_POINT_H

#include "scene/species.h"

struct wd_look_point {
    float albedo[3];  /* in proportion: the whole map is scaled to the wanted mean */
    float height_m;   /* of the relief */
    float roughness;
    float coverage;   /* share inside the outline, for an edge `soft` wide */
    float through;    /* light let through, in proportion */
};

struct wd_look_point wd_bark_point(const struct wd_species *species, float u, float v);
struct wd_look_point wd_leaf_point(const struct wd_species *species, float u, float v, float soft);
struct wd_look_point wd_flower_point(const struct wd_species *species, float u, float v,
                                     float soft);

#endif
