#version 460
#include "shared/frame.h"
#include "shared/forest.h"

layout(scalar, set = 0, binding = 0) readonly buffer Frame { wd_frame_uniforms frame; };
layout(set = 0, binding = 4) uniform sampler2DArray card_albedo;
layout(set = 0, binding = 5) uniform sampler2DArray card_normal;

#include "lib/tree.glsl"
#include "lib/card.glsl"

layout(location = 0) in vec3 in_uv;
layout(location = 1) flat in vec4 in_pose;
layout(location = 2) flat in vec4 in_tint;
layout(location = 3) flat in uvec2 in_flat;
layout(location = 4) flat in vec3 in_flip;
layout(location = 5) flat in float in_lod;

layout(location = 0) out vec4 out_albedo;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out uint out_surface;

void main()
{
    vec4 albedo = textureLod(card_albedo, in_uv, in_lod);
    float opacity = card_opacity(albedo.a, in_lod) * in_tint.a;
    if (card_noise(in_uv, in_lod, in_flat.y, frame.sample_index) >= opacity)
        discard;
    vec4 packed = textureLod(card_normal, in_uv, in_lod);
    vec3 normal = card_normal_of(packed.xyz, in_pose, in_flip);
    albedo.rgb *= in_tint.rgb;
    if (frame.view_mode == WD_MODE_LOD)
        albedo.rgb = level_color(WD_LEVEL_CARD) * (0.3 + 0.7 * packed.a);
    out_albedo = vec4(albedo.rgb, packed.a);
    out_normal = vec4(normal * 0.5 + 0.5, float(WD_MATERIAL_CARD) / 3.0);
    out_surface = in_flat.x;
}
