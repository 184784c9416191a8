#version 460
/* From radiance to what a display shows. */
#include "shared/frame.h"
#include "shared/tone.h"
#include "shared/hash.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint BLOOM = 0u; /* 1: the lens spreads light */
layout(constant_id = 1) const uint LIT = 1u;   /* 0: a view into the picture, without exposure and tone curve */

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame_block; };
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D radiance_image;
layout(set = 0, binding = 2, rgba8) uniform writeonly image2D display_image;
layout(scalar, set = 0, binding = 3) readonly buffer Meter { wd_meter meter; };
layout(scalar, set = 0, binding = 4) readonly buffer Bloom { vec4 bloom[]; };
layout(scalar, push_constant) uniform Push { wd_post_push push_block; };

/* Read before any branch: lib/light_pixels.glsl tells why. */
wd_frame_uniforms frame = frame_block;
wd_post_push push = push_block;
float metered = meter.exposure;

#include "lib/bloom.glsl"

vec3 spread_light(ivec2 at)
{
    wd_bloom_level level = wd_bloom_level(0u, (frame.width + 1u) / 2u, (frame.height + 1u) / 2u);
    return bloom_linear(level, (vec2(at) + 0.5) * 0.5) / float(WD_BLOOM_LEVELS);
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= int(frame.width) || at.y >= int(frame.height))
        return;
    vec4 sum = imageLoad(radiance_image, at);
    vec3 color = sum.rgb / max(sum.a, 1.0);
    if (BLOOM != 0u)
        color = mix(color, spread_light(at), push.bloom);
    float exposure = frame.exposure > 0.0 ? frame.exposure : metered;
    if (LIT != 0u)
        color = wd_tone_display(color * (exposure * push.exposure_scale));
    else
        color = vec3(wd_display_encode(min(color.r, 1.0)), wd_display_encode(min(color.g, 1.0)),
                     wd_display_encode(min(color.b, 1.0)));
    /* half a step of noise either way hides the steps of 8 bits in skies */
    uint random = wd_hash2(uint(at.x), uint(at.y));
    vec3 dither = vec3(random & 0x3ffu, (random >> 10) & 0x3ffu, random >> 22) / 1023.0 - 0.5;
    imageStore(display_image, at, vec4(clamp(color + dither / 255.0, 0.0, 1.0), 1.0));
}
