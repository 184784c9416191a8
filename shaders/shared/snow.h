/* snow.h: snow on what trees are made of, and how much of it lies around them. Shaders declare `frame`
 * before they include this. */
#ifndef WD_SHARED_SNOW_H
#define WD_SHARED_SNOW_H

#include "shared/noise.h"

/* Albedo of fresh snow, red to blue (Warren 1982). */
#define WD_SNOW_ALBEDO WD_V3(0.83f, 0.86f, 0.90f)

/* Share of snow that stays on what looks up so far. */
WD_FUNC float wd_snow_up(float normal_z)
{
    return WD_SMOOTH(-0.05f, 0.35f, normal_z);
}

/* Share of a place on a tree that lies under snow. It lies in pads as broad as a bough, where the crown
 * is open to the sky, on all that does not look down: not leaf by leaf. Pads at different heights are
 * not alike. `up` is by wd_snow_up of the upper side's normal where it is that which is seen, of bark by
 * the stem's: snow that clung to its relief would draw every plate. */
WD_FUNC float wd_snow_share_on(WD_FRAME_IN WD_VECTOR rel, float up, float openness, float footprint_m)
{
    float up_m = rel.z + WD_FLOAT(WD_FRAME(camera_mm[2])) * 0.001f;
    float east_m = rel.x + 0.83f * up_m, north_m = rel.y + 0.57f * up_m;
    float fine = wd_noise_share(footprint_m, 9);
    float pad = wd_gradient_noise(wd_lattice_at(WD_FRAME_PASS east_m, north_m, 10), 41u).x;
    pad += 0.6f * fine
           * wd_gradient_noise(wd_lattice_at(WD_FRAME_PASS east_m, north_m, 9), 42u).x;
    pad = 0.55f * pad * wd_noise_share(footprint_m, 10) + openness;
    float edge = WD_MIX(0.28f, 0.10f, fine);
    return WD_FRAME(snow) * WD_SMOOTH(0.45f - edge, 0.45f + edge, pad) * up;
}

/* Mean share of level ground under snow, so high over the world's zero: of wd_snow_share
 * (shared/ground_cover.h), which is patches. */
WD_FUNC float wd_snow_mean(WD_FRAME_IN float height_m)
{
    float above_line = WD_SMOOTH(-160.0f, 160.0f, height_m + 54.0f - WD_FRAME(snow_line_m));
    float fresh = WD_SMOOTH(-0.35f, 0.85f, 1.6f * WD_FRAME(snow) - 0.45f);
    return WD_MAX(above_line, WD_FRAME(snow) > 0.0f ? fresh : 0.0f);
}

#endif
