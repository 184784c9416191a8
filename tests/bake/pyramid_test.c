#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "bake/card_filter.h"
#include "base/memory.h"
#include "shared/hash.h"

enum {
    SAMPLES_X = WD_CARD_WIDTH * WD_CARD_SUPERSAMPLING,
    SAMPLES_Y = WD_CARD_HEIGHT * WD_CARD_SUPERSAMPLING,
};

struct render {
    uint8_t *albedo, *normal;
    double coverage;
};

/* Leaves of 6 x 6 samples strewn over a third of the card, all of one colour, facing up. */
static struct render strewn_leaves(void)
{
    struct render render = {wd_alloc((size_t)4 * SAMPLES_X * SAMPLES_Y),
                            wd_alloc((size_t)4 * SAMPLES_X * SAMPLES_Y), 0.0};
    size_t covered = 0;
    for (size_t y = 0; y < SAMPLES_Y; y++) {
        for (size_t x = 0; x < SAMPLES_X; x++) {
            if (wd_hash2((uint32_t)(x / 6), (uint32_t)(y / 6)) % 3 != 0)
                continue;
            size_t at = 4 * (y * SAMPLES_X + x);
            render.albedo[at] = 60;
            render.albedo[at + 1] = 120;
            render.albedo[at + 2] = 30;
            render.albedo[at + 3] = 255;
            render.normal[at] = render.normal[at + 1] = 128;
            render.normal[at + 2] = 255;
            render.normal[at + 3] = 200;
            covered++;
        }
    }
    render.coverage = (double)covered / ((double)SAMPLES_X * SAMPLES_Y);
    return render;
}

static struct wd_cards empty_cards(void)
{
    return (struct wd_cards){.albedo = wd_alloc(wd_cards_bytes()),
                             .normal = wd_alloc(wd_cards_bytes())};
}

static void every_mip_keeps_coverage(void **state)
{
    (void)state;
    struct render render = strewn_leaves();
    struct wd_cards cards = empty_cards();
    wd_card_filter(&cards, 1, render.albedo, render.normal);
    for (uint32_t mip = 0; mip < WD_CARD_MIPS; mip++) {
        uint32_t width, height;
        wd_card_size(mip, &width, &height);
        const uint8_t *texels = cards.albedo + wd_card_offset(1, mip);
        double sum = 0.0;
        for (size_t i = 0; i < (size_t)width * height; i++)
            sum += texels[4 * i + 3] / 255.0;
        assert_float_equal(sum / (width * height), render.coverage, 0.003);
    }
    wd_cards_finish(&cards);
    free(render.albedo);
    free(render.normal);
}

static void colours_never_darken_toward_empty_texels(void **state)
{
    (void)state;
    struct render render = strewn_leaves();
    struct wd_cards cards = empty_cards();
    wd_card_filter(&cards, 0, render.albedo, render.normal);
    for (uint32_t mip = 0; mip < WD_CARD_MIPS; mip++) {
        uint32_t width, height;
        wd_card_size(mip, &width, &height);
        const uint8_t *texels = cards.albedo + wd_card_offset(0, mip);
        for (size_t i = 0; i < (size_t)width * height; i++) {
            assert_in_range(texels[4 * i + 1], 119, 121);
            assert_in_range(texels[4 * i], 59, 61);
        }
    }
    wd_cards_finish(&cards);
    free(render.albedo);
    free(render.normal);
}

static void an_empty_card_is_empty_at_every_mip(void **state)
{
    (void)state;
    struct wd_cards cards = empty_cards();
    uint8_t *nothing = wd_alloc((size_t)4 * SAMPLES_X * SAMPLES_Y);
    wd_card_filter(&cards, 3, nothing, nothing);
    for (size_t at = wd_card_offset(3, 0); at < wd_card_offset(3, WD_CARD_MIPS); at += 4)
        assert_int_equal(cards.albedo[at + 3], 0);
    free(nothing);
    wd_cards_finish(&cards);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_mip_keeps_coverage),
        cmocka_unit_test(colours_never_darken_toward_empty_texels),
        cmocka_unit_test(an_empty_card_is_empty_at_every_mip),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
