/* figures.h: the figures that `make bench` prints; each ends with a line NAME VALUE UNIT. */
#ifndef WD_BENCH_FIGURES_H
#define WD_BENCH_FIGURES_H

#include <stddef.h>

#include "weald/renderer.h"

/* `gpu` as in struct wd_renderer_params. Each prints what it measured and the last line; false on failure, which has been logged. */
bool bench_octree_speedup(const char *gpu);
bool bench_octree_frame(const char *gpu);
bool bench_place_million(const char *gpu);
bool bench_first_frame_warm(const char *gpu);
bool bench_first_frame_cold(const char *gpu);
bool bench_peak_memory(const char *gpu);
bool bench_grow(const char *gpu);
bool bench_grow_ratio(const char *gpu);
bool bench_lod_coverage(const char *gpu);
bool bench_lod_radiance(const char *gpu);
bool bench_bake_cold(const char *gpu);
bool bench_bake_warm(const char *gpu);
bool bench_bake_memory(const char *gpu);
bool bench_oak_memory(const char *gpu);
bool bench_reference_agreement(const char *gpu);
bool bench_reference_rays(const char *gpu);
bool bench_mean_colour(const char *gpu);
bool bench_reflectance(const char *gpu);
bool bench_stand_floor(const char *gpu);
bool bench_stand_light(const char *gpu);
bool bench_shadow_cost(const char *gpu);
bool bench_wind_cost(const char *gpu);
bool bench_continuum_frame(const char *gpu);
bool bench_continuum_vs_octree(const char *gpu);
bool bench_continuum_floor(const char *gpu);
bool bench_continuum_moving(const char *gpu);
bool bench_continuum_memory(const char *gpu);
bool bench_frame_times(const char *gpu);
bool bench_continuum_flip(const char *gpu);
bool bench_continuum_popping(const char *gpu);
bool bench_scale_ratio(const char *gpu);
bool bench_scale_memory(const char *gpu);
bool bench_scale_flight(const char *gpu);

/* Sorts and returns the middle one. */
double bench_median(double *values, size_t count);

double bench_now_s(void); /* of a clock that never goes back */
void bench_remove_directory(const char *path); /* with the files in it */

#endif
