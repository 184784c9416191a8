/* canopy_map.h: the forest as a look of the ground's pixels, where trees are too far to be drawn
 * (the shader-maps of Bruneton and Neyret 2012). */
#ifndef WD_SHARED_CANOPY_MAP_H
#define WD_SHARED_CANOPY_MAP_H

#include "shared/view_set.h"

struct wd_canopy_push {
    WD_STRUCT wd_view_atlas atlas;
    uint32_t variants, baked_variants;
    float range_m, fade;           /* as in wd_view_push */
    WD_VEC2(camera_m);             /* local */
    WD_VEC2(cover_scale);          /* canopy cover: coordinates = local metres * scale */
    float cover_texel_m, pixel_rad;
    WD_VEC2(cells_min_m);          /* cells of trees: see methods/cells.h */
    float cell_m;
    uint32_t columns, rows;
    float canopy_m;                /* mean height of the trees */
    float aspect;                  /* mean height over crown diameter */
};

/* What a pixel shows of the canopy; surface 0: nothing. */
struct wd_canopy_pixel {
    uint32_t albedo, normal; /* 8 bits each: linear albedo's square root and openness; normal */
    uint32_t surface;
};
WD_STATIC_ASSERT_SIZE(wd_canopy_pixel, 12);

/* Share of a canopy's ground that is hidden, seen at an angle whose cosine to the ground's normal
 * is given: trees are ellipsoids strewn at random, and their shadows along the view lengthen with the
 * angle, the more the taller they are for their width (Li and Strahler 1992). */
WD_FUNC float wd_canopy_hides(float cover, float aspect, float cosine)
{
    float c = WD_CLAMP(cosine, 0.05f, 1.0f), tangent2 = 1.0f / (c * c) - 1.0f;
    float stretch = WD_SQRT(1.0f + aspect * aspect * tangent2);
    return 1.0f - WD_POW(1.0f - WD_CLAMP(cover, 0.0f, 0.999f), stretch);
}

/* How much of trees and of the map shows at a distance: over the last share of the range
 * the map comes in whole before trees go (as G7). */
WD_FUNC float wd_canopy_ramp(float range_m, float fade, float distance_m)
{
    float from = range_m * (1.0f - fade);
    float t = range_m > from ? (distance_m - from) / (range_m - from)
                             : (distance_m >= range_m ? 1.0f : 0.0f);
    return WD_CLAMP(t, 0.0f, 1.0f);
}
WD_FUNC float wd_canopy_trees(float range_m, float fade, float distance_m)
{
    return WD_MIN(2.0f - 2.0f * wd_canopy_ramp(range_m, fade, distance_m), 1.0f);
}
WD_FUNC float wd_canopy_shows(float range_m, float fade, float distance_m)
{
    return WD_MIN(2.0f * wd_canopy_ramp(range_m, fade, distance_m), 1.0f);
}

#endif
