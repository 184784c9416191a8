/* looks.h: bark and leaf textures of every species, with mips. */
#ifndef WD_FOREST_LOOKS_H
#define WD_FOREST_LOOKS_H

#include "bake/cards.h"

/* Bytes of one species' textures: bark, then leaf, each WD_LOOK_SIZE square, RGBA8 sRGB. */
#define WD_LOOK_BYTES ((size_t)2 * 4 * WD_LOOK_SIZE * WD_LOOK_SIZE)

/* Generates one species' textures; `rgba` holds WD_LOOK_BYTES. */
void wd_look_generate(const struct wd_species *species, uint8_t *rgba);

/* An image of 2 * species_count layers with all mips; `rgba` holds species_count * WD_LOOK_BYTES. */
bool wd_looks_upload(struct wd_image *image, struct wd_gpu *gpu, const uint8_t *rgba,
                     uint32_t species_count);

#endif
