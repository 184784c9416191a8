/* damage.h: damaged files for tests, the same on every machine. */
#ifndef WD_TESTS_DAMAGE_H
#define WD_TESTS_DAMAGE_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

static inline uint32_t damage_next(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

/* One to five faults: a byte, a bit, bytes that are gone, moved, or one of the pieces, of up to 32 bytes each. */
static inline void damage(void *file, size_t *size, uint32_t *seed, const char *const *pieces, uint32_t piece_count)
{
    uint8_t *bytes = file;
    uint32_t count = 1 + damage_next(seed) % 5;
    for (uint32_t i = 0; i < count && *size > 40; i++) {
        size_t at = damage_next(seed) % (*size - 32), span = damage_next(seed) % 32;
        switch (damage_next(seed) % 5) {
        case 0: bytes[at] = (uint8_t)damage_next(seed); break;
        case 1: bytes[at] ^= (uint8_t)(1u << damage_next(seed) % 8); break;
        case 2:
            memmove(bytes + at, bytes + at + span, *size - at - span);
            *size -= span;
            break;
        case 3: memmove(bytes + at, bytes + damage_next(seed) % (*size - 32), span); break;
        default: {
            const char *piece = pieces[damage_next(seed) % piece_count];
            memcpy(bytes + at, piece, strlen(piece));
        }
        }
    }
}

/* Cuts it off somewhere, one time in `every`. */
static inline void damage_end(size_t *size, uint32_t *seed, uint32_t every)
{
    if (damage_next(seed) % every == 0)
        *size = damage_next(seed) % (*size + 1);
}

#endif
