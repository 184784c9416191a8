/* sampler.h: points for one path, a function of pixel and sample only: Sobol' points, shuffled and
 * scrambled by hashes (Burley 2020, "Practical hash-based Owen scrambling", JCGT 9 (4)), so that any
 * number of samples, in any order and on any number of threads, gives the same well-spread set. */
#ifndef WD_REFERENCE_SAMPLER_H
#define WD_REFERENCE_SAMPLER_H

#include "shared/hash.h"

struct wd_sampler {
    uint32_t seed; /* of the pixel */
    uint32_t index;
    uint32_t dimension;
};

/* Points of two streams have nothing in common. */
static inline struct wd_sampler wd_sampler_of(uint32_t x, uint32_t y, uint32_t stream,
                                              uint32_t index)
{
    uint32_t pixel = wd_hash2(x, y);
    return (struct wd_sampler){stream ? wd_hash2(pixel, stream) : pixel, index, 0};
}

static inline uint32_t wd_reverse_bits(uint32_t x)
{
    x = (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
    x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
    x = (x & 0x0f0f0f0fu) << 4 | (x >> 4 & 0x0f0f0f0fu);
    return __builtin_bswap32(x);
}

/* Owen's nested scrambling by a hash in which each bit depends on those below it only (Laine and
 * Karras 2011), on the reversed number. */
static inline uint32_t wd_owen_scramble(uint32_t x, uint32_t seed)
{
    x = wd_reverse_bits(x);
    x += seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return wd_reverse_bits(x);
}

/* The second dimension of Sobol's sequence; the first is the number reversed. */
static inline uint32_t wd_sobol_second(uint32_t index)
{
    uint32_t x = 0;
    for (uint32_t v = 1u << 31; index; index >>= 1, v ^= v >> 1)
        if (index & 1)
            x ^= v;
    return x;
}

/* The next two numbers, 0 <= point < 1. */
static inline void wd_sampler_next(struct wd_sampler *sampler, float point[2])
{
    uint32_t seed = wd_hash2(sampler->seed, sampler->dimension++);
    uint32_t index = wd_owen_scramble(sampler->index, seed);
    point[0] = wd_hash_unit(wd_owen_scramble(wd_reverse_bits(index), wd_hash1(seed)));
    point[1] = wd_hash_unit(wd_owen_scramble(wd_sobol_second(index), wd_hash2(seed, 1)));
}

#endif
