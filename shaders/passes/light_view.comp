#version 460
/* View modes for looking into a picture, for display without tone mapping. */
#include "shared/frame.h"
#include "shared/forest.h"
#include "shared/light.h"

layout(local_size_x = WD_TILE, local_size_y = WD_TILE) in;

layout(scalar, set = 0, binding = 0) readonly buffer Frame { wd_frame_uniforms frame; };
layout(set = 0, binding = 1) uniform sampler2D gbuffer_albedo;
layout(set = 0, binding = 2) uniform sampler2D gbuffer_normal;
layout(set = 0, binding = 3) uniform usampler2D gbuffer_surface;
layout(set = 0, binding = 4) uniform sampler2D gbuffer_depth;
layout(set = 0, binding = 5) uniform sampler2DArrayShadow shadow_map;
layout(set = 0, binding = 6) uniform sampler2DArray shadow_depth;
layout(scalar, set = 0, binding = 7) readonly buffer SunHeights { float sun_height_m[]; };
layout(set = 0, binding = 8) uniform usamplerBuffer trees; /* wd_packed_tree */
layout(set = 0, binding = 9) uniform usamplerBuffer lit_models; /* wd_lit_model */
layout(set = 0, binding = 10, rgba32f) uniform image2D radiance_image;
layout(scalar, push_constant) uniform Push { wd_light_push push; };

#define TREE_TEXELS
layout(constant_id = 0) const uint COMPARES = 0u; /* see lib/shadow.glsl */
#define SHADOW_DEPTH shadow_depth
#define SHADOW_COMPARES (COMPARES != 0u)
#define SUN_HEIGHT_AT(index) sun_height_m[index]
#define PARTS WD_PART_ALL

#include "lib/trees.glsl"
#include "lib/noise.glsl"
#include "lib/shadow.glsl"
#include "lib/gbuffer.glsl"
#include "lib/tree.glsl"
#include "lib/crown.glsl"
#include "lib/shade.glsl"
#include "shared/hash.h"

vec3 id_color(uint surface)
{
    if (surface == 0u)
        return vec3(0.02);
    uint h = wd_hash1(wd_tree_random(tree_at(surface - 1u)));
    return vec3(h & 0xffu, (h >> 8) & 0xffu, (h >> 16) & 0xffu) * (0.9 / 255.0) + 0.1;
}

vec3 view_color(wd_pixel pixel, uvec2 at)
{
    float sun_share, ground_share;
    shade(pixel, at, sun_share, ground_share);
    switch (frame.view_mode) {
    case WD_MODE_LOD: return pixel.albedo * (0.6 + 0.4 * pixel.normal.z);
    case WD_MODE_NORMAL: return pow(pixel.normal * 0.5 + 0.5, vec3(2.2));
    case WD_MODE_TREE_ID: return id_color(pixel.surface);
    case WD_MODE_SHADOW: return vec3(sun_share);
    }
    return pixel.albedo;
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= int(frame.width) || at.y >= int(frame.height))
        return;
    float depth = texelFetch(gbuffer_depth, at, 0).x;
    vec3 color = vec3(0.0);
    if (!pixel_is_sky(depth))
        color = view_color(gbuffer_pixel(at, depth), uvec2(at));
    vec4 radiance = vec4(color, 1.0);
    if (frame.adds != 0u)
        radiance += imageLoad(radiance_image, at);
    imageStore(radiance_image, at, radiance);
}
