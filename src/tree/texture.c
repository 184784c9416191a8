#include "tree/grow.h"

#include <stdlib.h>

#include "base/memory.h"
#include "tree/look_map.h"

static void fill_albedo(const struct wd_species *species, uint32_t layer, uint32_t size,
                        uint8_t *rgba)
{
    struct wd_look_map map = {size, rgba, wd_alloc_array((size_t)size * size, 4)};
    wd_look_map_fill(&map, species, layer);
    free(map.detail);
    for (size_t i = 0; i < (size_t)size * size; i++)
        rgba[4 * i + 3] = 255;
}

void wd_species_bark_texture(const struct wd_species *species, uint32_t size, uint8_t *rgba)
{
    fill_albedo(species, WD_LOOK_BARK, size, rgba);
}

void wd_species_leaf_texture(const struct wd_species *species, uint32_t size, uint8_t *rgba)
{
    fill_albedo(species, WD_LOOK_LEAF, size, rgba);
}
