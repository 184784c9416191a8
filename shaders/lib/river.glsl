/* Waters of a map on the device. Expects `frame`, WATER_AT(index) and wd_ground's grid of samples. */
#include "shared/grid.h"
#include "shared/river.h"

/* Height of the surface over the world's zero; local metres. */
float river_level(vec2 local_m)
{
    vec2 at = vec2(wd_grid_along(local_m.x / frame.terrain_cell_m, frame.terrain_width),
                   wd_grid_along(local_m.y / frame.terrain_cell_m, frame.terrain_height));
    uvec2 cell = uvec2(wd_grid_cell(at.x, frame.terrain_width), wd_grid_cell(at.y, frame.terrain_height));
    vec2 share = at - vec2(cell);
    uint south = cell.y * frame.terrain_width + cell.x, north = south + frame.terrain_width;
    return wd_river_between(WATER_AT(south), WATER_AT(south + 1u), WATER_AT(north),
                            WATER_AT(north + 1u), share.x, share.y);
}
