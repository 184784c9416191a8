/* crown_sky.h: what a tree's neighbours leave it of the sky, at a grid of places about its crown, for trees
 * near enough to be seen leaf by leaf; and what crowns leave the ground about the eye. Kept in a table of sets: a
 * tree's record number says which set its slot is in, the set's head which slot. Behind the slots lies the ground. */
#ifndef WD_SHARED_CROWN_SKY_H
#define WD_SHARED_CROWN_SKY_H

#include "shared/vec.h"

#define WD_CROWN_SKY_SETS_LOG2 11u
#define WD_CROWN_SKY_SETS 2048u
#define WD_CROWN_SKY_SLOTS 4u /* of a set; its head is a texel of their records + 1, 0: free. Slots come after all heads */
#define WD_CROWN_SKY_ACROSS 4u  /* places east and north over the crown, from one side to the other, */
#define WD_CROWN_SKY_UP 6u      /* and from the ground to the top */
#define WD_CROWN_SKY_PLACES 96u
#define WD_CROWN_SKY_TEXELS 80u /* of a slot, each of a place and the one above it: of either two words, square roots of
                                   shares of upright faces' light from east, north, west and south, 8 bits each, from
                                   above 30 degrees and from below */
#define WD_CROWN_SKY_LOW_M 0.5f /* of the lowest places over the ground */

/* Trees of fewer pixels have none; of more than the second all that a pixel shows is known so. Of plants of a
 * few metres, which stand closer than the canopy's field tells, each metre less counts as so many more. */
#define WD_CROWN_SKY_LEAST_PX 80.0f
#define WD_CROWN_SKY_WHOLE_PX 120.0f
#define WD_CROWN_SKY_LOW_AS_M 30.0f
#define WD_CROWN_SKY_LOW_FALL 6.0f
/* The same of the distance. */
#define WD_CROWN_SKY_WHOLE_M 120.0f
#define WD_CROWN_SKY_FAR_M 160.0f

#define WD_CROWN_SKY_REACH_M 20.0f /* neighbours' stems stand no farther off; beyond, the canopy's field tells */
#define WD_CROWN_SKY_CELL_M 4.0f   /* of the grid in which they are found */

WD_FUNC uint32_t wd_crown_sky_set(uint32_t record)
{
    return (record * 2654435761u) >> (32u - WD_CROWN_SKY_SETS_LOG2);
}

/* How far a tree's table tells what it has, `away_m` from the eye. `px`: pixels a radian. */
WD_FUNC float wd_crown_sky_share(float height_m, float away_m, float px)
{
    float as_m = WD_MAX(height_m, WD_CROWN_SKY_LOW_AS_M - WD_CROWN_SKY_LOW_FALL * height_m);
    float tall_px = as_m * px / WD_MAX(away_m, 0.1f);
    float large = (tall_px - WD_CROWN_SKY_LEAST_PX) / (WD_CROWN_SKY_WHOLE_PX - WD_CROWN_SKY_LEAST_PX);
    float near = (WD_CROWN_SKY_FAR_M - away_m) / (WD_CROWN_SKY_FAR_M - WD_CROWN_SKY_WHOLE_M);
    return WD_CLAMP(WD_MIN(large, near), 0.0f, 1.0f);
}

/* A crown that hides the sky: an ellipsoid of leaves (tree/crown_shade.h). */
struct wd_sky_crown {
    int32_t foot_mm[3];
    float radius_m, half_m; /* half its width and half its height */
    float middle_m;         /* height of its middle over the foot */
    float per_m, steeper;   /* extinction */
    float stem_radius_m;    /* at breast height; 0: none that counts */
};
WD_STATIC_ASSERT_SIZE(wd_sky_crown, 36);

/* Bearings of rays in radians from east to north: four, then the four across from these. The way on from a crown's
 * reach goes in steps, each half as long again as the one before. */
#define WD_CROWN_SKY_BEARINGS 8u
#define WD_CROWN_SKY_BEARING(i) (0.39269908f + 0.78539816f * (i))
#define WD_CROWN_SKY_STEPS 5u
#define WD_CROWN_SKY_NEXT 1.5f

/* Of a crown or a tile of the ground. */
struct wd_crown_sky_job {
    int32_t foot_mm[3]; /* of the tree; of the tile's middle */
    uint32_t crown; /* the tree's own; none: WD_CROWN_SKY_NONE */
    float reach_m; /* of its neighbours; less where many stand closer */
    /* the rest of crowns alone: */
    uint32_t slot;
    float radius_m, top_m; /* of the places: on either side of the foot, and over it */
    WD_VEC4(ground); /* slopes up to the highest ground along the bearings */
    WD_VEC4(ground_across);
    float rise_m[WD_CROWN_SKY_BEARINGS * WD_CROWN_SKY_STEPS]; /* of the ground over the foot, in the middle of each step */
};
WD_STATIC_ASSERT_SIZE(wd_crown_sky_job, 224);

#define WD_CROWN_SKY_NONE 0xffffffffu

/* The ground about the eye: squares in tiles, each in the place of the table that its coordinates have modulo
 * WD_FLOOR_SKY_ACROSS. A texel's first two words are of a square's middle, as above: of level ground and of the
 * sky below 30 degrees. The others name the two stems that hide most of its sky. */
#define WD_FLOOR_SKY_ACROSS 128
#define WD_FLOOR_SKY_M 2.0f /* a square's side */
#define WD_FLOOR_SKY_TILE 8 /* squares a tile's side */
#define WD_FLOOR_SKY_TILES (WD_FLOOR_SKY_ACROSS / WD_FLOOR_SKY_TILE)
#define WD_FLOOR_SKY_TILE_M (WD_FLOOR_SKY_M * WD_FLOOR_SKY_TILE)
/* Ground beyond so many metres, or where a square is less than so many pixels, has no part in it; all has within this
 * share of that way. */
#define WD_FLOOR_SKY_FAR_M 108.0f
#define WD_FLOOR_SKY_LEAST_PX 3.0f
#define WD_FLOOR_SKY_WHOLE 0.74f
#define WD_FLOOR_SKY_OVER_M 0.5f /* of a square's middle over the ground */

/* A stem: from the square's middle east and north, 11 bits each, and half its thickness, 10; 0: none. */
#define WD_STEM_FAR_M 3.4f
#define WD_STEM_STEPS (1023.0f / WD_STEM_FAR_M)
#define WD_STEM_MOST_M 2.0f

WD_FUNC uint32_t wd_stem_pack(float east_m, float north_m, float stem_radius_m)
{
    uint32_t thick = WD_UINT(WD_CLAMP(stem_radius_m / WD_STEM_MOST_M, 0.001f, 1.0f) * 1023.0f + 0.5f);
    uint32_t east = WD_UINT((WD_CLAMP(east_m, -WD_STEM_FAR_M, WD_STEM_FAR_M) + WD_STEM_FAR_M) * WD_STEM_STEPS + 0.5f);
    uint32_t north = WD_UINT((WD_CLAMP(north_m, -WD_STEM_FAR_M, WD_STEM_FAR_M) + WD_STEM_FAR_M) * WD_STEM_STEPS + 0.5f);
    return east | north << 11 | thick << 22;
}

#define WD_STEM_EAST_M(word) (WD_FLOAT((word) & 0x7ffu) / WD_STEM_STEPS - WD_STEM_FAR_M)
#define WD_STEM_NORTH_M(word) (WD_FLOAT(((word) >> 11) & 0x7ffu) / WD_STEM_STEPS - WD_STEM_FAR_M)
#define WD_STEM_RADIUS_M(word) (WD_FLOAT((word) >> 22) * (WD_STEM_MOST_M / 1023.0f))

/* Share of an even sky's light on level ground that an upright stem hides, so far from its axis: asin(r / d) / pi, and
 * what roots hide beside it. Less from the first reach on, nothing from the second. */
#define WD_STEM_ROOTS_HIDE 0.25f
#define WD_STEM_ROOTS_END 2.6f /* radii */
#define WD_STEM_REACH_M 1.0f
#define WD_STEM_NO_REACH_M 2.0f

WD_FUNC float wd_stem_hides(float away_m, float stem_radius_m)
{
    float x = WD_MIN(stem_radius_m / WD_MAX(away_m, 1e-3f), 1.0f), xx = x * x, x4 = xx * xx;
    float hides = x * (0.3183f + 0.0531f * xx + 0.0239f * x4) + 0.1047f * x4 * x4 * x4;
    float end_m = WD_STEM_ROOTS_END * stem_radius_m;
    float roots = WD_CLAMP((end_m - away_m) / (end_m - stem_radius_m + 1e-4f), 0.0f, 1.0f);
    float fade = WD_CLAMP((WD_STEM_NO_REACH_M - away_m) / (WD_STEM_NO_REACH_M - WD_STEM_REACH_M), 0.0f, 1.0f);
    return (hides + WD_STEM_ROOTS_HIDE * roots) * fade * fade * (3.0f - 2.0f * fade);
}

WD_FUNC uint32_t wd_floor_sky_texel(int32_t column, int32_t row)
{
    const int32_t last = WD_FLOOR_SKY_ACROSS - 1;
    uint32_t ground = WD_CROWN_SKY_SETS * (1u + WD_CROWN_SKY_SLOTS * WD_CROWN_SKY_TEXELS);
    return ground + WD_UINT((row & last) * WD_FLOOR_SKY_ACROSS + (column & last));
}

struct wd_crown_sky_push {
    uint32_t job_count;  /* of crowns; behind them come */
    uint32_t tile_count; /* those of tiles */
    int32_t first_column, first_row; /* of the grid: cells count from the world's corner */
    uint32_t columns, rows;
    WD_VEC2(canopy_from_m); /* as in struct wd_light_push */
    WD_VEC2(canopy_scale);
};
WD_STATIC_ASSERT_SIZE(wd_crown_sky_push, 40);

#endif
