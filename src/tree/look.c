#include "tree/look.h"

#include "base/color.h"
#include "tree/vec.h"

uint32_t wd_pack_tint(const float rgb[3], float sky)
{
    uint32_t packed = 0;
    for (int i = 0; i < 3; i++)
        packed |= (uint32_t)wd_unorm_encode(rgb[i]) << (8 * i);
    return packed | (uint32_t)wd_unorm_encode(sky) << 24;
}

float wd_leaf_roughness(const struct wd_species *species)
{
    return wd_mixf(0.62f, 0.24f, species->leaf.gloss);
}

void wd_bark_texture_color(const struct wd_species *species, float color[3])
{
    for (int i = 0; i < 3; i++)
        color[i] = fmaxf(species->bark.color[i],
                         fmaxf(species->bark.upper_color[i], species->bark.twig_color[i]));
}

struct wd_bark_tint wd_bark_tint_of(const struct wd_species *species)
{
    struct wd_bark_tint tint = {.upper_from = species->bark.upper_from};
    float full[3];
    wd_bark_texture_color(species, full);
    for (int i = 0; i < 3; i++) {
        float over = full[i] > 0 ? 1 / full[i] : 0;
        tint.lower[i] = species->bark.color[i] * over;
        tint.upper[i] = species->bark.upper_color[i] * over;
        tint.twig[i] = species->bark.twig_color[i] * over;
    }
    return tint;
}

uint32_t wd_bark_tint_at(const struct wd_bark_tint *bark, float height, float radius_m,
                         float sky)
{
    float up = wd_smoothf(bark->upper_from, bark->upper_from + 0.25f, height);
    float thin = 1 - wd_smoothf(0.012f, 0.06f, radius_m), rgb[3];
    for (int i = 0; i < 3; i++)
        rgb[i] = wd_mixf(wd_mixf(bark->lower[i], bark->upper[i], up), bark->twig[i], thin);
    return wd_pack_tint(rgb, sky);
}
