/* pyramid.h: mips of baked pictures that keep coverage. Sums are weighted by coverage and colours
 * are averaged as linear light; texels that show nothing take their parents' looks without
 * opacity, so that filtering never darkens an edge. */
#ifndef WD_BAKE_PYRAMID_H
#define WD_BAKE_PYRAMID_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "bake/mixed.h"
#include "shared/view_set.h"

enum { WD_PYRAMID_MIPS = 12 };

struct wd_pyramid_level {
    uint32_t width, height;
    struct wd_pyramid_texel *texels;
};
struct wd_pyramid {
    struct wd_pyramid_level levels[WD_PYRAMID_MIPS];
    uint32_t mips;
};

/* Sides are powers of two; each mip halves both, down to 1. Serves any number of pictures. */
void wd_pyramid_init(struct wd_pyramid *pyramid, uint32_t width, uint32_t height, uint32_t mips);
void wd_pyramid_finish(struct wd_pyramid *pyramid);

/* Takes a finest mip: WD_PLANES images of 4 bytes a texel, one after the other. */
void wd_pyramid_set(struct wd_pyramid *pyramid, const uint8_t *planes);

/* Writes a mip of a plane (WD_PLANE_*) at `out`, rows `stride` bytes apart. */
void wd_pyramid_get(const struct wd_pyramid *pyramid, uint32_t mip, int plane, uint8_t *out,
                    size_t stride);

/* What tells wood and leaves of a mip apart. `leaves`: what leaves alone show, of struct wd_bake_picture. */
void wd_pyramid_tell_mixed(const struct wd_pyramid *pyramid, uint32_t mip, const double leaves[WD_MIXED_KINDS],
                           struct wd_mixed_sums *sums);

#endif
