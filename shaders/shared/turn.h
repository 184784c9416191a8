/* turn.h: how far round the look-ups of a penumbra are turned from pixel to pixel and sample to sample. */
#ifndef WD_SHARED_TURN_H
#define WD_SHARED_TURN_H

#include "shared/hash.h"

#ifdef __STDC_VERSION__
WD_FUNC uint32_t bitfieldReverse(uint32_t bits)
{
    uint32_t reversed = 0;
    for (int i = 0; i < 32; i++)
        reversed |= (bits >> i & 1u) << (31 - i);
    return reversed;
}
#endif

/* In circles. A disc turns by the golden angle from look-up to look-up, which samples must not: all of them would look
 * along the same few rays, and what is narrower than the penumbra shows as a hatch. They halve the circle, and halve it
 * again (van der Corput); four pixels that lie together share what four samples leave of it, in any order, and begin
 * anywhere. */
WD_FUNC float wd_pixel_turn(uint32_t x, uint32_t y, uint32_t sample_index)
{
    uint32_t h = wd_hash2(x >> 1, y >> 1);
    uint32_t place = ((x & 1u) | (y & 1u) << 1) ^ h >> 30;
    float turn = 0.3125f * place + (h & 0xffffu) * (1.0f / 65536.0f);
    return turn + bitfieldReverse(sample_index) * 2.3283064e-10f;
}

#endif
