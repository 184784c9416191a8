#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "tree/export.h"
#include "tree/look_map.h"
#include "tree/model_image.h"

/* Ours: x along u, y along v, which runs down; glTF's green points up. */
static void normal_texel(const uint8_t *detail, uint8_t *rgba)
{
    float x = detail[0] * (2.0f / 255) - 1, y = detail[1] * (2.0f / 255) - 1;
    float z = sqrtf(fmaxf(1 - x * x - y * y, 0));
    rgba[0] = detail[0];
    rgba[1] = (uint8_t)(255 - detail[1]);
    rgba[2] = (uint8_t)((z + 1) * 127.5f + 0.5f);
    rgba[3] = 255;
}

static void surface_texel(const uint8_t *detail, uint8_t *rgba)
{
    const uint8_t texel[4] = {255, detail[2], 0, 255};
    memcpy(rgba, texel, sizeof texel);
}

static uint8_t *encode_details(const uint8_t *detail, uint32_t size,
                               void (*convert)(const uint8_t *, uint8_t *), size_t *bytes)
{
    struct wd_model_image image = {size, size, wd_alloc((size_t)4 * size * size)};
    for (size_t i = 0; i < (size_t)size * size; i++)
        convert(detail + 4 * i, image.rgba + 4 * i);
    uint8_t *png = wd_model_image_encode(&image, bytes);
    wd_model_image_finish(&image);
    return png;
}

bool wd_export_maps_make(struct wd_export_maps *maps, const struct wd_species *species,
                         uint32_t layer, uint32_t size)
{
    *maps = (struct wd_export_maps){0};
    size_t texels = (size_t)size * size;
    struct wd_model_image color = {size, size, wd_alloc(4 * texels)};
    uint8_t *detail = wd_alloc(4 * texels);
    const struct wd_look_map map = {size, color.rgba, detail};
    wd_look_map_fill(&map, species, layer);
    for (size_t i = 0; i < texels; i++) {
        uint8_t *alpha = &color.rgba[4 * i + 3];
        if (!species->imported)
            *alpha = 255; /* grown leaves are cut out as polygons */
        maps->holes |= *alpha < 128;
    }
    maps->color = wd_model_image_encode(&color, &maps->color_size);
    if (!species->imported) {
        maps->normal = encode_details(detail, size, normal_texel, &maps->normal_size);
        maps->surface = encode_details(detail, size, surface_texel, &maps->surface_size);
    }
    wd_model_image_finish(&color);
    free(detail);
    return maps->color && (species->imported || (maps->normal && maps->surface));
}

void wd_export_maps_finish(struct wd_export_maps *maps)
{
    free(maps->color);
    free(maps->normal);
    free(maps->surface);
    *maps = (struct wd_export_maps){0};
}
