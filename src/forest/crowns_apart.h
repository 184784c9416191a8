/* crowns_apart.h: whether crowns keep apart, as planted ones do, or stand in groups. */
#ifndef WD_FOREST_CROWNS_APART_H
#define WD_FOREST_CROWNS_APART_H

#include "world/world.h"

/* Squares over a world, row by row from its south-western corner. */
struct wd_crown_grid {
    const float *outline; /* of each, what the outlines of its crowns cover of it, seen from above, together */
    uint32_t width, height;
    double cell_m;
    double from_m[2]; /* that corner */
};

/* Crowns that stand at random leave e^-a of the ground free where their outlines are a times as large as it.
 * For each square the factor on `a` with which that is what the world's stored crowns leave about there: over 1
 * where they keep apart, under 1 where they stand in groups. Herbs do not count. To be freed. */
float *wd_crowns_apart(const struct wd_world *world, const struct wd_crown_grid *grid);

/* The same of crowns that are planted with a least distance, of so many layers. */
float wd_planted_apart(float outline);

#endif
