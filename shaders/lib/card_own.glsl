/* What a pixel of a card shows, of a texel's leaves and wood. Expects `frame`, `card_albedo`, `card_leaf` and card_flat.glsl. */
#include "lib/card_material.glsl"

struct card_own {
    vec4 mean; /* linear albedo, and openness, of the leaf or the wood that a pixel shows */
    bool wood;
};

/* Of wood that stands for leaves before it, the colour is that of leaves amid the crown: bark of stems need not be
 * as much paler than these as most wood is. `mean`: of the texel at uv (z: layer), of whose area `leaf` is leaves; `card`:
 * turn, tint_show, normal, ratio_flags; `more`: layer_lod, random_stem, surface, mixed. */
card_own card_own_at(vec3 uv, float lod, vec4 mean, float leaf, uvec4 card, uvec4 more)
{
    float lot = card_lot(card_cell(uv.xy, lod), more.z);
    card_own own;
    own.wood = lot >= card_leaf_shown(leaf, card_down(uv.xy, more.x), card.w, more.y);
    if (!own.wood && lot >= leaf) {
        vec3 amid = vec3(card_amid_crown(card.w, more.x), uv.z);
        mean.rgb = textureLod(card_albedo, amid, float(WD_CARD_LAST_MIP)).rgb;
        leaf = textureLod(card_leaf, amid, float(WD_CARD_LAST_MIP - WD_CARD_NORMAL_MIP)).x;
    }
    own.mean = unmixed(mean, leaf, own.wood, more.w);
    return own;
}
