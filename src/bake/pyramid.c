#include "bake/pyramid.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "base/color.h"
#include "base/memory.h"

enum { VALUES = 4 * WD_PLANES, COVERAGE = 3 };

/* Values 0..1 in the order of the planes' bytes, colours linear: sums weighted by coverage, and
 * the coverage itself. */
struct wd_pyramid_texel {
    float values[VALUES];
};

static uint32_t halved(uint32_t size, uint32_t times)
{
    return size >> times ? size >> times : 1;
}

void wd_pyramid_init(struct wd_pyramid *pyramid, uint32_t width, uint32_t height, uint32_t mips)
{
    assert(mips >= 1 && mips <= WD_PYRAMID_MIPS);
    *pyramid = (struct wd_pyramid){.mips = mips};
    for (uint32_t mip = 0; mip < mips; mip++) {
        struct wd_pyramid_level *level = &pyramid->levels[mip];
        *level = (struct wd_pyramid_level){halved(width, mip), halved(height, mip), NULL};
        level->texels =
            wd_alloc_array((size_t)level->width * level->height, sizeof *level->texels);
    }
}

void wd_pyramid_finish(struct wd_pyramid *pyramid)
{
    for (uint32_t mip = 0; mip < pyramid->mips; mip++)
        free(pyramid->levels[mip].texels);
    *pyramid = (struct wd_pyramid){0};
}

static void first_level(struct wd_pyramid *pyramid, const uint8_t *planes)
{
    struct wd_pyramid_level *level = &pyramid->levels[0];
    size_t count = (size_t)level->width * level->height;
    const float *linear = wd_srgb_table();
    for (size_t i = 0; i < count; i++) {
        float *values = level->texels[i].values, coverage = (float)planes[4 * i + 3] / 255.0f;
        for (int k = 0; k < VALUES; k++) {
            uint8_t byte = planes[4 * (i + count * (size_t)(k / 4)) + (size_t)(k % 4)];
            values[k] = coverage * (k < COVERAGE ? linear[byte] : (float)byte / 255.0f);
        }
        values[COVERAGE] = coverage;
    }
}

static struct wd_pyramid_texel *parent_of(const struct wd_pyramid_level *fine,
                                          const struct wd_pyramid_level *coarse, uint32_t x,
                                          uint32_t y)
{
    uint32_t step_x = fine->width / coarse->width, step_y = fine->height / coarse->height;
    return &coarse->texels[(size_t)(y / step_y) * coarse->width + x / step_x];
}

static void next_level(struct wd_pyramid_level *coarse, const struct wd_pyramid_level *fine)
{
    size_t count = (size_t)coarse->width * coarse->height;
    float weight = (float)count / (float)((size_t)fine->width * fine->height);
    memset(coarse->texels, 0, count * sizeof *coarse->texels);
    for (uint32_t y = 0; y < fine->height; y++) {
        for (uint32_t x = 0; x < fine->width; x++) {
            float *sum = parent_of(fine, coarse, x, y)->values;
            const float *part = fine->texels[(size_t)y * fine->width + x].values;
            for (int k = 0; k < VALUES; k++)
                sum[k] += weight * part[k];
        }
    }
}

/* What an empty texel looks like: its parent, which in turn may be its parent. */
static void fill_empty(struct wd_pyramid_level *fine, const struct wd_pyramid_level *coarse)
{
    const float trace = 1e-4f; /* of coverage: below what a byte can hold */
    for (uint32_t y = 0; y < fine->height; y++) {
        for (uint32_t x = 0; x < fine->width; x++) {
            float *values = fine->texels[(size_t)y * fine->width + x].values;
            const float *parent = parent_of(fine, coarse, x, y)->values;
            if (values[COVERAGE] > 0.0f || parent[COVERAGE] == 0.0f)
                continue;
            for (int k = 0; k < VALUES; k++)
                values[k] = parent[k] * trace / parent[COVERAGE];
        }
    }
}

void wd_pyramid_set(struct wd_pyramid *pyramid, const uint8_t *planes)
{
    first_level(pyramid, planes);
    for (uint32_t mip = 1; mip < pyramid->mips; mip++)
        next_level(&pyramid->levels[mip], &pyramid->levels[mip - 1]);
    for (uint32_t mip = pyramid->mips - 1; mip > 0; mip--)
        fill_empty(&pyramid->levels[mip - 1], &pyramid->levels[mip]);
}

static void encode(const float *values, int plane, uint8_t *out)
{
    float scale = values[COVERAGE] > 0.0f ? 1.0f / values[COVERAGE] : 0.0f;
    for (int i = 0; i < 4; i++) {
        int k = 4 * plane + i;
        out[i] = k == COVERAGE  ? wd_unorm_encode(values[k])
                 : k < COVERAGE ? wd_srgb_encode(values[k] * scale)
                                : wd_unorm_encode(values[k] * scale);
    }
}

void wd_pyramid_get(const struct wd_pyramid *pyramid, uint32_t mip, int plane, uint8_t *out,
                    size_t stride)
{
    const struct wd_pyramid_level *level = &pyramid->levels[mip];
    for (uint32_t y = 0; y < level->height; y++) {
        for (uint32_t x = 0; x < level->width; x++)
            encode(level->texels[(size_t)y * level->width + x].values, plane,
                   out + y * stride + 4 * (size_t)x);
    }
}

void wd_pyramid_tell_mixed(const struct wd_pyramid *pyramid, uint32_t mip, const double leaves[WD_MIXED_KINDS],
                           struct wd_mixed_sums *sums)
{
    enum { OPENNESS = 4 * WD_PLANE_NORMAL + 3, LEAF = 4 * WD_PLANE_DEPTH + 3 };
    const struct wd_pyramid_level *finest = &pyramid->levels[0], *level = &pyramid->levels[mip];
    size_t count = (size_t)level->width * level->height;
    double per_texel = (double)count / (double)((size_t)finest->width * finest->height);
    *sums = (struct wd_mixed_sums){0};
    for (int k = 0; k < WD_MIXED_KINDS; k++)
        sums->leaves[k] = per_texel * leaves[k];
    for (size_t i = 0; i < count; i++) {
        const float *values = level->texels[i].values;
        uint8_t leaf = wd_unorm_encode(values[COVERAGE] > 0 ? values[LEAF] / values[COVERAGE] : 0);
        for (int k = 0; k < WD_MIXED_KINDS; k++)
            sums->all[leaf][k] += (double)values[k < COVERAGE ? k : OPENNESS];
    }
}
