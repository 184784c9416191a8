#version 460
#include "shared/frame.h"
#include "shared/terrain_patch.h"

layout(scalar, set = 0, binding = 0) readonly buffer Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 1) readonly buffer View { wd_terrain_view view; };
layout(set = 0, binding = 4) uniform sampler2D slopes;
layout(set = 0, binding = 5) uniform sampler2D cover_map;
layout(scalar, set = 0, binding = 6) readonly buffer Holes { uint holes[]; };

#include "lib/noise.glsl"
#include "lib/ground_cover.glsl"

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

vec3 curtain_normal()
{
    int side = int(in_curtain + 0.5);
    return side == WD_EDGE_SOUTH  ? vec3(0.0, -1.0, 0.0)
           : side == WD_EDGE_EAST ? vec3(1.0, 0.0, 0.0)
           : side == WD_EDGE_NORTH ? vec3(0.0, 1.0, 0.0)
                                   : vec3(-1.0, 0.0, 0.0);
}

void main()
{
    vec2 local_m = in_rel.xy + view.camera_m;
    if (view.has_holes != 0u && is_hole(local_m))
        discard;
    vec2 slope = texture(slopes, local_m * view.slopes_scale + view.slopes_offset).xy;
    float cover = texture(cover_map, local_m * view.cover_scale).x;
    float footprint_m = max(length(dFdx(in_rel.xy)), length(dFdy(in_rel.xy)));
    ground_look look = ground_cover(in_rel, slope, cover, footprint_m);
    if (in_curtain > 0.0) {
        look.albedo = frame.soil * (0.75 + 0.25 * cos(in_rel.z * 1.3));
        look.normal = curtain_normal();
        look.openness = 0.5;
    }
    out_albedo = vec4(look.albedo, look.openness);
    out_normal = vec4(look.normal * 0.5 + 0.5, float(WD_MATERIAL_GROUND) / 3.0);
    out_surface = 0u;
}
