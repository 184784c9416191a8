/* bloom.h: light spread by the lens: a pyramid of halved pictures, added up again. Levels lie one
 * after the other in a buffer of vec4. */
#ifndef WD_SHARED_BLOOM_H
#define WD_SHARED_BLOOM_H

#include "shared/vec.h"

#define WD_BLOOM_LEVELS 6

struct wd_bloom_level {
    uint32_t first;         /* texel in the buffer */
    uint32_t width, height;
};

struct wd_bloom_push {
    WD_STRUCT wd_bloom_level from, to;
};

#endif
