/* A picture's texel is leaf and wood; a pixel is one of them, by lot. Expects `frame`. */
#include "shared/hash.h"
#include "lib/mixed.glsl"

/* `cell` of the picture, so that it stays with the tree. */
float card_lot(uvec2 cell, uint surface)
{
    uint name = wd_hash_mix((cell.x | cell.y << 16) ^ surface * 0x9e3779b9u);
    return fract(wd_hash_unit(name) + float(frame.sample_index & 1023u) * 0.61803399);
}

uint card_material(float leaf, uvec2 cell, uint surface)
{
    return card_lot(cell, surface) < leaf ? WD_MATERIAL_CARD : WD_MATERIAL_WOOD;
}
