#version 460
/* Where the ground is, for terrain_shade.comp. */
#include "shared/terrain_patch.h"

layout(scalar, set = 0, binding = 1) uniform View { wd_terrain_view view; };
layout(constant_id = 0) const uint HAS_HOLES = 1u;

#include "lib/ground_hole.glsl"

layout(location = 0) in vec3 in_rel;
layout(location = 1) in float in_curtain;

layout(location = 0) out uint out_surface;

void main()
{
    if (HAS_HOLES != 0u && is_hole(in_rel.xy + view.camera_m))
        discard;
    out_surface = WD_GROUND_MARK + uint(in_curtain + 0.5);
}
