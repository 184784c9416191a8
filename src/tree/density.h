/* density.h: leaf area on a coarse grid of cubes: how crowded a place is and what sky it sees. */
#ifndef WD_TREE_DENSITY_H
#define WD_TREE_DENSITY_H

#include <stdbool.h>
#include <stddef.h>

#include "tree/vec.h"

struct wd_tree_density {
    struct wd_vec3 origin_m;
    float cell_m;
    int size[3];
    float *area;  /* leaf area density, m^2 per m^3, one a cell */
    float *sky;   /* share of the sky seen from the cell, set by wd_tree_density_light */
};

/* An empty grid over the box. */
void wd_tree_density_init(struct wd_tree_density *density, struct wd_vec3 low_m,
                          struct wd_vec3 high_m, float cell_m);
void wd_tree_density_finish(struct wd_tree_density *density);

void wd_tree_density_clear(struct wd_tree_density *density); /* no leaves anywhere */

/* Spreads `area_m2` over the eight cells around p; nothing outside the box. */
void wd_tree_density_add(struct wd_tree_density *density, struct wd_vec3 p, float area_m2);

/* Density at p, linear between the middles of cells; 0 outside. */
float wd_tree_density_at(const struct wd_tree_density *density, struct wd_vec3 p);

/* Averages with the neighbours along each axis, weights 1 2 1. */
void wd_tree_density_blur(struct wd_tree_density *density);

/* Fills `sky`: light from nine directions through the leaves (Beer's law with the extinction 0.5
 * of leaves turned all ways), brighter overhead. */
void wd_tree_density_light(struct wd_tree_density *density);
float wd_tree_density_sky(const struct wd_tree_density *density, struct wd_vec3 p);

/* Away from the leaves: minus the density's gradient, of unit length; {0} where it is flat. */
struct wd_vec3 wd_tree_density_outward(const struct wd_tree_density *density, struct wd_vec3 p);

#endif
