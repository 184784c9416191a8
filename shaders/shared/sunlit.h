/* sunlit.h: how much of the sun's light a model's own leaves and wood send to an eye, over what the crown's
 * depth would say (shared/crown.h), by the elevation of the eye and of the sun (rings of shared/sun_ways.h, and of eyes one below the horizon)
 * and by the angle between both on the ground, half a turn in six steps. */
#ifndef WD_SHARED_SUNLIT_H
#define WD_SHARED_SUNLIT_H

#include "shared/sun_ways.h"

/* How much of an even sky's light and of even ground's a model's own crown leaves to what an eye sees, by the
 * eye's elevation (its rings), of leaves and of wood: from above to the side that is seen and to the
 * other, then from below. Factors on what they would have by how far they look up and by openness: */
#define WD_SKYLIT_KINDS 4u
#define WD_SKYLIT_PLACES 15u /* WD_EYE_RINGS each of these: */
#define WD_SKYLIT_LEAVES 0u  /* with normals of their own; */
#define WD_SKYLIT_WOOD 5u
#define WD_SKYLIT_CLOUDS 10u /* and of pixels that show many leaves, as wd_leaves_seen_up says */

/* What has little of the sky overhead has more of it to its sides, and more of the ground. */
WD_FUNC float wd_skylit_above(float openness)
{
    return openness + 0.1f;
}

WD_FUNC float wd_skylit_below(float openness)
{
    return openness + 0.4f;
}

/* How far up leaves that lie flat rather than upright look with the sides that an eye sees: their mean normal's
 * z, as models of six species have it, much the same about any crown. `eye`: the sine of its elevation. */
WD_FUNC float wd_leaves_seen_up(float eye)
{
    return 1.6f * eye / (1.0f + 1.3f * WD_ABS(eye));
}

/* Three ratios up to WD_PALER_MOST in ten bits each, and a bit of leaves of which as many lie with the one side up as
 * with the other. */
#define WD_PALER_MOST 8.0f
#define WD_PALER_STEPS 1023.0f
#define WD_PALER_ANY_WAY 0x40000000u
/* Of wd_lit_leaves.through: the reduced mesh has every leaf. */
#define WD_THROUGH_ALL_LEAVES 0x40000000u

/* Share of upper sides among what an eye sees of a model's leaves, by the eye's elevation (its rings): of what reflects,
 * and of what transmits the sun toward it, by the sun's elevation (up to its third ring), and of all. */
#define WD_UPPER_SUNS 3u
#define WD_UPPER_REFLECTS 0u
#define WD_UPPER_TRANSMITS 3u
#define WD_UPPER_SEEN 6u
/* And what its leaves' wax mirrors of the sun to that eye, over what cloud_wax of struct wd_tree_model tells for any. */
#define WD_UPPER_MIRRORS 7u
#define WD_UPPER_MIRRORS_MOST 4.0f
/* What it mirrors of an even sky, over what comes of that to the sides that are seen, and how open these leaves are. */
#define WD_UPPER_SKY_WAX 8u
#define WD_UPPER_SKY_WAX_MOST 0.0625f
#define WD_UPPER_OPEN 9u
#define WD_UPPER_KINDS 10u
/* Of an even sky as much comes from the one side as of a sun on this ring. */
#define WD_UPPER_SKY_RING 1u

/* How far a model's leaves shade one another from close by is told by how many more places on them are lit if nothing
 * nearer than this hides the sun, and by which power of the distance that goes with. */
#define WD_NEAR_SHADE_M 0.08f

/* Leaves turned every way, seen and lit from directions so far apart: mean share of their reflected and of their
 * transmitted light relative to a lit wall (Ross 1981). */
WD_FUNC float wd_cloud_reflects(float cosine, float angle)
{
    return (WD_SQRT(WD_MAX(1.0f - cosine * cosine, 0.0f)) + (3.14159265f - angle) * cosine) * (2.0f / 9.4247780f);
}

WD_FUNC float wd_cloud_transmits(float cosine, float angle)
{
    return (WD_SQRT(WD_MAX(1.0f - cosine * cosine, 0.0f)) - angle * cosine) * (2.0f / 9.4247780f);
}

/* The table holds what a model sends over what an even cloud of leaves would, whose own light has a little added, so that
 * this is never over nothing, and over how an eye that comes nearer to the sun sees more of what this reaches: what is
 * left of both hardly bends between the table's ways. */
#define WD_CLOUD_LEAST 0.02f

/* The same of wood: three fifths are upright stems, lit by how far eye and sun are apart on the ground (`turned`) and how
 * level both are (`level`, the cosines of their elevations, one times the other), with less added. */
WD_FUNC float wd_wood_reflects(float cosine, float angle, float turned_cosine, float turned, float level)
{
    return 0.4f * wd_cloud_reflects(cosine, angle) + 0.6f * level * wd_cloud_reflects(turned_cosine, turned) + 0.003f;
}

WD_FUNC float wd_sunlit_hot(float angle)
{
    return 1.0f + 0.5f * WD_EXP(-6.0f * angle);
}

#define WD_SUNLIT_TURNS 7u
#define WD_SUNLIT_PLACES 140u /* WD_SUN_RINGS * WD_EYE_RINGS * WD_SUNLIT_TURNS */
/* Two numbers each, over wd_sunlit_hot. Of leaves as a cloud, over wd_cloud_* and what depth leaves of the sun to what
 * shows them: */
#define WD_SUNLIT_CARDS 0u  /* a card, */
#define WD_SUNLIT_DEEP 1u   /* or places of their own. */
#define WD_SUNLIT_WOOD 2u   /* Of wood, a factor on what is left to it; and of many branches, over wd_wood_reflects. */
#define WD_SUNLIT_LEAVES 3u /* Of single leaves, the former. */
#define WD_SUNLIT_KINDS 7u

/* The sun's rings, and 15 degrees below the horizon one from which eyes look up. */
#define WD_EYE_RINGS 5u
#define WD_EYE_RING_SINE(ring) ((ring) == 0u ? -0.25882f : WD_SUN_RING_SINE((ring) - 1u))

/* Of bytes for rings of the eye, four a word, one's share. */
#define WD_RING_SHARE(packed, ring) \
    (WD_FLOAT((packed)[(ring) >> 2u] >> 8u * ((ring) & 3u) & 255u) * (1.0f / 255.0f))

/* Index of the eye's ring below a sine (bits 0..7) and how near the next one is, in 1/65535 above. */
WD_FUNC uint32_t wd_sunlit_ring(float sine_of)
{
    float sine = WD_CLAMP(sine_of, WD_EYE_RING_SINE(0u), 1.0f);
    uint32_t ring = sine < WD_EYE_RING_SINE(1u) ? 0u
                    : sine < WD_EYE_RING_SINE(2u) ? 1u : sine < WD_EYE_RING_SINE(3u) ? 2u : 3u;
    float low = WD_EYE_RING_SINE(ring), high = WD_EYE_RING_SINE(ring + 1u);
    return ring | WD_UINT((sine - low) / (high - low) * 65535.0f + 0.5f) << 8;
}

WD_FUNC uint32_t wd_sunlit_place(uint32_t eye_ring, uint32_t sun_ring, uint32_t turn)
{
    return (sun_ring * WD_EYE_RINGS + eye_ring) * WD_SUNLIT_TURNS + turn;
}

/* What light asks of a model, fetched as texels of four words: software devices do that for all lanes at
 * once. */
struct wd_lit_leaves {
    uint32_t base_petals;         /* two half floats: height of the lowest living branch, of the tree's; and of plants
                                     in flower the green albedo of leaves, below 0 where they are plumes; else 0 */
    uint32_t cloud_wax;           /* two half floats, as of struct wd_tree_model */
    uint32_t sun_curve;           /* of wd_crown_lit: two half floats */
    uint32_t paler;               /* WD_PALER_*: albedo of leaves' lower sides over that of the upper ones */
    uint32_t through;             /* WD_PALER_*: transmittance of a leaf over its upper side's albedo, linear; and
                                     WD_THROUGH_ALL_LEAVES */
    uint32_t again_low;           /* two half floats: recollision and low_sky of struct wd_tree_model */
    uint32_t near_shade;          /* at WD_NEAR_SHADE_M, and the power: two half floats */
    uint32_t rough_flat;          /* two half floats: roughness of leaves, the root of GGX's alpha, minus that of a grass's
                                     blades, and less 1 where these close over the ground; and struct wd_tree_model's
                                     flatness, of needles that of leaves turned every way */
};

#ifdef __STDC_VERSION__
#define WD_LIT_LEAVES_STRUCT struct wd_lit_leaves
#else
#define WD_LIT_LEAVES_STRUCT wd_lit_leaves
#endif

struct wd_lit_model {
    WD_LIT_LEAVES_STRUCT leaves;
    /* A texel for each wd_sunlit_place and of each WD_SUNLIT_CARDS .. WD_SUNLIT_LEAVES: two half floats of that place,
     * of a turn on, of a ring of the eye on, and of both on. */
    uint32_t sunlit[4 * WD_SUNLIT_PLACES * 4];
    uint32_t skylit[WD_SKYLIT_PLACES * 4]; /* two half floats each: of a place, and of a ring on */
    /* A texel for each ring of the eye: what reflects, and of a ring on, and what transmits, and of a ring on. Bytes of
     * one for each ring of the sun, then, beside what reflects, what is seen, and beside what transmits, what is mirrored,
     * of WD_UPPER_MIRRORS_MOST. */
    uint32_t upper[4 * WD_EYE_RINGS];
    uint32_t sky_wax[2], open[2]; /* WD_UPPER_SKY_WAX, of its most, and WD_UPPER_OPEN: a byte for each ring of the eye */
};
WD_STATIC_ASSERT_SIZE(wd_lit_model, 9328);
#define WD_LIT_LEAVES_TEXELS 2u
#define WD_LIT_SKYLIT_TEXEL 562u
#define WD_LIT_UPPER_TEXEL 577u
#define WD_LIT_RINGS_TEXEL 582u
#define WD_LIT_MODEL_TEXELS 583u

#endif
