/* light.h: what the light pass is told besides the frame's uniforms. */
#ifndef WD_SHARED_LIGHT_H
#define WD_SHARED_LIGHT_H

#include "shared/types.h"

struct wd_light_push {
    WD_VEC2(camera_m);   /* local; for places in the maps and tables below */
    float sun_cell_m;    /* of that field */
    float sun_soft_m;    /* half the height over which its shadows fade */
    uint32_t sun_width, sun_height;
    uint32_t variants;   /* models a species */
    uint32_t tile_columns, tile_rows;
    uint32_t is_sea;     /* the water goes on beyond the terrain */
    uint32_t has_rivers; /* a map shows waters at their own heights */
    WD_VEC2(extent_m);   /* of the terrain */
    WD_VEC2(canopy_from_m); /* of the canopy's light: image coordinates = (metres - from) * scale */
    WD_VEC2(canopy_scale);
    uint32_t has_overlay; /* a method has blended trees over the G-buffer */
    float eye_over_ground_m; /* 1e6 where there is no ground */
    float shafts_m; /* way along the view axis within maps of shadows, on which these tell what haze has of the sun */
    float shafts;   /* how far they do, by how thick it is: 0..1 */
    uint32_t level_cards; /* cards show pictures taken level, whatever way the eye looks */
    float pixels_a_radian;
    uint32_t few_tiles;   /* all tiles without water are of WD_TILE_LIST_DRY */
    float floor_sky_m;    /* within which a table tells what of the sky reaches the ground (shared/crown_sky.h) */
};
WD_STATIC_ASSERT_SIZE(wd_light_push, 100);

/* Greatest height of a canopy that the image of its light can tell. */
#define WD_CANOPY_MOST_M 128.0f

/* Lower plants are herbs; so many layers of them the image can tell. */
#define WD_HERB_M 1.5f
#define WD_HERBS_MOST 4.0f

/* What a tile of pixels shows; each list of tiles is shaded by a pipeline with these parts. */
#define WD_TILE 8
#define WD_TILE_THREADS 64 /* of a workgroup that sorts tiles, a tile each */
#define WD_PART_SKY 1u
#define WD_PART_GROUND 2u /* any surface */
#define WD_PART_TREES 4u
#define WD_PART_WATER 8u
#define WD_PART_ALL 15u
#define WD_TILE_LISTS 6
#define WD_TILE_LIST_DRY 4u /* all parts but water */
#define WD_SHAFT_SLICES 16 /* parts of the way through haze, of a tile (lib/shafts.glsl) */
#define WD_SKY_M 1e9f     /* distances from here on are the sky's */

/* The cheapest list whose parts are enough. */
WD_FUNC uint32_t wd_tile_list_of(uint32_t parts)
{
    uint32_t trees = (parts & WD_PART_TREES) != 0u ? 2u : 0u;
    if ((parts & WD_PART_WATER) != 0u)
        return 5u;
    if ((parts & WD_PART_GROUND) == 0u)
        return 0u;
    return 1u + trees + ((parts & WD_PART_SKY) != 0u ? 1u : 0u);
}

WD_FUNC uint32_t wd_tile_list_parts(uint32_t list)
{
    if (list == 0u)
        return WD_PART_SKY;
    if (list == 5u)
        return WD_PART_ALL;
    uint32_t sky = list % 2u == 0u ? WD_PART_SKY : 0u;
    return WD_PART_GROUND | sky | (list >= 3u ? WD_PART_TREES : 0u);
}

struct wd_tile_groups {
    uint32_t x, y, z; /* as vkCmdDispatchIndirect takes them */
};

/* Head of the tile buffer; behind it stand WD_TILE_LISTS lists, each as long as there are tiles. */
struct wd_tile_lists {
#ifdef __STDC_VERSION__
    struct wd_tile_groups groups[WD_TILE_LISTS];
#else
    wd_tile_groups groups[WD_TILE_LISTS];
#endif
    uint32_t count[WD_TILE_LISTS];
};

/* Metering: 256 classes of log2 luminance, then the exposure they come to. */
#define WD_METER_BINS 256
#define WD_METER_LOW -27.0f  /* log2 of luminance at class 0 */
#define WD_METER_PER_EV 8.0f

struct wd_meter {
    uint32_t bins[WD_METER_BINS];
    float exposure;
};

struct wd_post_push {
    float exposure_scale; /* 2^exposure_ev */
    float bloom;          /* share of the light that the lens spreads */
};

#endif
