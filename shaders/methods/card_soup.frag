#version 460
/* Which card shows. */
#include "shared/frame.h"
#include "shared/forest.h"

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame; };
layout(set = 0, binding = 1) uniform sampler2DArray card_albedo;

#include "lib/card.glsl"
#include "lib/card_flat.glsl"

layout(location = 0) in vec2 in_uv;
layout(location = 1) flat in uvec3 in_card; /* layer_lod, noise_show, card + 1 */

layout(location = 0) out uint out_card;

void main()
{
    float lod = card_lod(in_card.x), show = float(in_card.y & 0xffu) * (1.0 / 255.0);
    float alpha = textureLod(card_albedo, vec3(in_uv, card_layer(in_card.x)), lod).a;
    if (!card_shows(in_card.y, card_opacity(alpha, lod) * show, frame.sample_index))
        discard;
    out_card = in_card.z;
}
