/* Constants of a card, from its vertices to its fragments. */
#include "shared/card_soup.h"

struct card_flat {
    vec2 turn;
    vec3 tint;
    float show;
    vec3 normal;  /* toward the side that the card was rendered from */
    bool behind;  /* seen from the other side */
    float mirror; /* -1: mirrored in the model's x */
    float ratio;  /* vertical over horizontal scale */
    uint layer;
    float lod;
    uint random, surface;
};

wd_card_flat card_pack(card_flat card)
{
    uint flags = (card.mirror < 0.0 ? WD_CARD_MIRRORED : 0u)
                 | (card.behind ? WD_CARD_BEHIND : 0u)
                 | (card.normal.z > 0.5 ? WD_CARD_LEVEL : 0u);
    uint lod = uint(clamp(card.lod + 1.0, 0.0, 255.0) * 256.0);
    return wd_card_flat(packSnorm2x16(card.turn), packUnorm4x8(vec4(card.tint * 0.5, card.show)),
                        packSnorm2x16(card.normal.xy),
                        packHalf2x16(vec2(card.ratio, 0.0)) | flags, card.layer | (lod << 16),
                        card.random & 0xffffff00u, card.surface);
}

float card_lod(uint layer_lod)
{
    return float(layer_lod >> 16) * (1.0 / 256.0) - 1.0;
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
