#version 460
/* From the visibility buffer to what the G-buffer's images hold, in their formats: of each of these, one after
 * another, a word a pixel, to be copied. For devices on which fragments cost more than that. */
#include "shared/frame.h"
#include "shared/forest.h"
#include "shared/continuum.h"
#include "shared/sun_ways.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame; };
#include "lib/resolve.glsl"
#include "lib/splat_depth.glsl"

layout(scalar, set = 0, binding = 10) writeonly buffer Words { uint words[]; }; /* WD_RESOLVED_* */

uint pack_srgb(vec4 color)
{
    vec3 c = clamp(color.rgb, 0.0, 1.0);
    c = mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThan(c, vec3(0.0031308)));
    return packUnorm4x8(vec4(c, color.a));
}

uint pack_a2b10g10r10(vec4 v)
{
    uvec4 q = uvec4(clamp(v, 0.0, 1.0) * vec4(1023.0, 1023.0, 1023.0, 3.0) + 0.5);
    return q.x | q.y << 10 | q.z << 20 | q.w << 30;
}

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= frame.width || at.y >= frame.height)
        return;
    uint index = at.y * frame.width + at.x, all = frame.width * frame.height;
    uvec2 pixel = texelFetch(pixels, int(index)).xy;
    uint albedo = 0u, normal = 0u, surface = 0u, depth = 0u;
    if (pixel.x != 0u) {
        bool of_wood = (pixel.x & WD_ID_WOOD) != 0u;
        wd_resolved seen = resolve(at, pixel.x, of_wood);
        albedo = pack_srgb(seen.albedo);
        normal = pack_a2b10g10r10(seen.normal);
        surface = seen.surface;
        depth = of_wood ? pixel.y : floatBitsToUint(splat_true_depth(pixel, frame.near_m));
    }
    words[WD_RESOLVED_ALBEDO * all + index] = albedo;
    words[WD_RESOLVED_NORMAL * all + index] = normal;
    words[WD_RESOLVED_SURFACE * all + index] = surface;
    words[WD_RESOLVED_DEPTH * all + index] = depth;
}
