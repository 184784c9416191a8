/* What of a card shows. Hashed alpha (Wyman and McGuire 2017): a texel shows where a hash fixed to
 * the card lies below its opacity, so that covered area is kept at any distance without sorting,
 * and the pattern stays with the tree. Magnified edges are sharpened instead. */
#include "shared/hash.h"

float card_noise(vec2 uv, float lod, uint random, uint sample_index)
{
    vec2 cells = vec2(WD_CARD_WIDTH_TEXELS, WD_CARD_HEIGHT_TEXELS) * exp2(-max(floor(lod), 0.0));
    uvec2 cell = uvec2(uv * cells);
    return wd_hash_unit(wd_hash_mix((cell.x | (cell.y << 16)) ^ random ^ sample_index * 0x9e3779b9u));
}

float card_opacity(float alpha, float lod)
{
    float sharp = clamp((alpha - 0.4) * 4.0 + 0.4, 0.0, 1.0);
    return mix(sharp, alpha, clamp(lod * 0.5 + 0.5, 0.0, 1.0));
}
