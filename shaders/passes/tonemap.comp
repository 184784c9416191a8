#version 460
/* From radiance to what a display shows. */
#include "shared/frame.h"
#include "shared/light.h"
#include "shared/hash.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, set = 0, binding = 0) readonly buffer Frame { wd_frame_uniforms frame; };
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D radiance_image;
layout(set = 0, binding = 2, rgba8) uniform writeonly image2D display_image;
layout(scalar, set = 0, binding = 3) readonly buffer Meter { wd_meter meter; };
layout(scalar, push_constant) uniform Push { wd_post_push push; };

/* AgX (Sobotka 2022; polynomial by Wrensch 2023): colours are drawn toward each other before a
 * film-like curve over 16.5 stops, so that bright ones pale without a turn of hue. */
const mat3 AGX_IN = mat3(0.842479062253094, 0.0423282422610123, 0.0423756549057051,
                         0.0784335999999992, 0.878468636469772, 0.0784336,
                         0.0792237451477643, 0.0791661274605434, 0.879142973793104);
const mat3 AGX_OUT = mat3(1.19687900512017, -0.0528968517574562, -0.0529716355144438,
                          -0.0980208811401368, 1.15190312990417, -0.0980434501171241,
                          -0.0990297440797205, -0.0989611768448433, 1.15107367264116);

vec3 agx_curve(vec3 x)
{
    vec3 x2 = x * x, x4 = x2 * x2;
    return 15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x
           - 0.00232;
}

/* More contrast and colour than AgX's flat base look: slope, power, saturation (ASC CDL). */
vec3 look(vec3 color)
{
    color = pow(max(color, 0.0), vec3(1.42)) * 1.15;
    float luma = dot(color, vec3(0.2126, 0.7152, 0.0722));
    return luma + 1.16 * (color - luma);
}

/* White balance for sun and sky together, as of a camera set to daylight. */
const vec3 DAYLIGHT = vec3(1.04, 1.0, 0.93);

vec3 tone_map(vec3 radiance)
{
    vec3 stops = log2(max(AGX_IN * radiance, 1e-10));
    vec3 curve = agx_curve(clamp((stops + 12.47393) / 16.5, 0.0, 1.0));
    return pow(clamp(AGX_OUT * look(curve), 0.0, 1.0), vec3(2.2));
}

vec3 srgb_encode(vec3 linear)
{
    vec3 low = linear * 12.92, high = 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055;
    return mix(high, low, lessThanEqual(linear, vec3(0.0031308)));
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= int(frame.width) || at.y >= int(frame.height))
        return;
    vec4 sum = imageLoad(radiance_image, at);
    vec3 color = sum.rgb / max(sum.a, 1.0);
    if (frame.view_mode == WD_MODE_LIT) {
        float exposure = frame.exposure > 0.0 ? frame.exposure : meter.exposure;
        color = tone_map(color * DAYLIGHT * (exposure * push.exposure_scale));
    }
    color = srgb_encode(clamp(color, 0.0, 1.0));
    /* half a step of noise either way hides the steps of 8 bits in skies */
    uint random = wd_hash2(uint(at.x), uint(at.y));
    vec3 dither = vec3(random & 0x3ffu, (random >> 10) & 0x3ffu, random >> 22) / 1023.0 - 0.5;
    imageStore(display_image, at, vec4(clamp(color + dither / 255.0, 0.0, 1.0), 1.0));
}
