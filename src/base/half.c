#include "base/half.h"

#include <string.h>

uint16_t wd_half_of(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    uint32_t sign = bits >> 16 & 0x8000u, magnitude = bits & 0x7fffffffu;
    if (magnitude < 0x38800000u)
        return (uint16_t)sign;
    if (magnitude > 0x477fe000u)
        magnitude = 0x477fe000u;
    return (uint16_t)(sign | ((magnitude - 0x38000000u + 0x0fffu + (magnitude >> 13 & 1)) >> 13));
}
