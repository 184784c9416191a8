#version 460
/* Where each surface was a frame ago: motion in pixels, x right, y down. */
#include "shared/frame.h"
#include "shared/forest.h"
#include "shared/light.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame; };
layout(set = 0, binding = 1) uniform sampler2D gbuffer_albedo;
layout(set = 0, binding = 2) uniform sampler2D gbuffer_normal;
layout(set = 0, binding = 3) uniform usampler2D gbuffer_surface;
layout(set = 0, binding = 4) uniform sampler2D gbuffer_depth;
layout(scalar, set = 0, binding = 5) readonly buffer Trees { wd_packed_tree trees[]; };
layout(scalar, set = 0, binding = 6) readonly buffer Models { wd_model models[]; };
layout(scalar, set = 0, binding = 7) writeonly buffer Velocity { vec2 velocity_px[]; };
layout(scalar, push_constant) uniform Push { wd_light_push push; };

#include "lib/trees.glsl"
#include "lib/gbuffer.glsl"
#include "lib/tree.glsl"

/* How far the wind has carried a tree's point since the previous time. */
vec3 swayed(uint surface, vec3 rel)
{
    wd_tree tree = tree_at(surface - 1u);
    wd_model model = models[WD_TREE_SPECIES(tree) * push.variants + WD_TREE_VARIANT(tree)];
    float height_m = rel.z - tree_foot_rel(tree).z;
    return tree_sway(tree, model.flexibility, height_m, frame.time_s)
           - tree_sway(tree, model.flexibility, height_m, frame.previous_time_s);
}

vec2 pixel_velocity(ivec2 at)
{
    float depth = texelFetch(gbuffer_depth, at, 0).x;
    vec4 was;
    if (pixel_is_sky(depth)) {
        was = frame.previous_clip_from_rel * vec4(pixel_ray(at), 0.0);
    } else {
        wd_pixel pixel = gbuffer_pixel(at, depth);
        vec3 moved = pixel.surface != 0u ? swayed(pixel.surface, pixel.rel) : vec3(0.0);
        was = frame.previous_clip_from_rel * vec4(pixel.rel - moved, 1.0);
    }
    if (was.w <= 0.0)
        return vec2(0.0);
    vec4 now = frame.steady_clip_from_rel * vec4(pixel_ray(at), 0.0);
    vec2 shift = now.xy / now.w - was.xy / was.w;
    return shift * 0.5 * vec2(frame.width, frame.height);
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x < int(frame.width) && at.y < int(frame.height))
        velocity_px[at.y * int(frame.width) + at.x] = pixel_velocity(at);
}
