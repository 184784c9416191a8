#include "bake/cards.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bake/blocks.h"
#include "bake/mixed.h"
#include "bake/pyramid.h"
#include "base/dmath.h"
#include "base/memory.h"

void wd_card_size(uint32_t mip, uint32_t *width, uint32_t *height)
{
    *width = WD_CARD_WIDTH >> mip ? WD_CARD_WIDTH >> mip : 1;
    *height = WD_CARD_HEIGHT >> mip ? WD_CARD_HEIGHT >> mip : 1;
}

uint32_t wd_card_first_mip(const struct wd_card_form *form, int plane)
{
    return plane == WD_PLANE_NORMAL || form->planes[plane] >= WD_CARD_ALPHA ? WD_CARD_NORMAL_MIP : 0;
}

static size_t mip_bytes(enum wd_card_texels texels, uint32_t mip)
{
    uint32_t width, height;
    wd_card_size(mip, &width, &height);
    size_t count = (size_t)width * height;
    return texels == WD_CARD_BLOCKS         ? wd_blocks_bytes(width, height)
           : texels == WD_CARD_ALPHA_BLOCKS ? wd_alpha_blocks_bytes(width, height)
           : texels == WD_CARD_ALPHA        ? count
                                            : 4 * count;
}

size_t wd_card_offset(const struct wd_card_form *form, int plane, uint32_t card, uint32_t mip)
{
    size_t one = 0, before = 0;
    for (uint32_t i = wd_card_first_mip(form, plane); i < WD_CARD_MIPS; i++) {
        if (i == mip)
            before = one;
        one += mip_bytes(form->planes[plane], i);
    }
    return card * one + before;
}

size_t wd_card_plane_bytes(const struct wd_card_form *form, int plane)
{
    return form->planes[plane] == WD_CARD_NOTHING
               ? 0
               : wd_card_offset(form, plane, WD_CARDS, wd_card_first_mip(form, plane));
}

void wd_cards_finish(struct wd_cards *cards)
{
    for (int plane = 0; plane < WD_PLANES; plane++)
        free(cards->planes[plane]);
    *cards = (struct wd_cards){0};
}

static void init_cards(struct wd_cards *cards, const struct wd_card_form *form)
{
    *cards = (struct wd_cards){.form = *form};
    for (int plane = 0; plane < WD_PLANES; plane++)
        if (form->planes[plane] != WD_CARD_NOTHING)
            cards->planes[plane] = wd_alloc(wd_card_plane_bytes(form, plane));
}

/* How far the model reaches from its axis: along a card, and in any direction along x or y. */
struct wd_card_extent wd_card_extent_of(const struct wd_tree_mesh *mesh)
{
    float side = 0.0f;
    for (int axis = 0; axis < 2; axis++)
        side = fmaxf(side, fmaxf(fabsf(mesh->min_m[axis]), fabsf(mesh->max_m[axis])));
    return (struct wd_card_extent){
        .half_width_m = fmaxf(mesh->reach_m * 1.01f, 0.01f),
        .half_depth_m = fmaxf(side * 1.01f, 0.01f),
        .bottom_m = mesh->min_m[2],
        .top_m = fmaxf(mesh->max_m[2], mesh->min_m[2] + 0.01f),
    };
}

/* A place on the card (right and down, 0..1) as one of the picture's samples: card_picture.glsl. */
static void put_picture(struct wd_bake_shot *shot, const float right[4], const float down[4], bool lies)
{
    const float width = WD_CARD_WIDTH * WD_CARD_SUPERSAMPLING;
    const float height = WD_CARD_HEIGHT * WD_CARD_SUPERSAMPLING;
    for (int k = 0; k < 4; k++) {
        float left = (k == 3 ? 1.0f : 0.0f) - right[k];
        shot->x[k] = width * (lies ? down[k] : right[k]);
        shot->y[k] = height * (lies ? left : down[k]);
    }
}

/* Card i of the upright ones spans u = (cos a, sin a, 0) and z and is seen from u x z; the level
 * one spans x and y and is seen from above. */
static struct wd_bake_shot card_shot(const struct wd_card_extent *extent, uint32_t card)
{
    float tall_m = extent->top_m - extent->bottom_m;
    bool lies = WD_CARD_LIES(extent->half_width_m, extent->bottom_m, extent->top_m);
    struct wd_bake_shot shot = {0};
    if (card == WD_CARD_SIDES) {
        float per_m = 0.5f / extent->half_depth_m;
        put_picture(&shot, (const float[4]){per_m, 0.0f, 0.0f, 0.5f},
                    (const float[4]){0.0f, -per_m, 0.0f, 0.5f}, lies);
        shot.depth[2] = 1.0f / tall_m;
        shot.depth[3] = -extent->bottom_m / tall_m;
        return shot;
    }
    double angle = WD_PI / WD_CARD_SIDES * card;
    float c = (float)wd_dcos(angle), s = (float)wd_dsin(angle), per_m = 0.5f / extent->half_width_m;
    put_picture(&shot, (const float[4]){c * per_m, s * per_m, 0.0f, 0.5f},
                (const float[4]){0.0f, 0.0f, -1.0f / tall_m, extent->top_m / tall_m}, lies);
    shot.depth[0] = s * per_m;
    shot.depth[1] = -c * per_m;
    shot.depth[3] = 0.5f;
    return shot;
}

/* Writes a mip of the pyramid; `texels` has room for it. */
static void keep_mip(const struct wd_cards *cards, const struct wd_pyramid *pyramid,
                     uint8_t *texels, uint32_t card, uint32_t mip, int plane)
{
    uint32_t width, height;
    uint8_t *out = cards->planes[plane] + wd_card_offset(&cards->form, plane, card, mip);
    enum wd_card_texels kept = cards->form.planes[plane];
    wd_card_size(mip, &width, &height);
    wd_pyramid_get(pyramid, mip, plane, kept == WD_CARD_TEXELS ? out : texels, (size_t)4 * width);
    if (kept == WD_CARD_BLOCKS)
        wd_blocks_pack(out, texels, width, height);
    else if (kept == WD_CARD_ALPHA_BLOCKS)
        wd_alpha_blocks_pack(out, texels, width, height);
    for (size_t i = 0; i < (size_t)width * height && kept == WD_CARD_ALPHA; i++)
        out[i] = texels[4 * i + 3];
}

/* Cards while they are baked, and what tells wood and leaves apart of each. */
struct baked_cards {
    struct wd_cards *cards;
    struct wd_mixed_sums mixed[WD_CARDS];
};

/* Of trees 32 pixels tall or so. */
enum { MIXED_MIP = 3 };

static void take_card(void *user, uint32_t card, const struct wd_bake_picture *picture)
{
    struct baked_cards *baked = user;
    const struct wd_cards *cards = baked->cards;
    struct wd_pyramid pyramid;
    uint8_t *texels = wd_alloc((size_t)4 * WD_CARD_WIDTH * WD_CARD_HEIGHT);
    wd_pyramid_init(&pyramid, WD_CARD_WIDTH, WD_CARD_HEIGHT, WD_CARD_MIPS);
    wd_pyramid_set(&pyramid, picture->planes);
    for (int plane = 0; plane < WD_PLANES; plane++)
        for (uint32_t mip = wd_card_first_mip(&cards->form, plane);
             mip < WD_CARD_MIPS && cards->planes[plane]; mip++)
            keep_mip(cards, &pyramid, texels, card, mip, plane);
    wd_pyramid_tell_mixed(&pyramid, MIXED_MIP, picture->leaves, &baked->mixed[card]);
    wd_pyramid_finish(&pyramid);
    free(texels);
}

bool wd_cards_bake(struct wd_cards *cards, struct wd_baker *baker, const struct wd_bake_mesh *mesh,
                   const struct wd_card_extent *extent, const struct wd_card_form *form)
{
    struct wd_bake_shot shots[WD_CARDS];
    for (uint32_t card = 0; card < WD_CARDS; card++)
        shots[card] = card_shot(extent, card);
    enum wd_card_texels depths = form->planes[WD_PLANE_DEPTH];
    const struct wd_bake_job job = {
        .mesh = *mesh,
        .parts = form->parts,
        .depths = depths == WD_CARD_TEXELS || depths == WD_CARD_BLOCKS ? WD_BAKE_DEPTHS
                                                                       : WD_BAKE_NO_DEPTHS,
        .shots = shots,
        .shot_count = WD_CARDS,
        .width = WD_CARD_WIDTH,
        .height = WD_CARD_HEIGHT,
        .samples = WD_CARD_SUPERSAMPLING,
    };
    init_cards(cards, form);
    struct baked_cards *baked = wd_alloc(sizeof *baked);
    baked->cards = cards;
    bool ok = wd_baker_run(baker, &job, take_card, baked);
    if (ok)
        cards->mixed = wd_mixed_ratios(baked->mixed, WD_CARDS);
    free(baked);
    if (!ok)
        wd_cards_finish(cards);
    return ok;
}

/* --- cache ------------------------------------------------------------------------------- */

static uint64_t cards_key(uint64_t model_key, const struct wd_card_form *form)
{
    const uint32_t words[] = {WD_CARD_WIDTH, WD_CARD_HEIGHT, WD_CARD_MIPS, WD_CARDS,
                              (uint32_t)form->parts, form->planes[0], form->planes[1],
                              form->planes[2]};
    return wd_cache_key(model_key, words, sizeof words);
}

static size_t kept_bytes(const struct wd_card_form *form)
{
    size_t bytes = sizeof(uint32_t); /* of wd_cards.mixed */
    for (int plane = 0; plane < WD_PLANES; plane++)
        bytes += wd_card_plane_bytes(form, plane);
    return bytes;
}

bool wd_cards_load(struct wd_cards *cards, struct wd_bake_cache *cache, uint64_t model_key,
                   const struct wd_card_form *form)
{
    size_t bytes = kept_bytes(form), size, at = 0;
    uint8_t *block = wd_cache_load(cache, "cards", cards_key(model_key, form), bytes, &size);
    bool found = block && size == bytes;
    *cards = (struct wd_cards){0};
    if (found)
        init_cards(cards, form);
    for (int plane = 0; plane < WD_PLANES && found; plane++)
        if (cards->planes[plane]) {
            memcpy(cards->planes[plane], block + at, wd_card_plane_bytes(form, plane));
            at += wd_card_plane_bytes(form, plane);
        }
    if (found)
        cards->mixed = wd_cache_get_word(block + at, 0);
    free(block);
    return found;
}

void wd_cards_store(const struct wd_cards *cards, struct wd_bake_cache *cache, uint64_t model_key)
{
    size_t bytes = kept_bytes(&cards->form), at = 0;
    uint8_t *block = wd_alloc(bytes);
    for (int plane = 0; plane < WD_PLANES; plane++)
        if (cards->planes[plane]) {
            memcpy(block + at, cards->planes[plane], wd_card_plane_bytes(&cards->form, plane));
            at += wd_card_plane_bytes(&cards->form, plane);
        }
    wd_cache_put_word(block + at, 0, cards->mixed);
    wd_cache_store(cache, "cards", cards_key(model_key, &cards->form), block, bytes);
    free(block);
}
