#include "tree/radix.h"

#include <stdlib.h>

#include "base/memory.h"

enum { DIGIT_BITS = 8, DIGITS = 1 << DIGIT_BITS, PASSES = 32 / DIGIT_BITS };

struct item {
    uint32_t key, place;
};

static uint32_t digit_of(uint32_t key, int pass)
{
    return key >> (pass * DIGIT_BITS) & (DIGITS - 1);
}

/* One stable pass; `first` counts the items of each digit. */
static void sort_digit(struct item *to, const struct item *from, size_t count, int pass,
                       uint32_t first[DIGITS])
{
    uint32_t sum = 0;
    for (int digit = 0; digit < DIGITS; digit++) {
        uint32_t of = first[digit];
        first[digit] = sum;
        sum += of;
    }
    for (size_t i = 0; i < count; i++)
        to[first[digit_of(from[i].key, pass)]++] = from[i];
}

void wd_radix_order(uint32_t *order, const uint32_t *keys, size_t count)
{
    uint32_t counts[PASSES][DIGITS] = {0};
    struct item *items = wd_alloc_array(2 * count + 1, sizeof *items);
    struct item *from = items, *to = items + count;
    for (size_t i = 0; i < count; i++) {
        from[i] = (struct item){keys[i], (uint32_t)i};
        for (int pass = 0; pass < PASSES; pass++)
            counts[pass][digit_of(keys[i], pass)]++;
    }
    for (int pass = 0; pass < PASSES; pass++) {
        sort_digit(to, from, count, pass, counts[pass]);
        struct item *sorted = to;
        to = from;
        from = sorted;
    }
    for (size_t i = 0; i < count; i++)
        order[i] = from[i].place;
    free(items);
}
