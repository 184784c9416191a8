#version 460
#include "shared/frame.h"
#include "shared/terrain_patch.h"

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 1) uniform View { wd_terrain_view view; };
layout(constant_id = 0) const uint HAS_HOLES = 1u;
layout(constant_id = 1) const uint IS_NEAR = 1u;

layout(set = 0, binding = 4) uniform sampler2D slopes;
layout(set = 0, binding = 5) uniform sampler2D cover_map; /* x: of the place, y: about it, z: a
                                                            quarter of the sward's layers */
layout(scalar, set = 0, binding = 6) readonly buffer Holes { uint holes[]; };

layout(scalar, set = 0, binding = 7) readonly buffer Waters { float water_m[]; };

#define WATER_AT(index) water_m[index]
#include "lib/river.glsl"
#define WD_STREWN_SHOWN (IS_NEAR != 0u)
#include "shared/ground_cover.h"

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

/* Size of the pixel on the ground: a mean of its length away from the eye and its width. Taken from
 * distance and slope, as differences between pixels are wrong where triangles end. */
float footprint_of(float distance_m, vec2 slope)
{
    vec3 normal = normalize(vec3(-slope, 1.0));
    float facing = abs(dot(normal, in_rel)) / distance_m;
    return distance_m * view.pixel_rad / sqrt(max(facing, 0.02));
}

/* Share of the sky's light that a sward leaves to the ground that is seen between its blades; where it
 * is too far off to be drawn, the ground stands for all of it. */
float sward_open(float layers, float distance_m)
{
    float gone = view.sward_fade_m.y > 0.0
                     ? clamp((distance_m - view.sward_fade_m.x)
                                 / max(view.sward_fade_m.y - view.sward_fade_m.x, 1e-3), 0.0, 1.0)
                     : 0.0;
    return exp(-0.35 * layers * (1.0 - gone));
}

void main()
{
    vec2 local_m = in_rel.xy + view.camera_m;
    if (HAS_HOLES != 0u && is_hole(local_m))
        discard;
    float distance_m = length(in_rel);
    float level = log2(distance_m * view.pixel_rad * 1.5);
    vec2 slope = textureLod(slopes, local_m * view.slopes_scale + view.slopes_offset,
                            level - log2(view.slopes_texel_m)).xy;
    vec3 cover = textureLod(cover_map, local_m * view.cover_scale,
                            level - log2(view.cover_texel_m)).xyz;
    float river_m = water_m.length() > 1 ? river_level(local_m) : WD_NO_WATER_M;
    wd_ground_look look = wd_ground_cover(in_rel, slope.x, slope.y, cover.x, cover.y, river_m,
                                          footprint_of(distance_m, slope));
    look.openness *= sward_open(4.0 * cover.z, distance_m);
    if (in_curtain > 0.0) {
        look.albedo = frame.soil * (0.75 + 0.25 * cos(in_rel.z * 1.3));
        look.normal = curtain_normal();
        look.openness = 1.0;
    }
    out_albedo = vec4(look.albedo, look.openness);
    out_normal = vec4(look.normal * 0.5 + 0.5, float(WD_MATERIAL_GROUND) / 3.0);
    out_surface = 0u;
}
