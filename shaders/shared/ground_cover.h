/* ground_cover.h: what grows or lies on the ground at a place, by slope, height, canopy and chance.
 * Shaders declare `frame` before they include this. */
#ifndef WD_SHARED_GROUND_COVER_H
#define WD_SHARED_GROUND_COVER_H

#include "shared/ground_litter.h"
#include "shared/hash.h"
#include "shared/noise.h"
#include "shared/snow.h"

struct wd_ground_look {
    WD_VECTOR albedo;
    WD_VECTOR normal;
    float openness; /* share of the sky that the ground itself leaves */
};

/* Noise of the place at the sizes that the rules below ask for; each ends before it shimmers. */
struct wd_ground_noise {
    float broad;  /* 131 m */
    float middle; /* 16 m */
    float small_; /* 2 m */
    float fine;   /* 0.5 m and less */
    float bump_east, bump_north; /* slope that the smaller ones add */
    float wave_east, wave_north; /* slope of the 2 m one, for drifts */
};

/* Tufts, clods and crumbs: 0.5 m, 0.13 m and 32 mm. */
WD_FUNC WD_VECTOR wd_fine_noise(WD_FRAME_IN float east_m, float north_m, float footprint_m)
{
    WD_VECTOR fine = WD_V3(0.0f, 0.0f, 0.0f);
    int32_t octaves = footprint_m < 0.0192f ? 3 : footprint_m < 0.0768f ? 2
                      : footprint_m < 0.3072f ? 1 : 0; /* none that would be of no weight */
    for (int32_t i = 0; i < octaves; i++) {
        int32_t bits = 9 - 2 * i;
        WD_STRUCT wd_lattice at = wd_lattice_at(WD_FRAME_PASS east_m, north_m, bits);
        fine = wd_v3_add(fine, wd_v3_scale(wd_gradient_noise(at, 4u),
                                           0.6f * wd_noise_share(footprint_m, bits)));
    }
    return fine;
}

WD_FUNC WD_STRUCT wd_ground_noise wd_ground_noise_at(WD_FRAME_IN float east_m, float north_m,
                                                     float footprint_m)
{
    WD_STRUCT wd_ground_noise n;
    WD_VECTOR fine = wd_fine_noise(WD_FRAME_PASS east_m, north_m, footprint_m);
    WD_VECTOR wave = wd_gradient_noise(wd_lattice_at(WD_FRAME_PASS east_m, north_m, 11), 3u);
    wave = wd_v3_scale(wave, wd_noise_share(footprint_m, 11));
    n.broad = wd_gradient_noise(wd_lattice_at(WD_FRAME_PASS east_m, north_m, 17), 1u).x;
    n.middle = wd_gradient_noise(wd_lattice_at(WD_FRAME_PASS east_m, north_m, 14), 2u).x
               * wd_noise_share(footprint_m, 14);
    n.small_ = wave.x;
    n.fine = fine.x;
    n.wave_east = wave.y;
    n.wave_north = wave.z;
    n.bump_east = wave.y * 0.05f + fine.y * 0.18f;
    n.bump_north = wave.z * 0.05f + fine.z * 0.18f;
    return n;
}

/* What lies strewn at a place, and how plainly pixels of this size show it, 0..1. */
struct wd_ground_strewn {
    WD_STRUCT wd_strewn_hit hit;
    float plain;
};

/* Of a pixel's footprint that of each of its samples, over so many of which the picture is a mean: they show what the
 * pixel alone would not, as far as four. Ground without plants is smooth where its leaves and clods are gone. */
WD_FUNC float wd_sample_footprint(uint32_t samples)
{
    return 1.0f / WD_SQRT(WD_MIN(WD_MAX(WD_FLOAT(samples), 1.0f), 4.0f));
}

/* From this footprint on, in metres, leaves on the ground are no more than its mean colour. */
#define WD_STREWN_NONE_M 0.045f

/* Shaders may say that no pixel is so near. */
#ifndef WD_STREWN_SHOWN
#define WD_STREWN_SHOWN true
#endif

/* Under trees leaves, in meadows blades; `shade` as in wd_soil_albedo. */
WD_FUNC WD_STRUCT wd_ground_strewn wd_ground_strewn_at(WD_FRAME_IN float east_m, float north_m,
                                                       float shade, WD_STRUCT wd_ground_noise n,
                                                       float footprint_m)
{
    WD_STRUCT wd_strewn things;
    bool leaves = shade > 0.5f;
    things.bits = 6;
    things.layers = WD_STREWN_SHOWN && footprint_m < WD_STREWN_NONE_M ? 4 : 0;
    things.half_length = leaves ? 0.70f : 0.75f;
    things.half_width = leaves ? 0.38f : 0.065f;
    things.least = leaves ? 0.5f : 0.7f;
    things.chance = leaves ? WD_CLAMP(0.8f + 0.5f * n.small_ + 0.25f * n.fine, 0.3f, 1.0f) : 0.95f;
    things.twigs = leaves ? 0.05f : 0.0f;
    things.salt = leaves ? 31u : 32u;
    WD_STRUCT wd_ground_strewn strewn;
    strewn.hit = wd_strewn_at(WD_FRAME_PASS east_m, north_m, things);
    strewn.plain = 1.0f - WD_SMOOTH(0.4f * WD_STREWN_NONE_M, WD_STREWN_NONE_M, footprint_m);
    return strewn;
}

/* -1..1, of the layer of rock that is the so-manieth from the world's zero up. */
WD_FUNC float wd_bed_tone(int32_t index)
{
    return 2.0f * wd_hash_unit(wd_hash1(WD_UINT(index))) - 1.0f;
}

/* Layers of rock: bands by height, no two alike, tilted a little, broken by noise. */
WD_FUNC WD_VECTOR wd_rock_albedo(WD_FRAME_IN float height_m, WD_STRUCT wd_ground_noise n,
                                 float footprint_m)
{
    float bed = height_m * 0.11f + n.broad * 3.0f + n.middle * 0.7f;
    int32_t index = WD_INT(WD_FLOOR(bed));
    float band = WD_MIX(wd_bed_tone(index), wd_bed_tone(index + 1), WD_SMOOTH(0.55f, 1.0f, wd_fract(bed)));
    band *= 1.0f - WD_SMOOTH(2.0f, 8.0f, footprint_m);
    float stain = 1.0f + 0.16f * band + 0.35f * n.small_ + 0.30f * n.fine + 0.2f * n.middle;
    WD_VECTOR hue = wd_v3_mix(WD_V3(1.0f, 1.0f, 1.0f), WD_V3(1.07f, 1.0f, 0.90f), 0.5f + n.broad);
    return wd_v3_mul(wd_v3_scale(WD_FRAME_V3(rock), WD_MAX(stain, 0.3f)), hue);
}

/* Leaves and blades lie aslant and take less light than level ground, and their earth is another. With these factors on
 * them ground is on the whole as bright and of the same colour, however much of them a pixel shows. */
#define WD_LEAVES_EVEN WD_V3(1.162f, 1.215f, 1.267f)
#define WD_BLADES_EVEN WD_V3(0.994f, 1.042f, 1.015f)

/* Meadow: dry on shoulders and knolls, lush in hollows; blades and the thatch between them near the
 * eye. */
WD_FUNC WD_VECTOR wd_grass_albedo(WD_FRAME_IN float height_m, float steep,
                                  WD_STRUCT wd_ground_noise n, WD_STRUCT wd_ground_strewn strewn)
{
    float high = WD_SMOOTH(-400.0f, 200.0f, height_m - WD_FRAME(tree_line_m));
    float dry = 0.42f + 0.8f * n.broad + 0.7f * n.middle + 0.55f * n.small_ + 0.4f * n.fine
                + 0.5f * steep + 0.5f * high;
    bool blade = strewn.hit.rank > 0.0f;
    dry += strewn.plain * (blade ? 0.7f * strewn.hit.random - 0.4f : 0.25f);
    WD_VECTOR straw = wd_v3_mul(WD_FRAME_V3(grass), WD_V3(1.55f, 1.14f, 1.30f));
    WD_VECTOR lush = wd_v3_mul(WD_FRAME_V3(grass), WD_V3(0.80f, 0.86f, 0.80f));
    float bright = blade ? 1.35f - 0.35f * strewn.hit.depth : 0.82f;
    WD_VECTOR even = wd_v3_mix(WD_V3(1.0f, 1.0f, 1.0f), WD_BLADES_EVEN, strewn.plain);
    return wd_v3_scale(wd_v3_mul(wd_v3_mix(lush, straw, WD_CLAMP(dry, 0.0f, 1.0f)), even),
                       WD_MIX(1.0f, bright, strewn.plain)
                           * WD_MAX(1.0f + 0.75f * n.fine + 0.4f * n.small_ + 0.15f * n.middle,
                                    0.2f));
}

/* Colour of one fallen leaf, old and dark or fresh and pale, or of the earth that none covers; the
 * mean over all is the litter's. */
WD_FUNC WD_VECTOR wd_leaf_litter(WD_FRAME_IN WD_STRUCT wd_strewn_hit hit)
{
    float bright = 0.72f + 0.7f * hit.random * hit.random;
    WD_VECTOR warm = WD_V3(1.12f, 0.97f, 0.78f), pale = WD_V3(0.96f, 1.02f, 1.10f);
    WD_VECTOR hue = wd_v3_mix(warm, pale, wd_fract(hit.random * 7.0f));
    bright *= 1.0f - 0.5f * hit.depth + 0.25f * WD_SMOOTH(0.8f, 1.0f, hit.rib);
    WD_VECTOR leaf = wd_v3_scale(wd_v3_mul(WD_FRAME_V3(litter), hue), 1.30f * bright);
    WD_VECTOR earth = wd_v3_scale(wd_v3_mix(WD_FRAME_V3(litter), WD_FRAME_V3(soil), 0.4f), 0.55f);
    leaf = hit.twig ? wd_v3_scale(earth, 1.3f) : leaf;
    return wd_v3_scale(hit.rank > 0.0f ? leaf : earth, 1.0f - 0.32f * hit.shade);
}

/* Under trees: needles and leaves, moss and low herbs in some hollows, bare earth between. */
WD_FUNC WD_VECTOR wd_floor_albedo(WD_FRAME_IN WD_STRUCT wd_ground_noise n,
                                  WD_STRUCT wd_ground_strewn strewn)
{
    float moss = WD_SMOOTH(0.12f, 0.5f, 0.5f * n.middle + 0.8f * n.small_ + 0.5f * n.fine
                                            + 0.2f * n.broad);
    WD_VECTOR green = wd_v3_mul(wd_v3_mix(WD_FRAME_V3(litter), WD_FRAME_V3(grass), 0.65f),
                                WD_V3(0.62f, 0.74f, 0.6f));
    float earth = WD_SMOOTH(0.1f, 0.5f, n.small_ - 0.5f * n.middle + 0.3f * n.fine);
    WD_VECTOR bare = wd_v3_mix(WD_FRAME_V3(litter), WD_FRAME_V3(soil), 0.6f * earth);
    bare = wd_v3_scale(bare, WD_MAX(1.0f + 0.55f * n.fine + 0.3f * n.small_, 0.2f));
    WD_VECTOR leaves = wd_v3_scale(wd_v3_mul(wd_leaf_litter(WD_FRAME_PASS strewn.hit), WD_LEAVES_EVEN),
                                   WD_MAX(1.0f + 0.3f * n.fine + 0.3f * n.small_, 0.2f));
    bare = wd_v3_mix(bare, leaves, strewn.plain);
    green = wd_v3_scale(green, WD_MAX(1.0f + 0.8f * n.fine, 0.2f));
    /* fallen leaves lie on moss as well */
    float over = strewn.hit.rank > 0.0f && strewn.hit.depth < 0.4f ? strewn.plain : 0.0f;
    return wd_v3_mix(bare, green, 0.6f * moss * (1.0f - over));
}

/* 0 below the snow line, 1 above; lower where it is level, none on walls. Fresh snow lies below the
 * line, too. */
WD_FUNC float wd_snow_share(WD_FRAME_IN float height_m, float steep, WD_STRUCT wd_ground_noise n)
{
    float line = WD_FRAME(snow_line_m) + 120.0f * n.broad + 40.0f * n.middle;
    float lies = WD_SMOOTH(-40.0f, 60.0f, height_m - line - 160.0f * (steep - 0.4f));
    float fresh = 1.6f * WD_FRAME(snow) - 0.45f + 0.5f * n.middle + 0.4f * n.small_ + 0.25f * n.fine;
    lies = WD_MAX(lies, WD_FRAME(snow) > 0.0f ? WD_SMOOTH(0.0f, 0.5f, fresh) : 0.0f);
    return lies * (1.0f - WD_SMOOTH(0.9f, 1.4f, steep + 0.3f * n.small_ + 0.2f * n.middle));
}

/* 0 in the open .. 1 on the floor of a forest; below single trees grass goes on. */
WD_FUNC float wd_floor_share(float cover, float woods, WD_STRUCT wd_ground_noise n)
{
    float shaded = cover * WD_CLAMP(0.25f + 1.6f * woods, 0.0f, 1.0f);
    return WD_SMOOTH(0.15f, 0.6f, shaded + 0.3f * n.small_ + 0.15f * n.middle + 0.1f * n.fine);
}

/* Grass, forest floor and worn earth, before rock, water's edge and snow. */
WD_FUNC WD_VECTOR wd_soil_albedo(WD_FRAME_IN float height_m, float steep, float cover,
                                 float floor_share, WD_STRUCT wd_ground_noise n,
                                 WD_STRUCT wd_ground_strewn strewn)
{
    WD_VECTOR albedo = wd_grass_albedo(WD_FRAME_PASS height_m, steep, n, strewn);
    albedo = wd_v3_mix(albedo, wd_floor_albedo(WD_FRAME_PASS n, strewn), floor_share);
    float worn = WD_SMOOTH(0.55f, 1.0f, steep / WD_FRAME(rock_slope) + 0.5f * n.middle
                                        + 0.25f * n.small_);
    worn = WD_MAX(worn, 0.45f * WD_SMOOTH(0.30f, 0.55f, n.middle + n.small_ * 0.8f - cover));
    WD_VECTOR earth = wd_v3_scale(WD_FRAME_V3(soil),
                                  WD_MAX(1.0f + 0.6f * n.fine + 0.3f * n.small_, 0.3f));
    return wd_v3_mix(albedo, earth, 0.75f * worn);
}

WD_FUNC WD_VECTOR wd_ground_albedo(WD_FRAME_IN float height_m, float above_water_m, float steep,
                                   float cover, float floor_share, WD_STRUCT wd_ground_noise n,
                                   WD_STRUCT wd_ground_strewn strewn, float footprint_m)
{
    WD_VECTOR albedo = wd_soil_albedo(WD_FRAME_PASS height_m, steep, cover, floor_share, n,
                                      strewn);
    float over = (height_m - WD_FRAME(tree_line_m)) / 500.0f;
    float bare = WD_SMOOTH(0.85f, 1.15f, steep / WD_FRAME(rock_slope) + 0.30f * n.middle
                                         + 0.15f * n.small_ + WD_CLAMP(over, 0.0f, 0.9f));
    albedo = wd_v3_mix(albedo, wd_rock_albedo(WD_FRAME_PASS height_m, n, footprint_m), bare);
    /* sedges on wet ground, then mud and sand; narrow, however level the shore is */
    float damp = 1.0f - WD_SMOOTH(0.3f, 1.1f, above_water_m + 0.8f * n.small_ + 0.4f * n.middle);
    albedo = wd_v3_mix(albedo, wd_v3_mul(WD_FRAME_V3(grass), WD_V3(0.72f, 0.85f, 0.75f)),
                       0.7f * damp * (1.0f - bare));
    float flat_shore = 0.08f + 0.5f * WD_MIN(steep * 8.0f, 1.0f);
    float beach = 1.0f - WD_SMOOTH(0.5f, 1.0f, (above_water_m + 0.25f * n.small_
                                                + 0.1f * n.fine) / flat_shore);
    albedo = wd_v3_mix(albedo, wd_v3_scale(WD_FRAME_V3(soil), 1.15f), 0.8f * beach);
    float wet = 1.0f - WD_SMOOTH(0.0f, 0.35f, above_water_m);
    albedo = wd_v3_scale(albedo, 1.0f - 0.45f * wet);
    return albedo;
}

/* Share of a sward that is too far off to be drawn. */
WD_FUNC float wd_sward_gone(WD_FRAME_IN float distance_m)
{
    float begin_m = WD_FRAME(sward_whole_m), span_m = WD_MAX(WD_FRAME(sward_gone_m) - begin_m, 1e-3f);
    return WD_FRAME(sward_gone_m) > 0.0f ? WD_CLAMP((distance_m - begin_m) / span_m, 0.0f, 1.0f) : 0.0f;
}

/* Where plants are that far off the ground has the colour of what they would show; tufts stand at random, and leave some of
 * it open. `layers` of them, and of those that do not fade. */
WD_FUNC WD_VECTOR wd_far_sward(WD_FRAME_IN WD_VECTOR albedo, float layers, float distance_m,
                               WD_STRUCT wd_ground_noise n)
{
    float share = 1.0f - WD_EXP(-layers * WD_FRAME(sward_share));
    WD_VECTOR sward = wd_v3_scale(WD_FRAME_V3(sward), 1.0f + 0.3f * n.small_ + 0.2f * n.middle);
    return wd_v3_mix(albedo, sward, share * wd_sward_gone(WD_FRAME_PASS distance_m));
}

/* `rel`: the place; `slope`: rise over run east and north; `cover`: of the canopy, 0..1; `woods`: its
 * mean about the place (world/cover.h); `layers`: of low plants; `river_m`: height of the surface of a map's
 * water there. */
WD_FUNC WD_STRUCT wd_ground_look wd_ground_cover(WD_FRAME_IN WD_VECTOR rel, float slope_east,
                                                 float slope_north, float cover, float woods,
                                                 float layers, float river_m, float footprint_m)
{
    float height_m = rel.z + WD_FLOAT(WD_FRAME(camera_mm[2])) * 0.001f;
    float above_water_m = height_m - WD_MAX(WD_FRAME(water_level_m), river_m);
    WD_STRUCT wd_ground_noise n = wd_ground_noise_at(WD_FRAME_PASS rel.x, rel.y, footprint_m);
    float floor_share = wd_floor_share(cover, woods, n);
    WD_STRUCT wd_ground_strewn strewn =
        wd_ground_strewn_at(WD_FRAME_PASS rel.x, rel.y, floor_share, n, footprint_m);
    float steep = WD_SQRT(slope_east * slope_east + slope_north * slope_north);
    float snow = wd_snow_share(WD_FRAME_PASS height_m, steep, n);
    WD_VECTOR albedo = wd_ground_albedo(WD_FRAME_PASS height_m, above_water_m, steep, cover,
                                        floor_share, n, strewn, footprint_m);
    albedo = wd_far_sward(WD_FRAME_PASS albedo, layers, WD_SQRT(wd_v3_dot(rel, rel)), n);
    WD_STRUCT wd_ground_look look;
    look.albedo = wd_v3_clamp(wd_v3_mix(albedo, WD_SNOW_ALBEDO, snow), 0.0f, 1.0f);
    float rough = 1.0f + WD_SMOOTH(0.7f, 1.2f, steep / WD_FRAME(rock_slope)) * 1.5f;
    rough *= 1.0f - 0.75f * snow; /* it fills what is uneven */
    float drift = 0.09f * snow; /* wind has laid it in low waves */
    float tilt = strewn.plain * (1.0f - snow);
    float east = slope_east + n.bump_east * rough + drift * n.wave_east;
    float north = slope_north + n.bump_north * rough + drift * n.wave_north;
    look.normal = wd_v3_normalize(WD_V3(-east - tilt * strewn.hit.tilt_east,
                                        -north - tilt * strewn.hit.tilt_north, 1.0f));
    look.openness = 0.85f + 0.15f * WD_CLAMP(1.0f + 2.0f * n.fine, 0.0f, 1.0f);
    return look;
}

#endif
