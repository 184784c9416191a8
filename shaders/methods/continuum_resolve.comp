#version 460
/* From the visibility buffer to the G-buffer, all of it; depth is to be copied there. */
#include "shared/frame.h"
#include "shared/forest.h"
#include "shared/continuum.h"
#include "shared/sun_ways.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame; };
#include "lib/resolve.glsl"
#include "lib/splat_depth.glsl"

#include "lib/stored_targets.glsl"
layout(set = 0, binding = 10, rgba8) uniform writeonly image2D to_albedo;
layout(set = 0, binding = 11, rgb10_a2) uniform writeonly image2D to_normal;
layout(set = 0, binding = 12, r32ui) uniform writeonly uimage2D to_surface;
layout(scalar, set = 0, binding = 13) writeonly buffer Depths { uint depths[]; };

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= frame.width || at.y >= frame.height)
        return;
    uint index = at.y * frame.width + at.x, depth = 0u;
    uvec2 pixel = texelFetch(pixels, int(index)).xy;
    wd_resolved seen = wd_resolved(vec4(0.0), vec4(0.0), 0u);
    if (pixel.x != 0u) {
        bool of_wood = (pixel.x & WD_ID_WOOD) != 0u;
        seen = resolve(at, pixel.x, of_wood);
        depth = of_wood ? pixel.y : floatBitsToUint(splat_true_depth(pixel, frame.near_m));
    }
    imageStore(to_albedo, ivec2(at), stored_albedo(seen.albedo));
    imageStore(to_normal, ivec2(at), seen.normal);
    imageStore(to_surface, ivec2(at), uvec4(seen.surface));
    depths[index] = depth;
}
