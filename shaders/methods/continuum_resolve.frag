#version 460
/* From ids in the visibility buffer to surface, once a pixel: of wood where it has depth and nothing else
 * yet, then of splats where either has. llvmpipe passes over pixels that fail the depth test; after a
 * discard it runs to the end all the same. */
#include "shared/frame.h"
#include "shared/forest.h"
#include "shared/continuum.h"
#include "shared/sun_ways.h"

layout(constant_id = 0) const uint WOOD = 0u; /* splats and wood apart */

wd_frame_uniforms frame; /* what of it continuum_resolve.vert tells; no other member has a value */
#include "lib/resolve.glsl"

layout(location = 0) flat in vec4 in_right;
layout(location = 1) flat in vec4 in_up;
layout(location = 2) flat in vec4 in_middle;
layout(location = 3) flat in vec3 in_sun;

layout(location = 0) out vec4 out_albedo;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out uint out_surface;

void know_frame()
{
    frame.rel_from_clip =
        mat4(vec4(in_right.xyz, 0.0), vec4(in_up.xyz, 0.0), vec4(0.0), vec4(in_middle.xyz, 0.0));
    frame.width = uint(in_right.w);
    frame.height = uint(in_up.w);
    frame.view_mode = uint(in_middle.w);
    frame.sun_direction = in_sun;
}

void main()
{
    know_frame();
    uvec2 at = uvec2(gl_FragCoord.xy);
    uint id = texelFetch(pixels, int(at.y * frame.width + at.x)).x;
    if (((id & WD_ID_WOOD) != 0u) != (WOOD != 0u))
        discard;
    wd_resolved seen = resolve(at, id, WOOD != 0u);
    out_albedo = seen.albedo;
    out_normal = seen.normal;
    out_surface = seen.surface;
}
