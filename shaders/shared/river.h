/* river.h: water whose height differs from place to place. */
#ifndef WD_SHARED_RIVER_H
#define WD_SHARED_RIVER_H

#include "shared/vec.h"

#define WD_NO_WATER_M -1e9f /* as a height: no water */

/* Height between four samples; none where one of them has none. */
WD_FUNC float wd_river_between(float south_west, float south_east, float north_west,
                               float north_east, float east, float north)
{
    float least = WD_MIN(WD_MIN(south_west, south_east), WD_MIN(north_west, north_east));
    float south = south_west + (south_east - south_west) * east;
    float level = south + (north_west + (north_east - north_west) * east - south) * north;
    return least < 0.5f * WD_NO_WATER_M ? WD_NO_WATER_M : level;
}

/* Part of the way along a ray that ends under water at which it meets the surface. Heights are over
 * the ray's beginning: where it ends, and the surface over that end or over the last guess. */
WD_FUNC float wd_river_share(float end_m, float surface_m)
{
    return WD_CLAMP(surface_m / WD_MIN(end_m, -1e-6f), 0.0f, 1.0f);
}

#endif
