#version 460
#include "shared/frame.h"
#include "shared/forest.h"

layout(set = 0, binding = 4) uniform sampler2DArray card_albedo;

#include "lib/card.glsl"
#include "lib/card_flat.glsl"

layout(location = 0) in vec2 in_uv;
layout(location = 1) flat in uvec4 in_card; /* turn, tint_show, normal, ratio_flags */
layout(location = 2) flat in uvec4 in_more; /* layer_lod, random_stem, surface, mixed */

void main()
{
    float lod = card_lod(in_more.x), show = unpackUnorm4x8(in_card.y).a;
    float alpha = textureLod(card_albedo, vec3(in_uv, card_layer(in_more.x)), lod).a;
    if (card_noise(in_uv, lod, in_more.y & 0xffffff00u, 0u) >= card_opacity(alpha, lod) * show)
        discard;
}
