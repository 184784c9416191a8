/* bytes.h: numbers in files, little-endian whatever the machine. */
#ifndef WD_BASE_BYTES_H
#define WD_BASE_BYTES_H

#include <stdint.h>

static inline void wd_put_u64(uint8_t *at, uint64_t value)
{
    for (int i = 0; i < 8; i++)
        at[i] = (uint8_t)(value >> (8 * i));
}

static inline uint64_t wd_get_u64(const uint8_t *at)
{
    uint64_t value = 0;
    for (int i = 0; i < 8; i++)
        value |= (uint64_t)at[i] << (8 * i);
    return value;
}

#endif
