#include "tree/progressive.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "shared/hash.h"
#include "tree/radix.h"

enum { CURVE_BITS = 10 };

static uint32_t reverse_bits(uint32_t x)
{
    x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
    x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
    x = (x >> 4 & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4;
    x = (x >> 8 & 0x00ff00ffu) | (x & 0x00ff00ffu) << 8;
    return x >> 16 | x << 16;
}

/* Nested scrambling: whether a digit flips depends on all digits before it and on nothing else
 * (Owen 1995). In reversed order the digits before are the lower bits, and a multiplication by an
 * even number, added or xored in, only carries upward (Laine and Karras 2011; constants of Vegdahl
 * 2021). */
uint32_t wd_scrambled_radical(uint32_t index, uint32_t key)
{
    uint32_t x = index;
    x ^= x * 0x3d20adeau;
    x += wd_hash1(key);
    x *= (wd_hash1(key) >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return reverse_bits(x);
}

/* Bit i to bit 3 i, of CURVE_BITS bits. */
static inline uint32_t spread_bits(uint32_t x)
{
    x = (x | x << 16) & 0x030000ffu;
    x = (x | x << 8) & 0x0300f00fu;
    x = (x | x << 4) & 0x030c30c3u;
    return (x | x << 2) & 0x09249249u;
}

enum { BATCH = 32 };

/* Places along Hilbert's curve in three dimensions (Skilling, AIP Conf. Proc. 707, 2004), of many
 * points at a time; masks in place of branches. */
static void curve_batch(uint32_t place[BATCH], uint32_t x[3][BATCH])
{
    for (int bit = CURVE_BITS - 1; bit > 0; bit--) {
        uint32_t p = (1u << bit) - 1;
        for (int i = 0; i < 3; i++)
            for (int n = 0; n < BATCH; n++) {
                uint32_t set = 0u - (x[i][n] >> bit & 1);
                uint32_t swapped = (x[0][n] ^ x[i][n]) & p & ~set;
                x[0][n] ^= (p & set) ^ swapped;
                x[i][n] ^= swapped;
            }
    }
    for (int n = 0; n < BATCH; n++) {
        x[1][n] ^= x[0][n];
        x[2][n] ^= x[1][n];
        uint32_t turned = x[2][n] >> 1; /* bit by bit: how many higher ones are set, odd or even */
        for (int shift = 1; shift < CURVE_BITS; shift *= 2)
            turned ^= turned >> shift;
        place[n] = spread_bits(x[0][n] ^ turned) << 2 | spread_bits(x[1][n] ^ turned) << 1 |
                   spread_bits(x[2][n] ^ turned);
    }
}

/* Broken coordinates end in the first cell. */
static uint32_t curve_cell(float x)
{
    return x > 0 && x < (float)(1 << CURVE_BITS) ? (uint32_t)x : 0;
}

static void curve_places(uint32_t *places, const struct wd_vec3 *points, size_t count)
{
    struct wd_vec3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < count; i++) { /* numbers alone */
        low = wd_v3_min(points[i], low);
        high = wd_v3_max(points[i], high);
    }
    struct wd_vec3 size = wd_v3_sub(high, low);
    float side = fmaxf(fmaxf(size.x, size.y), fmaxf(size.z, 1e-6f));
    float scale = (float)((1 << CURVE_BITS) - 1) / side;
    for (size_t first = 0; first < count; first += BATCH) {
        size_t some = count - first < BATCH ? count - first : BATCH;
        uint32_t cells[3][BATCH] = {0}, found[BATCH];
        for (size_t i = 0; i < some; i++) {
            struct wd_vec3 p = wd_v3_scale(wd_v3_sub(points[first + i], low), scale);
            cells[0][i] = curve_cell(p.x);
            cells[1][i] = curve_cell(p.y);
            cells[2][i] = curve_cell(p.z);
        }
        curve_batch(found, cells);
        memcpy(places + first, found, some * sizeof *found);
    }
}

void wd_curve_order(uint32_t *order, const struct wd_vec3 *points, size_t count)
{
    if (count == 0)
        return;
    uint32_t *places = wd_alloc_array(count, sizeof *places);
    curve_places(places, points, count);
    wd_radix_order(order, places, count);
    free(places);
}

/* The curve is cut into 2^k >= count equal parts, each with at most one point, and the parts are
 * visited in the order of the scrambled sequence. */
void wd_progressive_order(uint32_t *order, const struct wd_vec3 *points, size_t count,
                          uint32_t key)
{
    int bits = 0;
    while (((size_t)1 << bits) < count)
        bits++;
    size_t parts = (size_t)1 << bits, filled = 0;
    uint32_t *along = wd_alloc_array(count ? count : 1, sizeof *along);
    uint32_t *held = wd_alloc_array(parts, sizeof *held); /* 1 + index, 0 none */
    wd_curve_order(along, points, count);
    for (size_t i = 0; i < count; i++)
        held[i * parts / count] = along[i] + 1;
    for (size_t i = 0; i < parts; i++) {
        uint32_t part = (uint32_t)((uint64_t)wd_scrambled_radical((uint32_t)i, key) >> (32 - bits));
        if (held[part])
            order[filled++] = held[part] - 1;
    }
    free(along);
    free(held);
}
