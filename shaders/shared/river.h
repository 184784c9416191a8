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
 * the ray's beginning: where it ends, and the surface over that end. */
WD_FUNC float wd_river_share(float end_m, float surface_m)
{
    return WD_CLAMP(surface_m / WD_MIN(end_m, -1e-6f), 0.0f, 1.0f);
}

/* The same by the surface over that place, too. Where that lies lower, as water does that falls toward the eye, the ray is
 * still above it there and meets it farther on: by that height alone such water would be as far off as its bed. */
WD_FUNC float wd_river_share_between(float end_m, float surface_m, float nearer_m)
{
    float share = wd_river_share(end_m, surface_m);
    float above_m = surface_m - nearer_m, below_m = WD_MAX(surface_m - end_m, 1e-6f);
    return above_m > 0.0f ? WD_MIX(share, 1.0f, above_m / (above_m + below_m)) : wd_river_share(end_m, nearer_m);
}

#endif
