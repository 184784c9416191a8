/* cover.h: how much of the ground lies under crowns. */
#ifndef WD_WORLD_COVER_H
#define WD_WORLD_COVER_H

#include "world/world.h"

enum {
    WD_CANOPY_CM = 150,   /* lower plants are herbs and seedlings: no canopy over the ground */
    WD_SWARD_LAYER = 64,  /* of world->sward: once over the ground */
};

/* Fills world->cover, cover_width, cover_height and cover_cell_m from the trees of 1.5 m and
 * higher: cells of 4 m, or larger so that there are at most 4 million. Each cell is sampled at
 * 4 x 4 points; of layers on demand it holds the cover to be expected, of trees that stand at
 * random. world->sward holds the layers of lower plants. */
void wd_cover_init(struct wd_world *world, unsigned threads);

/* Cover at a place, 0..1, and its mean 14 m to the east, west, north and south of the place, which
 * tells a forest from a single tree. */
float wd_cover_at(const struct wd_world *world, double x_m, double y_m);
float wd_woods_at(const struct wd_world *world, double x_m, double y_m);

/* world->cover or world->sward between its cells' middles. */
float wd_cover_grid_at(const struct wd_world *world, const uint8_t *grid, double x_m, double y_m);

/* The lower of two neighbours on a grid of `count` and the share of the upper, clamped. */
uint32_t wd_grid_place(double at, uint32_t count, float *share);

#endif
