/* radix.h: the order of numbers. */
#ifndef WD_TREE_RADIX_H
#define WD_TREE_RADIX_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* Fills order[count] with the places of the keys from the least on; of equal ones the first first. */
void wd_radix_order(uint32_t *order, const uint32_t *keys, size_t count);

/* Grows as a number does that is one. */
static inline uint32_t wd_radix_key(float number)
{
    uint32_t bits;
    number += 0.0f; /* of two zeros one */
    memcpy(&bits, &number, sizeof bits);
    return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

#endif
