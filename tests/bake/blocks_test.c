#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "bake/blocks.h"
#include "base/memory.h"
#include "shared/hash.h"

/* --- a reader by the specification (Khronos Data Format 1.3, 18.3 and 18.4) --- */

static int alpha_of(const uint8_t *block, int texel)
{
    uint64_t bits = 0;
    for (int i = 0; i < 6; i++)
        bits |= (uint64_t)block[2 + i] << (8 * i);
    int code = (int)(bits >> (3 * texel) & 7), a = block[0], b = block[1];
    if (code < 2)
        return code ? b : a;
    if (a > b)
        return ((8 - code) * a + (code - 1) * b) / 7;
    return code == 6 ? 0 : code == 7 ? 255 : ((6 - code) * a + (code - 1) * b) / 5;
}

static double channel(uint32_t color, int c)
{
    return c == 0 ? (color >> 11) * 255.0 / 31 : c == 1 ? (color >> 5 & 63) * 255.0 / 63
                                                        : (color & 31) * 255.0 / 31;
}

static double color_of(const uint8_t *block, int texel, int c)
{
    double a = channel((uint32_t)(block[8] | block[9] << 8), c);
    double b = channel((uint32_t)(block[10] | block[11] << 8), c);
    static const double share[4] = {0, 1, 1.0 / 3, 2.0 / 3};
    int code = block[12 + texel / 4] >> (2 * (texel % 4)) & 3;
    return a + (b - a) * share[code];
}

struct error {
    double color, alpha; /* root mean squares; of colour where something shows */
    int worst_alpha;
};

static struct error error_of(const uint8_t *rgba, uint32_t width, uint32_t height)
{
    uint8_t *blocks = wd_alloc(wd_blocks_bytes(width, height));
    uint8_t *alphas = wd_alloc(wd_alpha_blocks_bytes(width, height));
    struct error error = {0};
    double shown = 0;
    wd_blocks_pack(blocks, rgba, width, height);
    wd_alpha_blocks_pack(alphas, rgba, width, height);
    for (size_t i = 0; i < wd_alpha_blocks_bytes(width, height) / 8; i++)
        assert_memory_equal(alphas + 8 * i, blocks + 16 * i, 8); /* the same opacity, alone */
    free(alphas);
    for (uint32_t i = 0; i < width * height; i++) {
        uint32_t x = i % width, y = i / width;
        const uint8_t *block = blocks + 16 * (y / 4 * ((width + 3) / 4) + x / 4);
        int texel = (int)(y % 4 * 4 + x % 4), off = rgba[4 * i + 3] - alpha_of(block, texel);
        error.alpha += off * off;
        error.worst_alpha = abs(off) > error.worst_alpha ? abs(off) : error.worst_alpha;
        for (int c = 0; c < 3 && rgba[4 * i + 3]; c++, shown++)
            error.color += pow(rgba[4 * i + c] - color_of(block, texel, c), 2);
    }
    error.color = sqrt(error.color / fmax(shown, 1));
    error.alpha = sqrt(error.alpha / (width * height));
    free(blocks);
    return error;
}

/* Leaves, or holes, of a few texels: greens that differ by their light. */
static uint8_t *foliage(uint32_t width, uint32_t height)
{
    uint8_t *rgba = wd_alloc((size_t)4 * width * height);
    for (uint32_t i = 0; i < width * height; i++) {
        uint32_t x = i % width, y = i / width, leaf = wd_hash2(x / 3, y / 3);
        double light = 0.4 + 0.6 * (leaf & 255) / 255.0;
        rgba[4 * i] = (uint8_t)(90 * light);
        rgba[4 * i + 1] = (uint8_t)(140 * light);
        rgba[4 * i + 2] = (uint8_t)(60 * light);
        rgba[4 * i + 3] = leaf >> 8 & 3 ? (uint8_t)(leaf >> 16 & 1 ? 255 : leaf >> 24) : 0;
    }
    return rgba;
}

static void leaves_keep_their_looks(void **state)
{
    (void)state;
    uint8_t *rgba = foliage(128, 256);
    const struct error error = error_of(rgba, 128, 256);
    assert_true(error.color < 5.0);
    assert_true(error.alpha < 6.0);
    assert_true(error.worst_alpha <= 26);
    free(rgba);
}

static void what_is_whole_or_open_stays_so(void **state)
{
    (void)state;
    uint8_t rgba[4 * 64];
    for (int i = 0; i < 64; i++) {
        rgba[4 * i] = rgba[4 * i + 1] = rgba[4 * i + 2] = 99;
        rgba[4 * i + 3] = wd_hash1((uint32_t)i) & 1 ? 255 : 0;
    }
    const struct error error = error_of(rgba, 8, 8);
    assert_int_equal(error.worst_alpha, 0);
    assert_true(error.color < 3.0); /* of 5:6:5 bits */
}

static void small_mips_fill_a_block(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{1, 2}, {2, 4}, {4, 8}, {1, 1}, {6, 5}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        uint32_t width = sizes[i][0], height = sizes[i][1];
        uint8_t *rgba = foliage(width, height);
        assert_int_equal(wd_blocks_bytes(width, height),
                         16 * ((width + 3) / 4) * ((height + 3) / 4));
        assert_true(error_of(rgba, width, height).worst_alpha <= 26);
        free(rgba);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(leaves_keep_their_looks),
        cmocka_unit_test(what_is_whole_or_open_stays_so),
        cmocka_unit_test(small_mips_fill_a_block),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
