/* What of a card shows. Hashed alpha (Wyman and McGuire 2017): a texel shows where a hash lies
 * below its opacity, so that covered area is kept at any distance without sorting, and the pattern
 * stays with the tree. Magnified edges are sharpened instead. */
#include "shared/hash.h"
#include "lib/dither.glsl"

uvec2 card_cell(vec2 uv, float lod)
{
    return uvec2(uv * vec2(WD_CARD_WIDTH_TEXELS, WD_CARD_HEIGHT_TEXELS) * exp2(-max(floor(lod), 0.0)));
}

float card_noise(vec2 uv, float lod, uint random, uint sample_index)
{
    uvec2 cell = card_cell(uv, lod);
    return wd_hash_unit(wd_hash_mix((cell.x | (cell.y << 16)) ^ random ^ sample_index * 0x9e3779b9u));
}

/* Whether one of a tree's crossed cards shows. All of them ask the same noise, fixed to the pixels
 * round the tree's foot, each an interval of its own: together they cover the mean of their
 * opacities, where cards that know nothing of one another would cover 1 - (1 - a)^2. Neighbours and
 * successive samples differ as much as they can (golden ratio). `interval`: its shift in bits 16..31, its begin in bits 8..15; `length`: of it. */
bool card_shows(uint interval, float length, uint sample_index)
{
    float noise = fract(dither_from(uvec2(gl_FragCoord.xy), interval)
                        + float(sample_index & 1023u) * 0.61803399);
    float from = float(interval >> 8 & 255u) * (1.0 / 255.0);
    return noise >= from && noise < from + length;
}

float card_opacity(float alpha, float lod)
{
    float sharp = clamp((alpha - 0.4) * 4.0 + 0.4, 0.0, 1.0);
    return mix(sharp, alpha, clamp(lod + 1.0, 0.0, 1.0));
}
