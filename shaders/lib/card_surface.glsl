/* A card's point in the G-buffer. Expects `frame`, `card_normal`, `card_leaf`, tree.glsl,
 * card_flat.glsl and the outputs out_albedo, out_normal and out_surface. */
#include "lib/card_material.glsl"

/* `albedo` is that of the card's picture at uv (z: layer); `card` is turn, tint_show, normal, ratio_flags, `more` is
 * layer_lod, random, surface, mixed. */
void card_surface(vec3 uv, vec4 albedo, uvec4 card, uvec4 more)
{
    float lod = card_lod(more.x);
    uint surface = more.z;
    vec4 packed = textureLod(card_normal, uv, lod - float(WD_CARD_NORMAL_MIP));
    float leaf = textureLod(card_leaf, uv, lod - float(WD_CARD_NORMAL_MIP)).x;
    uint material = card_material(card_leaf_shown(leaf, card_down(uv.xy, more.x), card.w), card_cell(uv.xy, lod), surface);
    vec4 own = unmixed(vec4(albedo.rgb, packed.a), leaf, material == WD_MATERIAL_WOOD, more.w);
    own.rgb *= material == WD_MATERIAL_WOOD ? vec3(1.0) : unpackUnorm4x8(card.y).rgb * 2.0;
    if (frame.view_mode == WD_MODE_LOD)
        own.rgb = level_color(WD_LEVEL_CARD) * (0.3 + 0.7 * own.a);
    out_albedo = own;
    out_normal = vec4(card_world_normal(packed.xyz, card) * 0.5 + 0.5, float(material) / 3.0);
    out_surface = surface;
}
