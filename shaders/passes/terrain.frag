#version 460
#include "shared/frame.h"
#include "shared/terrain_patch.h"

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 1) uniform View { wd_terrain_view view; };
layout(constant_id = 0) const uint HAS_HOLES = 1u;
layout(constant_id = 1) const uint IS_NEAR = 1u;

#include "lib/ground_hole.glsl"
#include "lib/ground_look.glsl"

layout(location = 0) in vec3 in_rel;
layout(location = 1) in float in_curtain;

layout(location = 0) out vec4 out_albedo;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out uint out_surface;

void main()
{
    if (HAS_HOLES != 0u && is_hole(in_rel.xy + view.camera_m))
        discard;
    wd_ground_look look = ground_look(in_rel, int(in_curtain + 0.5));
    out_surface = 0u;
    out_albedo = vec4(look.albedo, look.openness);
    out_normal = vec4(look.normal * 0.5 + 0.5, float(WD_MATERIAL_GROUND) / 3.0);
}
