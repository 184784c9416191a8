/* raster.h: any GDAL raster, resampled to a grid in the terrain's local frame. */
#ifndef WD_WORLD_RASTER_H
#define WD_WORLD_RASTER_H

#include "world/terrain.h"

enum wd_resampling { WD_RESAMPLE_NEAREST, WD_RESAMPLE_LINEAR, WD_RESAMPLE_MAX };

/* width * height values, row 0 in the south, covering the terrain's extent: cell (i, j) covers
 * local [i, i+1) * cell_x_m by [j, j+1) * cell_y_m. NaN: no data. */
struct wd_raster {
    uint32_t width, height;
    double cell_x_m, cell_y_m;
    float *values;
};

/* Reads `map->file` (beside the scene file) over the terrain's extent, with its own resolution
 * (bounded by max_samples). A raster that does not overlap the terrain is an error. */
bool wd_raster_load(struct wd_raster *raster, const struct wd_scene *scene,
                    const struct wd_scene_map *map, const struct wd_terrain *terrain,
                    enum wd_resampling resampling, uint64_t max_samples, const struct wd_log *log);
void wd_raster_finish(struct wd_raster *raster);

/* Reprojects points from `from_crs` ("EPSG:n" or WKT) to the terrain's CRS, in place, x then y
 * (longitude then latitude for degrees). */
bool wd_reproject(const char *from_crs, const char *to_crs, double *x, double *y, size_t count,
                  const struct wd_log *log);
/* The same up to the first point that has no place there, which stays as it is and is not told of:
 * `*placed` of `count`. */
bool wd_reproject_some(const char *from_crs, const char *to_crs, double *x, double *y, size_t count,
                       size_t *placed, const struct wd_log *log);

/* Whether the coordinates of a system ("EPSG:n" or WKT) are metres, not degrees or feet. False with an
 * error that begins with `subject` where there is no such system. */
bool wd_crs_counts_metres(const char *crs, const char *subject, bool *metres, const struct wd_log *log);

#endif
