/* terrain.h: the ground as a regular grid of heights. */
#ifndef WD_WORLD_TERRAIN_H
#define WD_WORLD_TERRAIN_H

#include "scene/scene.h"

/* Sample (i, j) stands at local (i * cell_m, j * cell_m), i east, j north, row 0 in the south.
 * Local (0, 0) is `origin_m` in the terrain's projected coordinates. The surface between samples is
 * two flat triangles a cell, split along the diagonal from its south-west to its north-east corner:
 * the finest mesh drawn is this surface, so what stands on wd_terrain_height stands on the ground. */
struct wd_terrain {
    uint32_t width, height;  /* samples, at least 2 each */
    double cell_m;
    double origin_m[2];      /* projected coordinates of local (0, 0); 0, 0 for made-up terrain */
    float *height_m;         /* width * height, above the world's zero */
    uint8_t *hole;           /* per sample: 1 where the raster had no data and the rule is "cut";
                                NULL: no holes. Heights there are filled all the same */
    float *water_m;          /* per sample: height of water that a map shows (world/river.h); NULL */
    float min_m, max_m;
    char *crs;               /* WKT of the projected coordinates, or NULL */
    uint64_t filled_samples; /* samples without data that were filled */
    unsigned threads;       /* that it was made by; what is read over it is by as many */
};

/* Makes or reads the terrain that the scene asks for. Large rasters are read by window and
 * decimated: never more than `max_samples` (0: 2^25) samples are kept. The same for any number of threads
 * (0: one a processor). */
bool wd_terrain_init(struct wd_terrain *terrain, const struct wd_scene *scene, uint32_t seed,
                     uint64_t max_samples, unsigned threads, const struct wd_progress *progress,
                     const struct wd_log *log);
void wd_terrain_finish(struct wd_terrain *terrain);

double wd_terrain_extent_x_m(const struct wd_terrain *terrain);
double wd_terrain_extent_y_m(const struct wd_terrain *terrain);
/* Local metres; positions outside are clamped to the edge. */
float wd_terrain_height(const struct wd_terrain *terrain, double x_m, double y_m);
/* Where the walls of earth end that close the ground at its edges. */
float wd_terrain_foot_m(const struct wd_terrain *terrain);
/* Inside the extent and not in a hole. */
bool wd_terrain_contains(const struct wd_terrain *terrain, double x_m, double y_m);

#endif
