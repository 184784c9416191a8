/* frame.h: what every pass of a frame knows; G-buffer layout.
 *
 * "rel" is the camera-relative frame: metres east, north, up of the camera. A world position of
 * whole millimetres p becomes rel = vec3(p - camera_mm) * 0.001 - camera_frac_m, exactly.
 * Depth is reversed and infinite: depth = near_m / distance along the view axis, 0 is the sky.
 *
 * G-buffer (written by terrain and by every method):
 *   albedo  R8G8B8A8_SRGB        rgb: linear albedo; a: sky openness (1 open ground or outer leaf,
 *                                0 deep inside a crown)
 *   normal  A2B10G10R10_UNORM    xyz * 0.5 + 0.5, world axes; a: material / 3
 *   surface R32_UINT             index of the tree in octree order + 1; 0: ground or sky
 *   depth   D32_SFLOAT */
#ifndef WD_SHARED_FRAME_H
#define WD_SHARED_FRAME_H

#include "shared/types.h"

#define WD_MATERIAL_GROUND 0 /* where a tree is seen, a disc of it (lib/disc.glsl) */
#define WD_MATERIAL_WOOD 1
#define WD_MATERIAL_LEAF 2
#define WD_MATERIAL_CARD 3 /* a billboard: its position is that of the card, not of the leaf */

#define WD_CASCADES 5
#define WD_LEAF_CASCADES 2 /* so many of the nearest hold single leaves, the others crowns */

/* Numbers of a cascade in wd_frame_uniforms. */
#define WD_CASCADE_FAR_M 0   /* distance from the camera at which it ends */
#define WD_CASCADE_TEXEL_M 1 /* size of a texel on the ground, over w */
#define WD_CASCADE_DEPTH_M 2 /* depth range that z 0..1 spans, over w */
#define WD_CASCADE_FADE_M 3  /* so far before its end the next begins */

/* values of view_mode: as enum wd_view_mode of weald/renderer.h */
#define WD_MODE_LIT 0
#define WD_MODE_LOD 1
#define WD_MODE_ALBEDO 2
#define WD_MODE_NORMAL 3
#define WD_MODE_TREE_ID 4
#define WD_MODE_SHADOW 5

struct wd_frame_uniforms {
    WD_MAT4(clip_from_rel);          /* with this sample's sub-pixel offset */
    WD_MAT4(rel_from_clip);
    WD_MAT4(previous_clip_from_rel); /* takes rel of the current camera; no sub-pixel offset */
    WD_MAT4(steady_clip_from_rel);   /* clip_from_rel without the sub-pixel offset */
    WD_MAT4(shadow_from_rel[WD_CASCADES]); /* to texture coordinates (x, y in 0..1) and depth z
                                              (reversed: 1 nearest the sun); w is 1 but in a
                                              perspective map */
    WD_VEC4(cascades[WD_CASCADES]);
    int32_t camera_mm[3];
    float time_s;
    WD_VEC3(camera_frac_m);          /* 0..0.001 */
    float previous_time_s;
    WD_VEC3(sun_direction);          /* unit, toward the sun */
    float sun_cos_radius;            /* cosine of the disc's angular radius */
    WD_VEC3(sun_irradiance);         /* on a surface facing the sun, at the ground, linear sRGB */
    float sky_turbidity;
    WD_VEC3(sky_irradiance);         /* of the whole sky on level ground */
    float sky_strength;
    WD_VEC3(circumsolar);            /* irradiance of the sky about the sun, beyond the rest's, on a surface
                                        facing the sun */
    WD_VEC3(sky_glow);               /* radiance of haze at the horizon over its phase function */
    float near_m;
    WD_VEC3(sky_horizon);            /* radiance there without the glow */
    float fog_per_m;                 /* extinction at full density */
    WD_VEC3(sky_cloud);              /* radiance of clouds at the zenith, as mixed into the sky */
    float snow;                      /* share of upper sides under snow, 0..1 */
    float sky_turn;                  /* of the sky's map, clockwise, in whole turns */
    uint32_t sky_is_map;             /* the sky is a map (shared/sky_map.h), not computed */
    float fog_height_m;
    float fog_base_m;                /* above the world's zero */
    WD_VEC3(fog_bands);              /* its extinction by band, over that of green */
    float fog_over;                  /* optical depth straight up from the camera of what the sky does not hold itself */
    float wind_speed_mps, wind_gust;
    WD_VEC2(wind_toward);            /* unit: where the wind blows to, x east, y north */
    float water_level_m;             /* -1e9: no water */
    float water_clarity_m;
    WD_VEC3(water_color);
    float exposure;                  /* factor for the display; filled in by metering when 0 */
    WD_VEC3(grass); float rock_slope; /* linear albedo; slope as rise over run */
    WD_VEC3(soil); float snow_line_m;
    WD_VEC3(rock); float tree_line_m;
    WD_VEC3(litter); float terrain_cell_m;
    WD_VEC3(sward); float sward_share; /* of low plants that fade with distance: as they are seen; of all of them; */
    float sward_whole_m, sward_gone_m; /* and from where to where they do. 0, 0: none does */
    WD_VEC3(sky_form[9]);            /* the sky's irradiance, but the circumsolar part, as a polynomial in the
                                        normal: 1, x, y, z, xy, yz, zz, xz, xx - yy */
    WD_VEC3(sky_under[9]);           /* sky_form of what comes down below a closed forest, times so much
                                        that level ground has as much by either, */
    WD_VEC3(sky_under_tint);         /* and its colour: the share that comes down over that of green */
    WD_VEC3(sky_quarters[4]);        /* the same light on level ground by where it comes from: E, N, W, S */
    WD_VEC4(sky_slant);              /* by quarters: how much more a layer of leaves dims that light
                                        than an even sky's, as a power */
    WD_VEC4(sunward);                /* shares of the quarters toward the sun's bearing */
    WD_VEC3(leaf_scatter);           /* root of what crowns absorb of the light that they stop */
    uint32_t width, height;          /* of the picture */
    uint32_t terrain_width, terrain_height; /* samples */
    uint32_t sample_index, sample_count;
    uint32_t adds;                   /* 1: radiance comes on top of the samples before */
    uint32_t view_mode;
    uint32_t shadow_taps;            /* 0: no shadows */
    int32_t wind_period;             /* how many WD_WIND_PERIOD_S the times above are counted from */
};

/* Shared mathematics asks for these values through WD_FRAME(member), or WD_FRAME_V3(member) for
 * three floats; shaders declare a block called `frame`, C functions take a pointer first. */
#ifdef __STDC_VERSION__
#define WD_FRAME_IN const struct wd_frame_uniforms *frame,
#define WD_FRAME_PASS frame,
#define WD_FRAME(member) (frame->member)
#define WD_FRAME_V3(member) wd_v3_of(frame->member)
#else
#define WD_FRAME_IN
#define WD_FRAME_PASS
#define WD_FRAME(member) (frame.member)
#define WD_FRAME_V3(member) (frame.member)
#endif

#endif
