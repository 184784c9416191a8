#version 460
/* Branches and leaves of a one-view billboard, each with its own picture: of what the whole tree covers
 * a texel shows as many leaves as stand in front there. What shows is decided by noise, as for cards,
 * so that a tree can dissolve. */
#include "shared/frame.h"
#include "shared/dissolve.h"

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame; };
layout(set = 0, binding = 4) uniform sampler2DArray leaf_albedo;
layout(set = 0, binding = 5) uniform sampler2DArray leaf_normal;
layout(set = 0, binding = 6) uniform sampler2DArray wood_albedo;
layout(set = 0, binding = 7) uniform sampler2DArray wood_normal;
layout(set = 0, binding = 8) uniform sampler2DArray card_albedo;
layout(set = 0, binding = 9) uniform sampler2DArray card_leaf;

#include "lib/tree.glsl"
#include "lib/card.glsl"
#include "lib/card_flat.glsl"

layout(location = 0) in vec2 in_uv;
layout(location = 1) flat in uvec4 in_card; /* turn, tint_show, normal, ratio_flags */
layout(location = 2) flat in uvec4 in_more; /* layer_lod, random_stem, surface, mixed */

layout(location = 0) out vec4 out_albedo;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out uint out_surface;

void main()
{
    float lod = card_lod(in_more.x);
    vec3 uv = vec3(in_uv, card_layer(in_more.x));
    vec4 leaf = textureLod(leaf_albedo, uv, lod), wood = textureLod(wood_albedo, uv, lod);
    vec4 tint_show = unpackUnorm4x8(in_card.y);
    float covered = card_opacity(textureLod(card_albedo, uv, lod).a, lod) * tint_show.a;
    float noise = card_noise(in_uv, lod, in_more.y & 0xffffff00u, frame.sample_index);
    if (noise >= covered)
        discard;
    float normal_lod = lod - float(WD_CARD_NORMAL_MIP);
    float leaves = card_leaf_shown(textureLod(card_leaf, uv, normal_lod).x, card_down(in_uv, in_more.x), in_card.w, in_more.y);
    bool is_wood = noise >= covered * leaves;
    vec4 packed = is_wood ? textureLod(wood_normal, uv, normal_lod)
                          : textureLod(leaf_normal, uv, normal_lod);
    vec3 albedo = is_wood ? wood.rgb : leaf.rgb * tint_show.rgb * 2.0;
    if (frame.view_mode == WD_MODE_LOD)
        albedo = level_color(WD_LEVEL_CARD) * (0.3 + 0.7 * packed.a);
    out_albedo = vec4(albedo, packed.a);
    out_normal = vec4(card_world_normal(packed.xyz, in_card) * 0.5 + 0.5,
                      float(is_wood ? WD_MATERIAL_WOOD : WD_MATERIAL_CARD) / 3.0);
    out_surface = in_more.z;
}
