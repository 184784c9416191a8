#version 460
#include "shared/frame.h"
#include "shared/terrain_patch.h"

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 1) uniform View { wd_terrain_view view; };
layout(constant_id = 0) const uint HAS_HOLES = 1u;
layout(constant_id = 1) const uint IS_NEAR = 1u;
layout(constant_id = 2) const uint MARKS = 0u; /* 1: terrain_shade.comp does the rest */

layout(scalar, set = 0, binding = 6) readonly buffer Holes { uint holes[]; };
#include "lib/ground_look.glsl"

layout(location = 0) in vec3 in_rel;
layout(location = 1) in float in_curtain;

layout(location = 0) out vec4 out_albedo;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out uint out_surface;

bool hole_at(uint index)
{
    return (holes[index >> 2] >> ((index & 3u) * 8u) & 0xffu) != 0u;
}

/* A triangle with a corner that is cut out is not drawn, whatever level draws the place. */
bool is_hole(vec2 local_m)
{
    vec2 at = clamp(local_m / view.cell_m, vec2(0.0), vec2(view.width, view.height) - 1.001);
    uvec2 cell = uvec2(at);
    vec2 share = at - vec2(cell);
    uint first = cell.y * view.width + cell.x;
    uint corner = share.x >= share.y ? first + 1u : first + view.width;
    return hole_at(first) || hole_at(corner) || hole_at(first + view.width + 1u);
}

void main()
{
    if (HAS_HOLES != 0u && is_hole(in_rel.xy + view.camera_m))
        discard;
    int side = int(in_curtain + 0.5);
    out_surface = 0u;
    if (MARKS != 0u) {
        out_albedo = vec4(0.0);
        out_normal = vec4(float(side) / WD_MARKED_SIDES, 0.0, 0.0, float(WD_MATERIAL_GROUND) / 3.0);
        return;
    }
    wd_ground_look look = ground_look(in_rel, side);
    out_albedo = vec4(look.albedo, look.openness);
    out_normal = vec4(look.normal * 0.5 + 0.5, float(WD_MATERIAL_GROUND) / 3.0);
}
