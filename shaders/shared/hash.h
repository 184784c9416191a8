/* hash.h: random numbers as a function of where and what for, alike on CPU and GPU.
 *
 * Integer operations only, so that both sides agree to the bit. Every argument is mixed by itself
 * before it is folded in: rows of a grid, wd_hash2(row, column), are then never shifted copies of
 * one another, as they would be with mix(mix(row) + column). Give each use of a number its own
 * last argument (a purpose), so that no two uses are correlated. */
#ifndef WD_SHARED_HASH_H
#define WD_SHARED_HASH_H

#include "shared/types.h"

/* A bijection of 32 bits: xor-shift and multiply, after Wellons' "hash prospector" (bias 0.17). */
WD_FUNC uint32_t wd_hash_mix(uint32_t h)
{
    h ^= h >> 16;
    h *= 0x7feb352du;
    h ^= h >> 15;
    h *= 0x846ca68bu;
    h ^= h >> 16;
    return h;
}

WD_FUNC uint32_t wd_hash1(uint32_t a)
{
    return wd_hash_mix(a + 0x9e3779b9u);
}

WD_FUNC uint32_t wd_hash2(uint32_t a, uint32_t b)
{
    return wd_hash_mix(wd_hash1(a) ^ wd_hash_mix(b + 0x85ebca6bu));
}

WD_FUNC uint32_t wd_hash3(uint32_t a, uint32_t b, uint32_t c)
{
    return wd_hash_mix(wd_hash2(a, b) ^ wd_hash_mix(c + 0xc2b2ae35u));
}

WD_FUNC uint32_t wd_hash4(uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    return wd_hash_mix(wd_hash3(a, b, c) ^ wd_hash_mix(d + 0x27d4eb2fu));
}

/* The upper 24 bits as a number in [0, 1): exact in a float, the same on both sides. */
WD_FUNC float wd_hash_unit(uint32_t h)
{
    float bits = h >> 8;
    return bits * 5.9604644775390625e-8f; /* 2^-24 */
}

#endif
