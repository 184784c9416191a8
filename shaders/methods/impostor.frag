#version 460
/* Colours of leaves and wood; noise decides what of it covers, and which of its trees a pixel shows. */
#include "shared/frame.h"
#include "shared/forest.h"
#include "shared/hash.h"

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame; };

layout(location = 0) in vec2 in_uv;
layout(location = 1) flat in float in_cover;
layout(location = 2) flat in vec3 in_normal;
layout(location = 3) flat in vec3 in_cells;
layout(location = 4) flat in uvec4 in_flat;
layout(location = 5) flat in vec4 in_leaf;
layout(location = 6) flat in vec4 in_wood;

layout(location = 0) out vec4 out_albedo;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out uint out_surface;

#include "lib/card_material.glsl"
#include "lib/dither.glsl"

void main()
{
    uvec2 cell = uvec2(in_uv * in_cells.xy);
    uint noise = wd_hash_mix((cell.x | (cell.y << 16)) ^ in_flat.z
                             ^ frame.sample_index * 0x9e3779b9u);
    float threshold = fract(dither_from(cell, in_flat.z)
                            + float(frame.sample_index & 1023u) * 0.61803399);
    if (threshold >= in_cover)
        discard;
    uint tree = in_flat.x + wd_hash1(noise) % max(in_flat.y, 1u);
    uint material = card_material(in_cells.z, cell, noise);
    vec4 own = material == WD_MATERIAL_WOOD ? in_wood : in_leaf;
    if (frame.view_mode == WD_MODE_LOD)
        own.rgb = vec3(0.5, 0.05, 0.6) * (0.3 + 0.7 * own.a);
    out_albedo = own;
    out_normal = vec4(in_normal * 0.5 + 0.5, float(material) / 3.0);
    out_surface = tree + 1u;
}
