/* tile_noise.h: noise over the unit square that repeats without a seam. */
#ifndef WD_TREE_TILE_NOISE_H
#define WD_TREE_TILE_NOISE_H

#include <stdint.h>

/* Value noise of unit lattice spacing that repeats after the given lattice steps, 0..1. */
float wd_tile_noise(uint32_t key, float x, float y, int period_x, int period_y);

/* Four octaves over the unit square; `nx`, `ny`: lattice steps of the first. */
float wd_tile_fractal(uint32_t key, float u, float v, int nx, int ny);

/* Distance to the second nearest of jittered points on a tiled grid less that to the nearest: 0 on
 * the joints between plates. *which names the plate. */
float wd_tile_cells(uint32_t key, float x, float y, int nx, int ny, uint32_t *which);

/* The same plates where cells are `tall` times as tall as wide: distance to the nearest joint, in widths, so that
 * joints are as wide along plates as across them. */
float wd_tile_joint(uint32_t key, float x, float y, int nx, int ny, float tall, uint32_t *which);

#endif
