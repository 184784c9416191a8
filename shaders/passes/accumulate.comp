#version 460
/* Lays this frame's sample over what earlier ones have shown of the same surfaces: temporal
 * reprojection as in Karis 2014, with history held within the spread of the sample's neighbours
 * (Salvi 2016), and told apart by tree and depth, so that what comes out from behind a tree begins
 * anew. */
#include "shared/frame.h"
#include "shared/accumulate.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint STORES = 0u; /* 1: hands the means back to the picture */

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame; };
layout(set = 0, binding = 1, rgba32f) uniform image2D radiance_image;
layout(set = 0, binding = 2) uniform usampler2D gbuffer_surface;
layout(set = 0, binding = 3) uniform sampler2D gbuffer_depth;
layout(scalar, set = 0, binding = 4) readonly buffer Velocity { vec2 velocity_px[]; };
/* shared/accumulate.h */
layout(scalar, set = 0, binding = 5) readonly buffer RedGreenBefore { vec2 red_green_before[]; };
layout(scalar, set = 0, binding = 6) readonly buffer BlueSamplesBefore { vec2 blue_samples_before[]; };
layout(scalar, set = 0, binding = 7) readonly buffer SeenBefore { uvec2 seen_before[]; };
layout(scalar, set = 0, binding = 8) buffer RedGreenNow { vec2 red_green_now[]; };
layout(scalar, set = 0, binding = 9) buffer BlueSamplesNow { vec2 blue_samples_now[]; };
layout(scalar, set = 0, binding = 10) writeonly buffer SeenNow { uvec2 seen_now[]; };
layout(scalar, push_constant) uniform Push { wd_accumulate_push push; };

/* Of a pixel and the eight around it. */
uint surfaces[9];
float depths[9];
vec3 lowest, highest;

uint index_of(ivec2 at)
{
    return uint(at.y) * frame.width + uint(at.x);
}

void read_neighbours(ivec2 at)
{
    ivec2 last = ivec2(frame.width, frame.height) - 1;
    vec3 sum = vec3(0.0), squares = vec3(0.0);
    for (int i = 0; i < 9; i++) {
        ivec2 near = clamp(at + ivec2(i % 3, i / 3) - 1, ivec2(0), last);
        vec3 radiance = imageLoad(radiance_image, near).rgb;
        surfaces[i] = texelFetch(gbuffer_surface, near, 0).x;
        depths[i] = texelFetch(gbuffer_depth, near, 0).x;
        sum += radiance;
        squares += radiance * radiance;
    }
    vec3 mean = sum / 9.0, spread = sqrt(max(squares / 9.0 - mean * mean, 0.0));
    lowest = mean - spread;
    highest = mean + spread;
}

/* Whether a surface seen then is one of those seen around here now. */
bool is_known(uint surface, float depth)
{
    for (int i = 0; i < 9; i++) {
        if (surfaces[i] == surface && max(depth, depths[i]) <= 1.25 * min(depth, depths[i]))
            return true;
    }
    return false;
}

/* Mean of the four pixels around a place in the frame before, as far as they are known; w: samples. */
vec4 fetch_history(vec2 place)
{
    vec2 corner = floor(place - 0.5), share = place - 0.5 - corner;
    vec4 sum = vec4(0.0);
    float weight = 0.0;
    for (int i = 0; i < 4; i++) {
        ivec2 tap = ivec2(corner) + ivec2(i & 1, i >> 1);
        if (any(lessThan(tap, ivec2(0))) || tap.x >= int(frame.width) || tap.y >= int(frame.height))
            continue;
        uint index = index_of(tap);
        uvec2 seen = seen_before[index];
        vec2 shares = mix(1.0 - share, share, vec2(i & 1, i >> 1));
        float counts = shares.x * shares.y;
        if (counts <= 0.0 || !is_known(seen.x, uintBitsToFloat(seen.y)))
            continue;
        sum += counts * vec4(red_green_before[index], blue_samples_before[index]);
        weight += counts;
    }
    return weight > 0.05 ? sum / weight : vec4(0.0);
}

void gather(ivec2 at)
{
    uint index = index_of(at);
    vec3 sample_radiance = imageLoad(radiance_image, at).rgb;
    vec4 history = vec4(0.0);
    if (push.has_history != 0u && push.still != 0u) {
        history = vec4(red_green_before[index], blue_samples_before[index]);
        history.w = min(history.w, WD_STILL_SAMPLES - 1.0);
    } else if (push.has_history != 0u) {
        read_neighbours(at);
        vec2 moved_px = velocity_px[index];
        history = fetch_history(vec2(at) + 0.5 - moved_px);
        history.rgb = clamp(history.rgb, lowest, highest);
        history.w = min(history.w, WD_MOVING_SAMPLES - 1.0);
    }
    float samples = history.w + 1.0;
    vec3 mean = mix(history.rgb, sample_radiance, 1.0 / samples);
    red_green_now[index] = mean.rg;
    blue_samples_now[index] = vec2(mean.b, samples);
    seen_now[index] = uvec2(texelFetch(gbuffer_surface, at, 0).x,
                            floatBitsToUint(texelFetch(gbuffer_depth, at, 0).x));
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= int(frame.width) || at.y >= int(frame.height))
        return;
    uint index = index_of(at);
    if (STORES != 0u)
        imageStore(radiance_image, at, vec4(red_green_now[index], blue_samples_now[index].x, 1.0));
    else
        gather(at);
}
