#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "bake/pyramid.h"
#include "base/color.h"
#include "base/memory.h"
#include "shared/hash.h"

enum { WIDTH = 128, HEIGHT = 256, MIPS = 8, TEXELS = WIDTH * HEIGHT };

/* Leaves of 3 x 3 texels strewn over a third of a picture, all of one colour, facing up, with
 * half covered edges. */
static uint8_t *strewn_leaves(double *coverage)
{
    uint8_t *planes = wd_alloc((size_t)4 * TEXELS * WD_PLANES);
    *coverage = 0.0;
    for (uint32_t i = 0; i < TEXELS; i++) {
        uint32_t x = i % WIDTH, y = i / WIDTH;
        if (wd_hash2(x / 3, y / 3) % 3 != 0)
            continue;
        uint8_t *albedo = planes + 4 * i, *normal = albedo + 4 * TEXELS;
        uint8_t *depth = normal + 4 * TEXELS;
        memcpy(albedo, (uint8_t[]){60, 120, 30, x % 3 == 0 ? 128 : 255}, 4);
        memcpy(normal, (uint8_t[]){128, 128, 255, 200}, 4);
        memcpy(depth, (uint8_t[]){180, 90, 50, 255}, 4);
        *coverage += albedo[3] / 255.0 / TEXELS;
    }
    return planes;
}

static uint8_t *mip_of(const struct wd_pyramid *pyramid, uint32_t mip, int plane)
{
    uint32_t width = pyramid->levels[mip].width, height = pyramid->levels[mip].height;
    uint8_t *out = wd_alloc((size_t)4 * width * height);
    wd_pyramid_get(pyramid, mip, plane, out, (size_t)4 * width);
    return out;
}

static void every_mip_keeps_coverage(void **state)
{
    (void)state;
    struct wd_pyramid pyramid;
    double coverage;
    uint8_t *planes = strewn_leaves(&coverage);
    wd_pyramid_init(&pyramid, WIDTH, HEIGHT, MIPS);
    wd_pyramid_set(&pyramid, planes);
    for (uint32_t mip = 0; mip < MIPS; mip++) {
        uint8_t *texels = mip_of(&pyramid, mip, WD_PLANE_ALBEDO);
        size_t count = (size_t)pyramid.levels[mip].width * pyramid.levels[mip].height;
        double sum = 0.0;
        for (size_t i = 0; i < count; i++)
            sum += texels[4 * i + 3] / 255.0;
        assert_float_equal(sum / (double)count, coverage, 0.003);
        free(texels);
    }
    wd_pyramid_finish(&pyramid);
    free(planes);
}

/* Nothing darkens or turns toward empty texels, in any plane. */
static void looks_reach_into_empty_texels(void **state)
{
    (void)state;
    static const uint8_t want[WD_PLANES][4] = {
        {60, 120, 30, 0}, {128, 128, 255, 200}, {180, 90, 50, 255}};
    struct wd_pyramid pyramid;
    double coverage;
    uint8_t *planes = strewn_leaves(&coverage);
    wd_pyramid_init(&pyramid, WIDTH, HEIGHT, MIPS);
    wd_pyramid_set(&pyramid, planes);
    for (uint32_t mip = 0; mip < MIPS; mip++) {
        size_t count = (size_t)pyramid.levels[mip].width * pyramid.levels[mip].height;
        for (int plane = 0; plane < WD_PLANES; plane++) {
            uint8_t *texels = mip_of(&pyramid, mip, plane);
            for (size_t i = 0; i < count; i++)
                for (int k = 0; k < (plane ? 4 : 3); k++)
                    assert_in_range(texels[4 * i + (size_t)k] + 1, want[plane][k],
                                    want[plane][k] + 2);
            free(texels);
        }
    }
    wd_pyramid_finish(&pyramid);
    free(planes);
}

static void nothing_stays_nothing(void **state)
{
    (void)state;
    struct wd_pyramid pyramid;
    uint8_t *planes = wd_alloc((size_t)4 * TEXELS * WD_PLANES);
    wd_pyramid_init(&pyramid, WIDTH, HEIGHT, MIPS);
    wd_pyramid_set(&pyramid, planes);
    for (uint32_t mip = 0; mip < MIPS; mip++) {
        uint8_t *texels = mip_of(&pyramid, mip, WD_PLANE_ALBEDO);
        for (size_t i = 0; i < (size_t)pyramid.levels[mip].width * pyramid.levels[mip].height; i++)
            assert_int_equal(texels[4 * i + 3], 0);
        free(texels);
    }
    wd_pyramid_finish(&pyramid);
    free(planes);
}

/* Bark twice as red as leaves, half as green, as blue, and a quarter as open, in no pattern: what
 * leaves alone show tells how both differ, and a texel's own share of each then what both have. */
static void mips_tell_wood_from_leaves(void **state)
{
    (void)state;
    enum { MIP = 3 };
    static const double leaf[4] = {0.1, 0.2, 0.05, 0.8}, bark[4] = {0.2, 0.1, 0.05, 0.2};
    struct wd_pyramid pyramid;
    struct wd_mixed_sums sums;
    double leaves[4] = {0};
    uint8_t *planes = wd_alloc((size_t)4 * TEXELS * WD_PLANES);
    for (uint32_t i = 0; i < TEXELS; i++) {
        bool wood = wd_hash2(i, 7) % 10 <= i % WIDTH / 32;
        const double *has = wood ? bark : leaf;
        for (int k = 0; k < 4; k++) {
            uint8_t *at = planes + 4 * i + (k < 3 ? (size_t)k : 4 * (size_t)TEXELS + 3);
            *at = k < 3 ? wd_srgb_encode((float)has[k]) : wd_unorm_encode((float)has[k]);
            leaves[k] += wood ? 0 : k < 3 ? (double)wd_srgb_decode(*at) : *at / 255.0;
        }
        planes[4 * i + 3] = 255;
        planes[4 * (i + 2 * (size_t)TEXELS) + 3] = wood ? 0 : 255;
    }
    wd_pyramid_init(&pyramid, WIDTH, HEIGHT, MIPS);
    wd_pyramid_set(&pyramid, planes);
    wd_pyramid_tell_mixed(&pyramid, MIP, leaves, &sums);
    uint32_t mixed = wd_mixed_ratios(&sums, 1);
    for (uint32_t k = 0; k < 4; k++)
        assert_float_equal((double)wd_mixed_ratio(mixed, k), bark[k] / leaf[k], 0.03 * bark[k] / leaf[k]);
    wd_pyramid_finish(&pyramid);
    free(planes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_mip_keeps_coverage),
        cmocka_unit_test(looks_reach_into_empty_texels),
        cmocka_unit_test(nothing_stays_nothing),
        cmocka_unit_test(mips_tell_wood_from_leaves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
