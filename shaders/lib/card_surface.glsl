/* A card's point in the G-buffer. Expects `frame`, `card_albedo`, `card_normal`, `card_leaf`, tree.glsl,
 * card_flat.glsl and the outputs out_albedo, out_normal and out_surface. */
#include "lib/card_own.glsl"

/* `albedo` is that of the card's picture at uv (z: layer); `card` is turn, tint_show, normal, ratio_flags, `more` is
 * layer_lod, random_stem, surface, mixed. */
void card_surface(vec3 uv, vec4 albedo, uvec4 card, uvec4 more)
{
    float lod = card_lod(more.x);
    vec4 packed = textureLod(card_normal, uv, lod - float(WD_CARD_NORMAL_MIP));
    float leaf = textureLod(card_leaf, uv, lod - float(WD_CARD_NORMAL_MIP)).x;
    card_own shown = card_own_at(uv, lod, vec4(albedo.rgb, packed.a), leaf, card, more);
    vec4 own = shown.mean;
    own.rgb *= shown.wood ? vec3(1.0) : unpackUnorm4x8(card.y).rgb * 2.0;
    if (frame.view_mode == WD_MODE_LOD)
        own.rgb = level_color(WD_LEVEL_CARD) * (0.3 + 0.7 * own.a);
    out_albedo = own;
    out_normal = vec4(card_world_normal(packed.xyz, card) * 0.5 + 0.5, float(shown.wood ? WD_MATERIAL_WOOD : WD_MATERIAL_CARD) / 3.0);
    out_surface = more.z;
}
