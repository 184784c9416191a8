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
layout(scalar, set = 0, binding = 5) readonly buffer Before { wd_history_pixel before[]; };
layout(scalar, set = 0, binding = 6) buffer Now { wd_history_pixel now[]; };
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
        wd_history_pixel pixel = before[index_of(tap)];
        vec2 shares = mix(1.0 - share, share, vec2(i & 1, i >> 1));
        float counts = shares.x * shares.y;
        if (counts <= 0.0 || !is_known(pixel.surface, pixel.depth))
            continue;
        sum += counts * vec4(pixel.radiance, pixel.samples);
        weight += counts;
    }
    return weight > 0.05 ? sum / weight : vec4(0.0);
}

void gather(ivec2 at)
{
    vec3 sample_radiance = imageLoad(radiance_image, at).rgb;
    vec4 history = vec4(0.0);
    if (push.has_history != 0u && push.still != 0u) {
        wd_history_pixel same = before[index_of(at)];
        history = vec4(same.radiance, min(same.samples, WD_STILL_SAMPLES - 1.0));
    } else if (push.has_history != 0u) {
        read_neighbours(at);
        vec2 moved_px = velocity_px[index_of(at)];
        history = fetch_history(vec2(at) + 0.5 - moved_px);
        history.rgb = clamp(history.rgb, lowest, highest);
        history.w = min(history.w, WD_MOVING_SAMPLES - 1.0);
    }
    wd_history_pixel mean;
    mean.samples = history.w + 1.0;
    mean.radiance = mix(history.rgb, sample_radiance, 1.0 / mean.samples);
    mean.surface = texelFetch(gbuffer_surface, at, 0).x;
    mean.depth = texelFetch(gbuffer_depth, at, 0).x;
    now[index_of(at)] = mean;
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= int(frame.width) || at.y >= int(frame.height))
        return;
    if (STORES != 0u)
        imageStore(radiance_image, at, vec4(now[index_of(at)].radiance, 1.0));
    else
        gather(at);
}
