/* river.h: waters that a map draws, each at the height that the ground about it asks for. */
#ifndef WD_WORLD_RIVER_H
#define WD_WORLD_RIVER_H

#include "world/raster.h"

/* Digs the bed of what scene->water.map shows into the terrain and fills terrain->water_m; without a
 * map nothing happens. Along a river the level follows the lowest shore: it never rises on the way
 * from its highest reach to its lowest place and never stands above its shores; a pond is level. */
bool wd_rivers_init(struct wd_terrain *terrain, const struct wd_scene *scene,
                    const struct wd_log *log);

/* Height of the water's surface about a place, WD_NO_WATER_M where there is none. On the ground beside
 * it the surface goes on for a few samples. */
float wd_river_level(const struct wd_terrain *terrain, double x_m, double y_m);
/* Whether the place lies under water that a map shows. */
bool wd_river_covers(const struct wd_terrain *terrain, double x_m, double y_m);

#endif
