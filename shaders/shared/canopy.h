/* canopy.h: what a closed canopy leaves of the sky. */
#ifndef WD_SHARED_CANOPY_H
#define WD_SHARED_CANOPY_H

#include "shared/vec.h"

/* Share of the sky that the canopy leaves to the forest's floor. */
WD_FUNC float wd_canopy_openness(float cover)
{
    return WD_MIX(1.0f, 0.14f, WD_SMOOTH(0.15f, 0.9f, cover));
}

#endif
