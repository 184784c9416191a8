#version 460
/* A billboard's light, premultiplied by its opacity, for blending back to front. Lit as the light
 * pass lights cards. */
#include "shared/frame.h"
#include "shared/forest.h"
#include "shared/patch_order.h"

layout(scalar, set = 0, binding = 0) readonly buffer Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 1) readonly buffer Trees { wd_tree trees[]; };
layout(scalar, set = 0, binding = 2) readonly buffer Models { wd_model models[]; };
layout(set = 0, binding = 4) uniform sampler2DArray card_albedo;
layout(set = 0, binding = 5) uniform sampler2DArray card_normal;
layout(set = 0, binding = 7) uniform sampler2DArrayShadow shadow_map;
layout(scalar, set = 0, binding = 8) readonly buffer SunHeights { float sun_height_m[]; };
layout(scalar, push_constant) uniform Push { wd_patch_push patch_push; };

#define PARTS (WD_PART_GROUND | WD_PART_TREES)
#define SUN_HEIGHT_AT(index) sun_height_m[index]

#include "lib/tree.glsl"
#define push patch_push.light /* the libraries' name for it; lib/tree.glsl has others of its own */
#include "lib/noise.glsl"
#include "lib/sky.glsl"
#include "lib/shadow.glsl"
#include "lib/pixel.glsl"
#include "lib/crown.glsl"
#include "lib/shade.glsl"
#include "lib/card.glsl"

layout(location = 0) in vec3 in_uv;
layout(location = 1) flat in vec4 in_pose;
layout(location = 2) flat in vec4 in_tint;
layout(location = 3) flat in uvec2 in_flat;
layout(location = 4) flat in vec3 in_flip;
layout(location = 5) flat in float in_lod;

layout(location = 0) out vec4 out_color;

void main()
{
    vec4 albedo = textureLod(card_albedo, in_uv, in_lod);
    float opacity = card_opacity(albedo.a, in_lod) * in_tint.a;
    if (opacity < 1.0 / 255.0)
        discard;
    vec4 packed = textureLod(card_normal, in_uv, in_lod);
    wd_pixel pixel;
    pixel.ray = pixel_ray(ivec2(gl_FragCoord.xy));
    pixel.direction = normalize(pixel.ray);
    pixel.axis_m = frame.near_m / gl_FragCoord.z;
    pixel.rel = pixel.ray * pixel.axis_m;
    pixel.albedo = albedo.rgb * in_tint.rgb;
    pixel.openness = packed.a;
    pixel.normal = card_normal_of(packed.xyz, in_pose, in_flip);
    pixel.material = WD_MATERIAL_CARD;
    pixel.surface = in_flat.x;
    float sun_share, ground_share;
    vec3 radiance = shade(pixel, uvec2(gl_FragCoord.xy), sun_share, ground_share);
    radiance = apply_fog(radiance, pixel.direction, length(pixel.rel), ground_share);
    out_color = vec4(radiance * opacity, opacity);
}
