#version 460
#include "shared/frame.h"
#include "shared/forest.h"

layout(set = 0, binding = 4) uniform sampler2DArray card_albedo;

#include "lib/card.glsl"

layout(location = 0) in vec3 in_uv;
layout(location = 2) flat in vec4 in_tint;
layout(location = 3) flat in uvec2 in_flat;
layout(location = 5) flat in float in_lod;

void main()
{
    float opacity = card_opacity(textureLod(card_albedo, in_uv, in_lod).a, in_lod) * in_tint.a;
    if (card_noise(in_uv, in_lod, in_flat.y, 0u) >= opacity)
        discard;
}
