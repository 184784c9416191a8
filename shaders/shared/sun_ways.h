/* sun_ways.h: the ways over the upper half of the sky along which a tree's own shade is known, a bit
 * each, on rings 10, 35, 62 and 90 degrees up; between them it is mixed. */
#ifndef WD_SHARED_SUN_WAYS_H
#define WD_SHARED_SUN_WAYS_H

#include "shared/vec.h"

#define WD_SUN_WAYS 32u
#define WD_SUN_RINGS 4u
#define WD_SUN_RING_COUNT(ring) ((ring) == 0u ? 13u : (ring) == 1u ? 11u : (ring) == 2u ? 7u : 1u)
#define WD_SUN_RING_FIRST(ring) ((ring) == 0u ? 0u : (ring) == 1u ? 13u : (ring) == 2u ? 24u : 31u)
#define WD_SUN_RING_SINE(ring)                                                                     \
    ((ring) == 0u ? 0.17365f : (ring) == 1u ? 0.57358f : (ring) == 2u ? 0.88295f : 1.0f)

/* Toward the sky along a way, in a model's axes. */
WD_FUNC WD_VECTOR wd_sun_way(uint32_t way)
{
    uint32_t ring = way < 13u ? 0u : way < 24u ? 1u : way < 31u ? 2u : 3u;
    float turn = WD_FLOAT(way - WD_SUN_RING_FIRST(ring)) / WD_FLOAT(WD_SUN_RING_COUNT(ring));
    float sine = WD_SUN_RING_SINE(ring), level = WD_SQRT(WD_MAX(1.0f - sine * sine, 0.0f));
    return WD_V3(level * WD_COS(6.2831853f * turn), level * WD_SIN(6.2831853f * turn), sine);
}

/* Two neighbours on a ring, five bits each, and above them how near the second is, in fifteenths. */
WD_FUNC uint32_t wd_sun_ring_mix(uint32_t ring, float turn)
{
    uint32_t count = WD_SUN_RING_COUNT(ring), first = WD_SUN_RING_FIRST(ring);
    float at = turn * WD_FLOAT(count);
    uint32_t low = WD_UINT(at), high = low + 1u;
    uint32_t share = WD_UINT((at - WD_FLOAT(low)) * 15.0f + 0.5f);
    low = low < count ? low : 0u;
    high = high < count ? high : 0u;
    return (first + low) | (first + high) << 5 | share << 10;
}

/* The four ways around a direction, and how much of each is in it: a ring's mix, the next one's 14 bits
 * above, and how near that is. Below the lowest ring it counts alone. */
WD_FUNC uint32_t wd_sun_mix(WD_VECTOR toward)
{
    float turn = WD_ATAN2(toward.y, toward.x) * 0.15915494f;
    turn = turn - WD_FLOOR(turn);
    float sine = WD_CLAMP(toward.z, WD_SUN_RING_SINE(0u), 1.0f);
    uint32_t ring = sine < WD_SUN_RING_SINE(1u) ? 0u : sine < WD_SUN_RING_SINE(2u) ? 1u : 2u;
    float low = WD_SUN_RING_SINE(ring), high = WD_SUN_RING_SINE(ring + 1u);
    uint32_t share = WD_UINT((sine - low) / (high - low) * 15.0f + 0.5f);
    return wd_sun_ring_mix(ring, turn) | wd_sun_ring_mix(ring + 1u, turn) << 14 | share << 28;
}

/* One of the four by lot, as often as it has a share. Eight bits of `random` count. */
WD_FUNC uint32_t wd_sun_way_by_lot(uint32_t mix, uint32_t random)
{
    uint32_t ring = (random & 15u) * 15u < (mix >> 28) * 16u ? mix >> 14 : mix;
    return ((random >> 4 & 15u) * 15u < (ring >> 10 & 15u) * 16u ? ring >> 5 : ring) & 31u;
}

WD_FUNC float wd_sun_way_lit(uint32_t lit, uint32_t way)
{
    return WD_FLOAT(lit >> (way & 31u) & 1u);
}

WD_FUNC float wd_sun_ring_lit(uint32_t lit, uint32_t mix)
{
    float low = wd_sun_way_lit(lit, mix), high = wd_sun_way_lit(lit, mix >> 5);
    return low + (high - low) * (WD_FLOAT(mix >> 10 & 15u) * (1.0f / 15.0f));
}

/* Share of the sun that reaches a place of whose ways those are lit, a bit each. */
WD_FUNC float wd_sun_lit(uint32_t lit, uint32_t mix)
{
    float low = wd_sun_ring_lit(lit, mix), high = wd_sun_ring_lit(lit, mix >> 14);
    return low + (high - low) * (WD_FLOAT(mix >> 28) * (1.0f / 15.0f));
}

#endif
