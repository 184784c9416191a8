#version 460
#include "shared/frame.h"
#include "shared/forest.h"

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame; };
layout(set = 0, binding = 4) uniform sampler2DArray card_albedo;
layout(set = 0, binding = 5) uniform sampler2DArray card_normal;
layout(set = 0, binding = 7) uniform sampler2DArray card_leaf;

#include "lib/tree.glsl"
#include "lib/card.glsl"
#include "lib/card_flat.glsl"

layout(location = 0) in vec2 in_uv;
layout(location = 1) flat in uvec4 in_card; /* turn, tint_show, normal, ratio_flags */
layout(location = 2) flat in uvec4 in_more; /* layer_lod, random_stem, surface, mixed */

layout(location = 0) out vec4 out_albedo;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out uint out_surface;

#include "lib/card_surface.glsl"

void main()
{
    float lod = card_lod(in_more.x);
    vec3 uv = vec3(in_uv, card_layer(in_more.x));
    vec4 albedo = textureLod(card_albedo, uv, lod);
    float opacity = card_opacity(albedo.a, lod) * unpackUnorm4x8(in_card.y).a;
    if (!card_shows(in_more.y, opacity, frame.sample_index))
        discard;
    card_surface(uv, albedo, in_card, in_more);
}
