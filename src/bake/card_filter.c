#include "bake/card_filter.h"

#include <stdlib.h>

#include "base/color.h"
#include "base/memory.h"

/* A texel while it is filtered: sums weighted by coverage. */
struct texel {
    float color[3]; /* linear */
    float normal[3];
    float openness;
    float coverage;
};

struct level {
    struct texel *texels;
    uint32_t width, height;
};

static void add(struct texel *sum, const struct texel *part, float weight)
{
    for (int k = 0; k < 3; k++) {
        sum->color[k] += weight * part->color[k];
        sum->normal[k] += weight * part->normal[k];
    }
    sum->openness += weight * part->openness;
    sum->coverage += weight * part->coverage;
}

static void first_level(struct level *level, const uint8_t *albedo, const uint8_t *normal)
{
    enum { S = WD_CARD_SUPERSAMPLING };
    float linear[256];
    for (int i = 0; i < 256; i++)
        linear[i] = wd_srgb_decode((uint8_t)i);
    for (uint32_t y = 0; y < level->height * S; y++) {
        for (uint32_t x = 0; x < level->width * S; x++) {
            size_t at = 4 * ((size_t)y * level->width * S + x);
            if (albedo[at + 3] < 128)
                continue;
            struct texel part = {.openness = (float)normal[at + 3] / 255.0f, .coverage = 1.0f};
            for (int k = 0; k < 3; k++) {
                part.color[k] = linear[albedo[at + k]];
                part.normal[k] = (float)normal[at + k] / 127.5f - 1.0f;
            }
            add(&level->texels[(size_t)(y / S) * level->width + x / S], &part, 1.0f / (S * S));
        }
    }
}

static void next_level(struct level *coarse, const struct level *fine)
{
    uint32_t step_x = fine->width / coarse->width, step_y = fine->height / coarse->height;
    float weight = 1.0f / (float)(step_x * step_y);
    for (uint32_t y = 0; y < fine->height; y++) {
        for (uint32_t x = 0; x < fine->width; x++)
            add(&coarse->texels[(size_t)(y / step_y) * coarse->width + x / step_x],
                &fine->texels[(size_t)y * fine->width + x], weight);
    }
}

/* What an empty texel looks like: its parent's average, which in turn may be its parent's. */
static void fill_empty(struct level *fine, const struct level *coarse)
{
    uint32_t step_x = fine->width / coarse->width, step_y = fine->height / coarse->height;
    for (uint32_t y = 0; y < fine->height; y++) {
        for (uint32_t x = 0; x < fine->width; x++) {
            struct texel *texel = &fine->texels[(size_t)y * fine->width + x];
            const struct texel *parent =
                &coarse->texels[(size_t)(y / step_y) * coarse->width + x / step_x];
            if (texel->coverage > 0.0f || parent->coverage == 0.0f)
                continue;
            /* A trace of coverage below what a byte can hold: colour without opacity. */
            const float trace = 1e-4f;
            *texel = (struct texel){0};
            add(texel, parent, trace / parent->coverage);
        }
    }
}

static void encode(const struct level *level, uint8_t *albedo, uint8_t *normal)
{
    for (size_t i = 0; i < (size_t)level->width * level->height; i++) {
        const struct texel *texel = &level->texels[i];
        float scale = texel->coverage > 0.0f ? 1.0f / texel->coverage : 0.0f;
        for (int k = 0; k < 3; k++) {
            albedo[4 * i + k] = wd_srgb_encode(texel->color[k] * scale);
            normal[4 * i + k] = wd_unorm_encode(texel->normal[k] * scale * 0.5f + 0.5f);
        }
        albedo[4 * i + 3] = wd_unorm_encode(texel->coverage);
        normal[4 * i + 3] = wd_unorm_encode(texel->openness * scale);
    }
}

void wd_card_filter(struct wd_cards *cards, uint32_t card, const uint8_t *albedo,
                    const uint8_t *normal)
{
    struct level levels[WD_CARD_MIPS];
    for (uint32_t mip = 0; mip < WD_CARD_MIPS; mip++) {
        struct level *level = &levels[mip];
        wd_card_size(mip, &level->width, &level->height);
        level->texels = wd_alloc_array((size_t)level->width * level->height, sizeof(struct texel));
        if (mip == 0)
            first_level(level, albedo, normal);
        else
            next_level(level, &levels[mip - 1]);
    }
    for (int mip = WD_CARD_MIPS - 2; mip >= 0; mip--)
        fill_empty(&levels[mip], &levels[mip + 1]);
    for (uint32_t mip = 0; mip < WD_CARD_MIPS; mip++) {
        size_t offset = wd_card_offset(card, mip);
        encode(&levels[mip], cards->albedo + offset, cards->normal + offset);
        free(levels[mip].texels);
    }
}
