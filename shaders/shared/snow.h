/* snow.h: fresh snow on what trees are made of. Shaders declare `frame` before they include this. */
#ifndef WD_SHARED_SNOW_H
#define WD_SHARED_SNOW_H

#include "shared/frame.h"

/* Albedo of fresh snow, red to blue (Warren 1982). */
#define WD_SNOW_ALBEDO WD_V3(0.83f, 0.86f, 0.90f)

/* Snow lies on upper sides, and more of it where the crown is open to the sky. */
WD_FUNC WD_VECTOR wd_snow_on(WD_FRAME_IN WD_VECTOR albedo, WD_VECTOR normal, float openness)
{
    float lies = WD_FRAME(snow) * WD_SMOOTH(0.15f, 0.6f, normal.z)
                 * (0.25f + 0.75f * WD_SMOOTH(0.1f, 0.6f, openness));
    return wd_v3_mix(albedo, WD_SNOW_ALBEDO, lies);
}

#endif
