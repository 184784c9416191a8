/* four.h: four numbers at a time. Each operation is that of single floats, so results are the same
 * with or without such instructions. */
#ifndef WD_TREE_FOUR_H
#define WD_TREE_FOUR_H

#include <stdint.h>
#include <string.h>

#ifdef __SSE__
#include <xmmintrin.h>
#endif

#include "tree/vec.h"

/* Compiled for AVX2 too, which the processor is asked for: the same operations, with fewer moves
 * between registers. clang has no such clones of functions that others are put into. */
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define WD_FOUR_TWICE __attribute__((target_clones("avx2", "default"), flatten))
#else
#define WD_FOUR_TWICE
#endif

typedef float wd_four __attribute__((vector_size(16)));
typedef int32_t wd_four_ints __attribute__((vector_size(16)));

static inline wd_four wd_four_of(float a)
{
    return (wd_four){a, a, a, a};
}

static inline wd_four wd_four_load(const float *from)
{
    wd_four a;
    memcpy(&a, from, sizeof a);
    return a;
}

static inline wd_four wd_four_choose(wd_four_ints where, wd_four a, wd_four b)
{
    return (wd_four)((where & (wd_four_ints)a) | (~where & (wd_four_ints)b));
}

/* The second where one of them is no number. */
static inline wd_four wd_four_min(wd_four a, wd_four b)
{
#ifdef __SSE__
    return (wd_four)_mm_min_ps((__m128)a, (__m128)b);
#else
    return wd_four_choose(a < b, a, b);
#endif
}

static inline wd_four wd_four_max(wd_four a, wd_four b)
{
#ifdef __SSE__
    return (wd_four)_mm_max_ps((__m128)a, (__m128)b);
#else
    return wd_four_choose(a > b, a, b);
#endif
}

static inline wd_four wd_four_root(wd_four a)
{
#ifdef __SSE__
    return (wd_four)_mm_sqrt_ps((__m128)a);
#else
    return (wd_four){sqrtf(a[0]), sqrtf(a[1]), sqrtf(a[2]), sqrtf(a[3])};
#endif
}

static inline wd_four wd_four_abs(wd_four a)
{
    return (wd_four)((wd_four_ints)a & 0x7fffffff);
}

/* Toward zero. */
static inline wd_four_ints wd_four_truncate(wd_four a)
{
    return __builtin_convertvector(a, wd_four_ints);
}

static inline wd_four wd_four_convert(wd_four_ints a)
{
    return __builtin_convertvector(a, wd_four);
}

/* The first three numbers of each of four rows, column by column. */
static inline void wd_four_columns(wd_four columns[3], const wd_four rows[4])
{
    wd_four low = __builtin_shufflevector(rows[0], rows[1], 0, 4, 1, 5);
    wd_four high = __builtin_shufflevector(rows[2], rows[3], 0, 4, 1, 5);
    columns[0] = __builtin_shufflevector(low, high, 0, 1, 4, 5);
    columns[1] = __builtin_shufflevector(low, high, 2, 3, 6, 7);
    low = __builtin_shufflevector(rows[0], rows[1], 2, 6, 2, 6);
    high = __builtin_shufflevector(rows[2], rows[3], 2, 6, 2, 6);
    columns[2] = __builtin_shufflevector(low, high, 0, 1, 4, 5);
}

/* Four vectors. */
struct wd_four_vec3 {
    wd_four x, y, z;
};

static inline wd_four wd_four_dot(const struct wd_four_vec3 *a, struct wd_vec3 b)
{
    return a->x * b.x + a->y * b.y + a->z * b.z;
}

#endif
