/* card_filter.h: from supersampled renders to texels with mips that keep coverage. */
#ifndef WD_BAKE_CARD_FILTER_H
#define WD_BAKE_CARD_FILTER_H

#include "bake/cards.h"

enum { WD_CARD_SUPERSAMPLING = 4 };

/* Filters one card. `albedo` (sRGB) and `normal` are renders of WD_CARD_WIDTH x WD_CARD_HEIGHT
 * texels times WD_CARD_SUPERSAMPLING squared, 4 bytes a sample; albedo's A is 255 where something
 * was drawn and 0 elsewhere. Writes every mip of `card` into `cards`. */
void wd_card_filter(struct wd_cards *cards, uint32_t card, const uint8_t *albedo,
                    const uint8_t *normal);

#endif
