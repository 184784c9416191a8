/* looks.h: bark and leaf textures of every species, with mips. */
#ifndef WD_FOREST_LOOKS_H
#define WD_FOREST_LOOKS_H

#include "bake/cache.h"
#include "bake/cards.h"

/* Bytes of one map, WD_LOOK_SIZE square; of one species' albedo, or detail, in all layers; and of
 * both, albedo first. */
#define WD_LOOK_MAP_BYTES ((size_t)4 * WD_LOOK_SIZE * WD_LOOK_SIZE)
#define WD_LOOK_HALF_BYTES (WD_LOOK_LAYERS * WD_LOOK_MAP_BYTES)
#define WD_LOOK_BYTES (2 * WD_LOOK_HALF_BYTES)

/* One species' textures, from the cache or generated and put into it; `rgba` holds
 * WD_LOOK_BYTES. */
void wd_look_get(uint8_t *rgba, struct wd_bake_cache *cache, const struct wd_species *species);

/* Images of WD_LOOK_LAYERS * species_count layers with all mips; `rgba` holds species_count *
 * WD_LOOK_BYTES. */
bool wd_looks_upload(struct wd_image *image, struct wd_gpu *gpu, const uint8_t *rgba,
                     uint32_t species_count);
bool wd_look_details_upload(struct wd_image *image, struct wd_gpu *gpu, const uint8_t *rgba,
                            uint32_t species_count);

#endif
