/* raster_none.c: stands in for all that needs GDAL, in a build without it. */
#include "base/log.h"
#include "world/raster.h"
#include "world/terrain_parts.h"

static bool refuse(const char *what, const struct wd_log *log)
{
    return wd_error(log, "%s: this build has no GDAL (meson option gdal), which reads rasters and "
                         "reprojects coordinates", what);
}

bool wd_terrain_read_raster(struct wd_terrain *terrain, const struct wd_scene *scene,
                            uint64_t max_samples, const struct wd_progress *progress,
                            const struct wd_log *log)
{
    (void)terrain;
    (void)max_samples;
    (void)progress;
    return refuse(scene->terrain.file ? scene->terrain.file : "terrain.file", log);
}

char *wd_crs_wkt_in_metres(const char *crs, const struct wd_log *log)
{
    refuse(crs, log);
    return NULL;
}

char *wd_crs_in_metres_at(const char *crs, double x, double y, const char *subject,
                          const struct wd_log *log)
{
    (void)subject;
    (void)x;
    (void)y;
    refuse(crs, log);
    return NULL;
}

bool wd_raster_load(struct wd_raster *raster, const struct wd_scene *scene,
                    const struct wd_scene_map *map, const struct wd_terrain *terrain,
                    enum wd_resampling resampling, uint64_t max_samples, const struct wd_log *log)
{
    (void)scene;
    (void)terrain;
    (void)resampling;
    (void)max_samples;
    *raster = (struct wd_raster){0};
    return refuse(map->file ? map->file : "map.file", log);
}

bool wd_crs_counts_metres(const char *crs, const char *subject, bool *metres, const struct wd_log *log)
{
    (void)subject;
    *metres = false;
    return refuse(crs, log);
}

bool wd_reproject_some(const char *from_crs, const char *to_crs, double *x, double *y, size_t count,
                       size_t *placed, const struct wd_log *log)
{
    *placed = 0;
    return wd_reproject(from_crs, to_crs, x, y, count, log);
}

bool wd_reproject(const char *from_crs, const char *to_crs, double *x, double *y, size_t count,
                  const struct wd_log *log)
{
    (void)to_crs;
    (void)x;
    (void)y;
    (void)count;
    return refuse(from_crs, log);
}
