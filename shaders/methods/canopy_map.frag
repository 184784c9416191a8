#version 460
/* Puts what canopy_map.comp has found into the G-buffer, over the ground, whose depth stays. */
#include "shared/frame.h"
#include "shared/canopy_map.h"
#include "shared/forest.h"

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 1) readonly buffer Canopy { wd_canopy_pixel canopy[]; };

#include "lib/tree.glsl"

layout(location = 0) out vec4 out_albedo;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out uint out_surface;

void main()
{
    uvec2 at = uvec2(gl_FragCoord.xy);
    wd_canopy_pixel pixel = canopy[at.y * frame.width + at.x];
    if (pixel.surface == 0u)
        discard;
    vec4 albedo = unpackUnorm4x8(pixel.albedo);
    albedo.rgb *= albedo.rgb;
    if (frame.view_mode == WD_MODE_LOD)
        albedo.rgb = vec3(0.45, 0.10, 0.55) * (0.3 + 0.7 * albedo.a);
    out_albedo = albedo;
    out_normal = vec4(unpackUnorm4x8(pixel.normal).xyz, float(WD_MATERIAL_CARD) / 3.0);
    out_surface = pixel.surface;
}
