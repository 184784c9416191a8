/* random.h: streams of random numbers. A stream is named by a key; keys of parts are derived from
 * the key of the whole, so that a change in one part of a tree leaves the others as they were. */
#ifndef WD_TREE_RANDOM_H
#define WD_TREE_RANDOM_H

#include "shared/hash.h"
#include "tree/vec.h"

struct wd_random {
    uint32_t key, next;
};

static inline struct wd_random wd_random_of(uint32_t key, uint32_t purpose)
{
    return (struct wd_random){wd_hash2(key, purpose), 0};
}

static inline uint32_t wd_random_bits(struct wd_random *random)
{
    return wd_hash2(random->key, random->next++);
}

static inline float wd_random_unit(struct wd_random *random) /* [0, 1) */
{
    return wd_hash_unit(wd_random_bits(random));
}

static inline float wd_random_signed(struct wd_random *random) /* [-1, 1) */
{
    return 2 * wd_random_unit(random) - 1;
}

static inline float wd_random_range(struct wd_random *random, float low, float high)
{
    return low + (high - low) * wd_random_unit(random);
}

/* A vector inside the cube of half side 1. */
static inline struct wd_vec3 wd_random_vec3(struct wd_random *random)
{
    float x = wd_random_signed(random), y = wd_random_signed(random);
    return WD_V3(x, y, wd_random_signed(random));
}

/* Smooth noise of unit lattice spacing, 0..1. */
float wd_noise3(uint32_t key, struct wd_vec3 p);

#endif
