#include "bake/cards.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bake/pyramid.h"
#include "base/dmath.h"
#include "base/memory.h"

void wd_card_size(uint32_t mip, uint32_t *width, uint32_t *height)
{
    *width = WD_CARD_WIDTH >> mip ? WD_CARD_WIDTH >> mip : 1;
    *height = WD_CARD_HEIGHT >> mip ? WD_CARD_HEIGHT >> mip : 1;
}

size_t wd_card_offset(uint32_t card, uint32_t mip)
{
    size_t one = 0, before = 0;
    for (uint32_t i = 0; i < WD_CARD_MIPS; i++) {
        uint32_t width, height;
        wd_card_size(i, &width, &height);
        if (i == mip)
            before = one;
        one += (size_t)4 * width * height;
    }
    return card * one + (mip < WD_CARD_MIPS ? before : 0);
}

size_t wd_cards_bytes(void)
{
    return wd_card_offset(WD_CARDS, WD_CARD_MIPS);
}

void wd_cards_finish(struct wd_cards *cards)
{
    for (int plane = 0; plane < WD_PLANES; plane++)
        free(cards->planes[plane]);
    *cards = (struct wd_cards){0};
}

static void init_cards(struct wd_cards *cards)
{
    for (int plane = 0; plane < WD_PLANES; plane++)
        cards->planes[plane] = wd_alloc(wd_cards_bytes());
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

/* Card i of the upright ones spans u = (cos a, sin a, 0) and z and is seen from u x z; the level
 * one spans x and y and is seen from above. */
static struct wd_bake_shot card_shot(const struct wd_card_extent *extent, uint32_t card)
{
    const float half_width = 0.5f * WD_CARD_WIDTH * WD_CARD_SUPERSAMPLING;
    const float height = WD_CARD_HEIGHT * WD_CARD_SUPERSAMPLING;
    float tall_m = extent->top_m - extent->bottom_m;
    if (card == WD_CARD_SIDES)
        return (struct wd_bake_shot){
            .x = {half_width / extent->half_depth_m, 0.0f, 0.0f, half_width},
            .y = {0.0f, -0.5f * height / extent->half_depth_m, 0.0f, 0.5f * height},
            .depth = {0.0f, 0.0f, 1.0f / tall_m, -extent->bottom_m / tall_m},
        };
    double angle = WD_PI / WD_CARD_SIDES * card;
    float c = (float)wd_dcos(angle), s = (float)wd_dsin(angle);
    float across = half_width / extent->half_width_m, depth = 0.5f / extent->half_width_m;
    return (struct wd_bake_shot){
        .x = {c * across, s * across, 0.0f, half_width},
        .y = {0.0f, 0.0f, -height / tall_m, height * extent->top_m / tall_m},
        .depth = {s * depth, -c * depth, 0.0f, 0.5f},
    };
}

struct taking {
    struct wd_cards *cards;
    struct wd_pyramid pyramid;
};

static void take_card(void *user, uint32_t card, const uint8_t *planes)
{
    struct taking *taking = user;
    wd_pyramid_set(&taking->pyramid, planes);
    for (uint32_t mip = 0; mip < WD_CARD_MIPS; mip++) {
        uint32_t width, height;
        wd_card_size(mip, &width, &height);
        for (int plane = 0; plane < WD_PLANES; plane++)
            wd_pyramid_get(&taking->pyramid, mip, plane,
                           taking->cards->planes[plane] + wd_card_offset(card, mip),
                           (size_t)4 * width);
    }
}

bool wd_cards_bake(struct wd_cards *cards, struct wd_baker *baker, const struct wd_bake_mesh *mesh,
                   const struct wd_card_extent *extent, enum wd_bake_parts parts)
{
    struct wd_bake_shot shots[WD_CARDS];
    for (uint32_t card = 0; card < WD_CARDS; card++)
        shots[card] = card_shot(extent, card);
    const struct wd_bake_job job = {
        .mesh = *mesh,
        .parts = parts,
        .shots = shots,
        .shot_count = WD_CARDS,
        .width = WD_CARD_WIDTH,
        .height = WD_CARD_HEIGHT,
        .samples = WD_CARD_SUPERSAMPLING,
    };
    struct taking taking = {.cards = cards};
    init_cards(cards);
    wd_pyramid_init(&taking.pyramid, WD_CARD_WIDTH, WD_CARD_HEIGHT, WD_CARD_MIPS);
    bool ok = wd_baker_run(baker, &job, take_card, &taking);
    wd_pyramid_finish(&taking.pyramid);
    if (!ok)
        wd_cards_finish(cards);
    return ok;
}

/* --- cache ------------------------------------------------------------------------------- */

static uint64_t cards_key(uint64_t model_key, enum wd_bake_parts parts)
{
    const uint32_t form[] = {WD_CARD_WIDTH, WD_CARD_HEIGHT, WD_CARD_MIPS, WD_CARDS,
                             (uint32_t)parts};
    return wd_cache_key(model_key, form, sizeof form);
}

bool wd_cards_load(struct wd_cards *cards, struct wd_bake_cache *cache, uint64_t model_key,
                   enum wd_bake_parts parts)
{
    size_t plane = wd_cards_bytes(), size;
    uint8_t *block = wd_cache_load(cache, "cards", cards_key(model_key, parts),
                                   WD_PLANES * plane, &size);
    bool found = block && size == WD_PLANES * plane;
    *cards = (struct wd_cards){0};
    if (found) {
        init_cards(cards);
        for (int i = 0; i < WD_PLANES; i++)
            memcpy(cards->planes[i], block + (size_t)i * plane, plane);
    }
    free(block);
    return found;
}

void wd_cards_store(const struct wd_cards *cards, struct wd_bake_cache *cache, uint64_t model_key,
                    enum wd_bake_parts parts)
{
    size_t plane = wd_cards_bytes();
    uint8_t *block = wd_alloc(WD_PLANES * plane);
    for (int i = 0; i < WD_PLANES; i++)
        memcpy(block + (size_t)i * plane, cards->planes[i], plane);
    wd_cache_store(cache, "cards", cards_key(model_key, parts), block, WD_PLANES * plane);
    free(block);
}
