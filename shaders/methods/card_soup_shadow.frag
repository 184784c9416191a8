#version 460
#include "shared/frame.h"
#include "shared/forest.h"

layout(set = 0, binding = 1) uniform sampler2DArray card_albedo;

#include "lib/card.glsl"
#include "lib/card_flat.glsl"

layout(location = 0) in vec2 in_uv;
layout(location = 1) flat in uvec3 in_card; /* layer_lod, random_show, card + 1 */

void main()
{
    float lod = card_lod(in_card.x), show = float(in_card.y & 0xffu) * (1.0 / 255.0);
    float alpha = textureLod(card_albedo, vec3(in_uv, card_layer(in_card.x)), lod).a;
    if (card_noise(in_uv, lod, in_card.y & 0xffffff00u, 0u) >= card_opacity(alpha, lod) * show)
        discard;
}
