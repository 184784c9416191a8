/* Constants of a card, from its vertices to its fragments. */
#include "shared/card_soup.h"
#include "shared/sunlit.h"
#include "lib/card_picture.glsl"

struct card_flat {
    vec2 turn;
    vec3 tint;
    float show;
    vec3 normal;  /* toward the side that the card was rendered from */
    bool behind;  /* seen from the other side */
    float mirror; /* -1: mirrored in the model's x */
    float ratio;  /* vertical over horizontal scale */
    uint layer;
    bool lies; /* WD_CARD_LIES */
    float lod;
    uint random, surface, mixed;
    float to_leaf; /* of the picture's wood what is to be leaves; below 0: of its leaves what is to be wood */
    float base;    /* of its height down to the lowest living branch */
    float hides;   /* and to where the crown hides the stem below that */
};

/* To an eye at an elevation of this sine; `shares`: a byte for each ring. */
float share_seen(uint shares[2], float sine)
{
    uint at = wd_sunlit_ring(sine), ring = at & 255u;
    return mix(WD_RING_SHARE(shares, ring), WD_RING_SHARE(shares, ring + 1u), float(at >> 8) * (1.0 / 65535.0));
}

/* Eyes from above see fewer boughs than one of the same height, whose picture a card shows, and more than one right
 * above the tree: what of either is to be the other, card_flat's `to_leaf`. */
float wood_to_leaf(wd_model model, float sine, bool from_above)
{
    float shown = share_seen(model.wood_seen, from_above ? 1.0 : 0.0), seen = share_seen(model.wood_seen, sine);
    return seen < shown ? 1.0 - seen / shown : (shown - seen) / max(1.0 - shown, 0.01);
}

/* Boughs hang before the upper part of a stem to eyes from above, which a picture from its own height shows: of a card
 * whose crown reaches down to `base` of its height, to where. */
float crown_hides(wd_model model, float sine, float base)
{
    float shown = share_seen(model.stem_seen, 0.0), seen = share_seen(model.stem_seen, sine);
    return seen < shown ? mix(1.0, base, seen / shown) : base;
}

float crown_begins(wd_model model, bool from_above)
{
    return from_above ? 1.0 : clamp((model.top_m - model.crown_base_m) / (model.top_m - model.bottom_m), 0.0, 1.0);
}

/* How far down the card a place of its picture is. */
float card_down(vec2 uv, uint layer_lod)
{
    return (layer_lod & WD_CARD_LYING) != 0u ? uv.x : uv.y;
}

/* Mip of the pictures of a tree that is `tall_px` high on screen: a texel a pixel along the axis that has fewer, as
 * wide plants have across. `ratio`: vertical over horizontal scale. */
float card_lod_of(wd_model model, float ratio, float tall_px)
{
    float wide_to_tall = 2.0 * model.half_width_m / ((model.top_m - model.bottom_m) * ratio);
    vec2 texels = vec2(WD_CARD_WIDTH_TEXELS, WD_CARD_HEIGHT_TEXELS);
    texels = card_lies(model) ? texels.yx : texels;
    return clamp(log2(min(texels.x / wide_to_tall, texels.y) / max(tall_px, 1.0)), -1.0, float(WD_CARD_LAST_MIP));
}

wd_card_flat card_pack(card_flat card)
{
    uint flags = (card.mirror < 0.0 ? WD_CARD_MIRRORED : 0u)
                 | (card.behind ? WD_CARD_BEHIND : 0u)
                 | (card.normal.z > 0.5 ? WD_CARD_LEVEL : 0u);
    uint wood = uint(card.base * 31.0 + 0.5) << 19 | uint(clamp(card.to_leaf, -1.0, 1.0) * 127.0 + 128.5) << 24;
    uint lod = uint(clamp(card.lod + 1.0, 0.0, 127.0) * 256.0) | (card.lies ? WD_CARD_LYING >> 16 : 0u);
    return wd_card_flat(packSnorm2x16(card.turn), packUnorm4x8(vec4(card.tint * 0.5, card.show)),
                        packSnorm2x16(card.normal.xy),
                        packHalf2x16(vec2(card.ratio, 0.0)) | flags | wood, card.layer | (lod << 16),
                        (card.random & 0xffffff00u) | uint(card.hides * 255.0 + 0.5), card.surface, card.mixed);
}

/* Share of leaves that a place `down` a picture is to show, where it has `leaf`. `flags`, `random_stem`: of wd_card_flat. */
float card_leaf_shown(float leaf, float down, uint flags, uint random_stem)
{
    float to_leaf = (float(flags >> 24) - 128.0) * (1.0 / 127.0);
    float shown = to_leaf < 0.0 ? leaf * (1.0 + to_leaf) : leaf + (1.0 - leaf) * to_leaf;
    shown = down * 31.0 <= float(flags >> 19 & 31u) ? shown : 1.0;
    return down * 255.0 <= float(random_stem & 255u) ? shown : leaf;
}

/* Half way from a picture's top to the lowest living branch. */
vec2 card_amid_crown(uint flags, uint layer_lod)
{
    float down = 0.5 * float(flags >> 19 & 31u) * (1.0 / 31.0);
    return (layer_lod & WD_CARD_LYING) != 0u ? vec2(down, 0.5) : vec2(0.5, down);
}

float card_lod(uint layer_lod)
{
    return float(layer_lod >> 16 & 0x7fffu) * (1.0 / 256.0) - 1.0;
}

float card_layer(uint layer_lod)
{
    return float(layer_lod & 0xffffu);
}

/* A card's stored normal, a mean whose length is kept, in world axes; seen from behind, a card shows
 * its mirror image. `card`: turn, tint_show, normal, ratio_flags. */
vec3 card_world_normal(vec3 stored, uvec4 card)
{
    vec3 normal = stored * 2.0 - 1.0;
    float mean_length = length(normal);
    uint flags = card.w;
    vec2 turn = unpackSnorm2x16(card.x);
    float ratio = unpackHalf2x16(flags).x;
    if ((flags & WD_CARD_MIRRORED) != 0u)
        normal.x = -normal.x;
    normal = vec3((turn.x * normal.x - turn.y * normal.y) * ratio,
                  (turn.y * normal.x + turn.x * normal.y) * ratio, normal.z);
    vec3 own = vec3(unpackSnorm2x16(card.z), (flags & WD_CARD_LEVEL) != 0u ? 1.0 : 0.0);
    if ((flags & WD_CARD_BEHIND) != 0u)
        normal -= 2.0 * dot(normal, own) * own;
    return normal * (mean_length / max(length(normal), 1e-5));
}

/* Pictures of low, wide plants reach below the foot, as what lies on the ground before it does from above.
 * Such corners come nearer along the eye's ray, until the ground hides none of them but where it is seen
 * all but level. */
vec3 card_over_ground(vec3 rel, vec3 foot)
{
    float under_m = foot.z - rel.z;
    if (under_m <= 0.0 || foot.z >= 0.0)
        return rel;
    return rel * max(foot.z / rel.z, 1.0 - 3.0 * under_m / length(rel));
}
