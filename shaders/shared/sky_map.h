/* sky_map.h: where a direction lies on a map of the sky, alike in C and GLSL. The map spans all
 * directions by longitude and latitude: zenith at the top, north in the middle where it is not
 * turned, east to the right of it. */
#ifndef WD_SHARED_SKY_MAP_H
#define WD_SHARED_SKY_MAP_H

#include "shared/vec.h"

/* x, y: 0..1 from the map's left upper corner; x may lie outside and then repeats. */
WD_FUNC WD_VECTOR wd_sky_map_place(WD_VECTOR direction, float turn)
{
    float bearing = WD_ATAN2(direction.x, direction.y) * 0.15915494f;
    float from_zenith = WD_ACOS(WD_CLAMP(direction.z, -1.0f, 1.0f)) * 0.31830989f;
    return WD_V3(bearing + 0.5f - turn, from_zenith, 0.0f);
}

#endif
