#version 460
/* A billboard's light, premultiplied by its opacity, for blending back to front. Lit as the light
 * pass lights cards. */
#include "shared/frame.h"
#include "shared/forest.h"
#include "shared/patch_order.h"

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 1) readonly buffer Trees { wd_packed_tree trees[]; };
layout(set = 0, binding = 4) uniform sampler2DArray card_albedo;
layout(set = 0, binding = 5) uniform sampler2DArray card_normal;
layout(set = 0, binding = 7) uniform sampler2DArray card_leaf;
layout(set = 0, binding = 8) uniform sampler2DArrayShadow shadow_map;
layout(scalar, set = 0, binding = 9) readonly buffer SunHeights { float sun_height_m[]; };
layout(set = 0, binding = 11) uniform sampler2DArray canopy_light;
layout(set = 0, binding = 12) uniform usamplerBuffer lit_models; /* wd_lit_model */
layout(scalar, push_constant) uniform Push { wd_patch_push patch_push; };

#define PARTS (WD_PART_GROUND | WD_PART_TREES)
#define SUN_HEIGHT_AT(index) sun_height_m[index]
#define CANOPY_LIGHT_AT(at, layer) textureLod(canopy_light, vec3(at, layer), 0.0)
#define CANOPY_LIGHT canopy_light

#include "lib/trees.glsl"
#include "lib/tree.glsl"
#define push patch_push.light /* the libraries' name for it; lib/tree.glsl has others of its own */
#include "lib/noise.glsl"
#include "lib/sky.glsl"
#include "lib/shadow.glsl"
#include "lib/pixel.glsl"
#include "lib/crown.glsl"
#include "lib/shade.glsl"
#include "lib/card.glsl"
#include "lib/card_flat.glsl"
#include "lib/card_own.glsl"

layout(location = 0) in vec2 in_uv;
layout(location = 1) flat in uvec4 in_card; /* turn, tint_show, normal, ratio_flags */
layout(location = 2) flat in uvec4 in_more; /* layer_lod, random_stem, surface, mixed */

layout(location = 0) out vec4 out_color;

void main()
{
    float lod = card_lod(in_more.x);
    vec3 uv = vec3(in_uv, card_layer(in_more.x));
    vec4 albedo = textureLod(card_albedo, uv, lod), tint_show = unpackUnorm4x8(in_card.y);
    float opacity = card_opacity(albedo.a, lod) * tint_show.a;
    if (opacity < 1.0 / 255.0)
        discard;
    vec4 packed = textureLod(card_normal, uv, lod - float(WD_CARD_NORMAL_MIP));
    float leaf = textureLod(card_leaf, uv, lod - float(WD_CARD_NORMAL_MIP)).x;
    wd_pixel pixel;
    pixel.ray = pixel_ray(ivec2(gl_FragCoord.xy));
    pixel.direction = normalize(pixel.ray);
    pixel.axis_m = frame.near_m / gl_FragCoord.z;
    pixel.rel = pixel.ray * pixel.axis_m;
    card_own own = card_own_at(uv, lod, vec4(albedo.rgb, packed.a), leaf, in_card, in_more);
    pixel.material = own.wood ? WD_MATERIAL_WOOD : WD_MATERIAL_CARD;
    pixel.albedo = own.wood ? own.mean.rgb : own.mean.rgb * tint_show.rgb * 2.0;
    pixel.openness = own.mean.a;
    pixel_set_normal(pixel, card_world_normal(packed.xyz, in_card));
    pixel.surface = in_more.z;
    pixel.lit = -1.0;
    pixel.above = pixel.mirrors = 0.0;
    pixel_lay_snow(pixel);
    know_eye();
    float sun_share, ground_share;
    vec3 radiance = shade(pixel, uvec2(gl_FragCoord.xy), sun_share, ground_share);
    radiance = apply_haze(radiance, pixel.direction, length(pixel.rel), ground_share);
    out_color = vec4(radiance * opacity, opacity);
}
