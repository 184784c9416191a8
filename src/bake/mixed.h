/* mixed.h: texels hold the mean of the leaves and the wood that they show. How wood differs from leaves where both are
 * mixed, so that a pixel that shows the one or the other can have its own (shared/mixed.h). */
#ifndef WD_BAKE_MIXED_H
#define WD_BAKE_MIXED_H

#include <stdint.h>

#include "shared/mixed.h"

/* Sums over the texels of a picture at one mip, by coverage: of all that they show, by its share of leaves (of 255), and
 * of leaves alone. */
struct wd_mixed_sums {
    double all[256][WD_MIXED_KINDS], leaves[WD_MIXED_KINDS];
};

/* Of wood over leaves, packed as wd_mixed_ratio has it, over `count` of them: those with which leaves have what they have
 * in `leaves`, and so wood what is left. 1 where there is but the one. */
uint32_t wd_mixed_ratios(const struct wd_mixed_sums *sums, uint32_t count);

#endif
