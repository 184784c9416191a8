/* mixed.h: a texel of a picture of a tree holds the mean colour and openness of the leaves and the wood that it shows.
 * A pixel of it is the one or the other: what that has by itself follows from how much of the texel is leaf, and from
 * how wood differs from leaves where both are mixed, a figure of each set of pictures. The mean is kept. */
#ifndef WD_SHARED_MIXED_H
#define WD_SHARED_MIXED_H

#include "shared/vec.h"

#define WD_MIXED_KINDS 4 /* red, green, blue, openness */
#define WD_MIXED_EVEN 0x80808080u /* wood like leaves */
/* Ratios from an eighth to eight: 128 is 1, 42 steps twice as much. */
#define WD_MIXED_OCTAVE 42.0f

WD_FUNC float wd_mixed_ratio(uint32_t ratios, uint32_t kind)
{
    return WD_EXP2((WD_FLOAT(ratios >> (8u * kind) & 0xffu) - 128.0f) / WD_MIXED_OCTAVE);
}

/* What leaves have, of a mean of both. */
WD_FUNC float wd_mixed_leaf(float mean, float leaf, float ratio)
{
    return mean / (leaf + (1.0f - leaf) * ratio);
}

WD_FUNC uint32_t wd_mixed_byte(float ratio)
{
    return WD_UINT(128.5f + WD_MIXED_OCTAVE * WD_LOG2(WD_CLAMP(ratio, 0.125f, 8.0f)));
}

#endif
