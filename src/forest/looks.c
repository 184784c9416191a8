#include "forest/looks.h"

#include <stdlib.h>
#include <string.h>

#include "bake/growth_cache.h"
#include "base/color.h"
#include "base/memory.h"
#include "tree/look_map.h"

static void generate(const struct wd_species *species, uint8_t *rgba)
{
    for (uint32_t layer = 0; layer < WD_LOOK_LAYERS; layer++) {
        uint8_t *albedo = rgba + layer * WD_LOOK_MAP_BYTES;
        const struct wd_look_map map = {WD_LOOK_SIZE, albedo, albedo + WD_LOOK_HALF_BYTES};
        wd_look_map_fill(&map, species, layer);
        for (size_t i = 3; i < WD_LOOK_MAP_BYTES && !species->imported; i += 4)
            albedo[i] = 255; /* grown leaves are cut out as polygons */
    }
}

void wd_look_get(uint8_t *rgba, struct wd_bake_cache *cache, const struct wd_species *species)
{
    if (wd_looks_load(rgba, WD_LOOK_BYTES, cache, species))
        return;
    generate(species, rgba);
    wd_looks_store(rgba, WD_LOOK_BYTES, cache, species);
}

/* Share of texels that pass the cut. */
static float coverage(const uint8_t *rgba, uint32_t size)
{
    size_t count = (size_t)size * size, passed = 0;
    for (size_t i = 0; i < count; i++)
        passed += rgba[4 * i + 3] >= 255 * WD_LOOK_CUT;
    return (float)passed / (float)count;
}

/* Scales alpha so that the share `wanted` of the texels passes the cut again: averaged alpha alone
 * would thin out small leaves, and fatten dense ones, with distance. */
static void keep_coverage(uint8_t *rgba, uint32_t size, float wanted)
{
    size_t count = (size_t)size * size, histogram[256] = {0}, passed = 0;
    for (size_t i = 0; i < count; i++)
        histogram[rgba[4 * i + 3]]++;
    if (wanted >= 1 || histogram[255] == count)
        return;
    int cut = 255;
    for (; cut > 1; cut--) {
        passed += histogram[cut];
        if ((float)passed >= wanted * (float)count)
            break;
    }
    for (size_t i = 0; i < count; i++) {
        float scaled = rgba[4 * i + 3] * (float)(256 * WD_LOOK_CUT) / (float)cut;
        rgba[4 * i + 3] = scaled < 255 ? (uint8_t)scaled : 255;
    }
}

/* Halves a square sRGB image, averaging linear light. */
static void halve(uint8_t *coarse, const uint8_t *fine, uint32_t size)
{
    const float *linear = wd_srgb_table();
    for (uint32_t y = 0; y < size; y++) {
        for (uint32_t x = 0; x < size; x++) {
            const uint8_t *from = fine + 4 * ((size_t)2 * y * 2 * size + 2 * x);
            uint8_t *to = coarse + 4 * ((size_t)y * size + x);
            for (int k = 0; k < 3; k++)
                to[k] = wd_srgb_encode(0.25f * (linear[from[k]] + linear[from[k + 4]] +
                                                linear[from[k + 8 * size]] +
                                                linear[from[k + 8 * size + 4]]));
            to[3] = (uint8_t)((from[3] + from[7] + from[8 * size + 3] + from[8 * size + 7] + 2) / 4);
        }
    }
}

/* Halves linear bytes. Normals shorten where they differ, which shaders take for roughness. */
static void halve_linear(uint8_t *coarse, const uint8_t *fine, uint32_t size)
{
    for (uint32_t y = 0; y < size; y++)
        for (uint32_t x = 0; x < size; x++) {
            const uint8_t *from = fine + 4 * ((size_t)2 * y * 2 * size + 2 * x);
            uint8_t *to = coarse + 4 * ((size_t)y * size + x);
            for (int k = 0; k < 4; k++)
                to[k] = (uint8_t)((from[k] + from[k + 4] + from[k + 8 * size] +
                                   from[k + 8 * size + 4] + 2) / 4);
        }
}

static bool make_image(struct wd_image *image, struct wd_gpu *gpu, const char *name,
                       VkFormat format, uint32_t species_count)
{
    const struct wd_image_params params = {
        .name = name,
        .format = format,
        .width = WD_LOOK_SIZE,
        .height = WD_LOOK_SIZE,
        .layers = WD_LOOK_LAYERS * species_count,
        .mips = WD_ALL_MIPS,
        .usage = VK_IMAGE_USAGE_SAMPLED_BIT,
        .view = WD_IMAGE_ARRAY,
    };
    return wd_image_init(image, gpu, &params);
}

static const uint8_t *layer_of(const uint8_t *rgba, uint32_t layer)
{
    return rgba + layer / WD_LOOK_LAYERS * WD_LOOK_BYTES +
           layer % WD_LOOK_LAYERS * WD_LOOK_MAP_BYTES;
}

/* How a map's next mip is made of the one before: sizes are the coarse one's. */
struct mip_rule {
    void (*halve)(const struct mip_rule *rule, uint8_t *coarse, const uint8_t *fine,
                  uint32_t size);
    float covered; /* share of the finest level that is opaque */
};

static void halve_look(const struct mip_rule *rule, uint8_t *coarse, const uint8_t *fine,
                       uint32_t size)
{
    halve(coarse, fine, size);
    keep_coverage(coarse, size, rule->covered);
}

static void halve_details(const struct mip_rule *rule, uint8_t *coarse, const uint8_t *fine,
                          uint32_t size)
{
    (void)rule;
    halve_linear(coarse, fine, size);
}

/* `maps`: each layer's finest level, that of layer 0 first. Finishes the image where it fails. */
static bool upload_mips(struct wd_image *image, struct wd_gpu *gpu, const uint8_t *maps,
                        struct mip_rule *rule)
{
    uint8_t *levels[2] = {wd_alloc(WD_LOOK_MAP_BYTES), wd_alloc(WD_LOOK_MAP_BYTES)};
    uint8_t *mips = wd_alloc(wd_image_layer_bytes(image));
    bool ok = true;
    for (uint32_t layer = 0; layer < image->layers && ok; layer++) {
        memcpy(levels[0], layer_of(maps, layer), WD_LOOK_MAP_BYTES);
        rule->covered = coverage(levels[0], WD_LOOK_SIZE);
        for (uint32_t mip = 0, at = 0; mip < image->mips; mip++) {
            uint32_t size = WD_LOOK_SIZE >> mip;
            if (mip > 0)
                rule->halve(rule, levels[mip & 1], levels[(mip - 1) & 1], size);
            memcpy(mips + at, levels[mip & 1], (size_t)4 * size * size);
            at += 4 * size * size;
        }
        ok = wd_image_upload_layers(gpu, image, layer, 1, mips);
    }
    free(levels[0]);
    free(levels[1]);
    free(mips);
    if (!ok)
        wd_image_finish(image, gpu);
    return ok;
}

bool wd_looks_upload(struct wd_image *image, struct wd_gpu *gpu, const uint8_t *rgba,
                     uint32_t species_count)
{
    struct mip_rule rule = {.halve = halve_look};
    return make_image(image, gpu, "looks", VK_FORMAT_R8G8B8A8_SRGB, species_count) &&
           upload_mips(image, gpu, rgba, &rule);
}

bool wd_look_details_upload(struct wd_image *image, struct wd_gpu *gpu, const uint8_t *rgba,
                            uint32_t species_count)
{
    struct mip_rule rule = {.halve = halve_details};
    return make_image(image, gpu, "look details", VK_FORMAT_R8G8B8A8_UNORM, species_count) &&
           upload_mips(image, gpu, rgba + WD_LOOK_HALF_BYTES, &rule);
}
