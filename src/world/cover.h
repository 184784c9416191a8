/* cover.h: how much of the ground lies under crowns. */
#ifndef WD_WORLD_COVER_H
#define WD_WORLD_COVER_H

#include "world/world.h"

/* Fills world->cover, cover_width, cover_height and cover_cell_m from the trees of 1.5 m and
 * higher: cells of 4 m, or larger so that there are at most 4 million. Each cell is sampled at
 * 4 x 4 points; of layers on demand it holds the cover to be expected, of trees that stand at
 * random. */
void wd_cover_init(struct wd_world *world, unsigned threads);

#endif
