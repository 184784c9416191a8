/* terrain_parts.h: the makers of terrain, for terrain.c; grids of heights with gaps. */
#ifndef WD_WORLD_TERRAIN_PARTS_H
#define WD_WORLD_TERRAIN_PARTS_H

#include "world/terrain.h"

#define WD_TERRAIN_DEFAULT_MAX_SAMPLES (UINT64_C(1) << 25)

/* Each fills width, height, cell_m, origin_m, crs, height_m, hole and filled_samples; terrain.c
 * does the rest. On failure terrain.c finishes what they leave. */
bool wd_terrain_make_fractal(struct wd_terrain *terrain, const struct wd_scene_terrain *wanted,
                             uint32_t seed, uint64_t max_samples,
                             const struct wd_progress *progress, const struct wd_log *log);
bool wd_terrain_read_raster(struct wd_terrain *terrain, const struct wd_scene *scene,
                            uint64_t max_samples, const struct wd_progress *progress,
                            const struct wd_log *log);

/* The CRS as WKT (free() it), or NULL with an error: not known, or not in metres. */
char *wd_crs_wkt_in_metres(const char *crs, const struct wd_log *log);
/* The CRS itself if it is in metres, else the UTM zone of a place in it (free() it); or NULL with an
 * error, which begins with `subject`. */
char *wd_crs_in_metres_at(const char *crs, double x, double y, const char *subject,
                          const struct wd_log *log);

/* Carves a winding valley along the y axis into heights that span 0..1; `strength` 0..1. */
void wd_terrain_carve_valley(struct wd_terrain *terrain, double strength, uint32_t seed);

/* Replaces every NaN of a width * height grid by a smooth continuation of its surroundings, never
 * above or below all of them. Returns how many there were; a grid of NaN only stays as it is. */
uint64_t wd_fill_missing(float *values, uint32_t width, uint32_t height);

/* Catmull-Rom between the samples of a grid without NaN, clamped to the 16 samples around, so that
 * nothing overshoots into pits. Column u, row v; outside is clamped; exact at samples. */
float wd_sample_smooth(const float *values, uint32_t width, uint32_t height, double u, double v);

#endif
