/* shoreline.h: where on a map of waters their shores lie, finer than samples of the terrain. */
#ifndef WD_WORLD_SHORELINE_H
#define WD_WORLD_SHORELINE_H

#include "world/raster.h"

/* Shares of water of a map's cells, row 0 in the south. */
struct wd_shoreline {
    uint32_t width, height;
    double cell_x_m, cell_y_m;
    float *share;
    float lowest, highest; /* values of the map */
};

bool wd_shoreline_init(struct wd_shoreline *shoreline, const struct wd_scene *scene,
                       const struct wd_terrain *terrain, const struct wd_log *log);
void wd_shoreline_finish(struct wd_shoreline *shoreline);
/* Share of water about a place, which varies smoothly between the map's cells: half and more is water. */
float wd_shoreline_share(const struct wd_shoreline *shoreline, double x_m, double y_m);
/* Way to the nearest shore; `farthest_m` where none is nearer. */
float wd_shoreline_way_m(const struct wd_shoreline *shoreline, double x_m, double y_m, double farthest_m);

#endif
