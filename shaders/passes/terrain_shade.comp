#version 460
/* What the ground looks like where terrain_mark.frag has marked it. */
#include "shared/frame.h"
#include "shared/terrain_patch.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 1) uniform View { wd_terrain_view view; };
const uint IS_NEAR = 1u;

layout(set = 0, binding = 2) uniform sampler2D gbuffer_depth;
layout(set = 0, binding = 3, r32ui) uniform uimage2D surfaces;
layout(set = 0, binding = 6, rgba8) uniform writeonly image2D to_albedo;
layout(set = 0, binding = 8, rgb10_a2) uniform writeonly image2D to_normal;
#include "lib/ground_look.glsl"
#include "lib/stored_targets.glsl"
#include "lib/view.glsl"

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= int(frame.width) || at.y >= int(frame.height))
        return;
    uint mark = imageLoad(surfaces, at).x;
    if (mark < WD_GROUND_MARK)
        return;
    float depth = texelFetch(gbuffer_depth, at, 0).x;
    wd_ground_look look = ground_look(pixel_ray(at) * (frame.near_m / depth), int(mark - WD_GROUND_MARK));
    imageStore(to_albedo, at, stored_albedo(vec4(look.albedo, look.openness)));
    imageStore(to_normal, at, vec4(look.normal * 0.5 + 0.5, float(WD_MATERIAL_GROUND) / 3.0));
    imageStore(surfaces, at, uvec4(0u));
}
