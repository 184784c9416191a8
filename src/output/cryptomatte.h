/* cryptomatte.h: ids of objects in EXR files as other programs read them: Cryptomatte specification
 * 1.2 (Friedman and Jones 2015, "Fully automatic ID mattes with support for motion blur and
 * transparency"). */
#ifndef WD_OUTPUT_CRYPTOMATTE_H
#define WD_OUTPUT_CRYPTOMATTE_H

#include <stddef.h>

#include "weald/types.h"

/* MurmurHash3 (Appleby), 32 bits, seed 0. */
uint32_t wd_murmur3(const void *data, size_t size);

/* A name's hash as the bits of a float that is neither denormal nor infinite nor NaN. */
uint32_t wd_cryptomatte_id(const char *name);

/* Trees of one picture, each under a float of its own. */
struct wd_cryptomatte {
    struct wd_cryptomatte_tree {
        uint32_t tree;  /* its id */
        uint32_t bits;  /* of the float that stands for it */
        uint32_t tries; /* how often its name had to be lengthened, since another tree has the float */
    } *trees;           /* by rising id */
    size_t count;
};

/* For all of `ids`, of which any may stand there more than once; 0 is no tree. */
void wd_cryptomatte_init(struct wd_cryptomatte *matte, const uint32_t *ids, size_t count);
void wd_cryptomatte_finish(struct wd_cryptomatte *matte); /* accepts {0} */

/* The float of a tree that the picture shows; 0 for id 0. */
float wd_cryptomatte_find(const struct wd_cryptomatte *matte, uint32_t id);

/* JSON object from names ("tree_123") to floats' bits in hexadecimal; free() it. */
char *wd_cryptomatte_manifest(const struct wd_cryptomatte *matte);

#endif
