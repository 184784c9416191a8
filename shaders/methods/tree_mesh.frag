#version 460
#include "shared/frame.h"
#include "shared/forest.h"
#include "shared/hash.h"

layout(scalar, set = 0, binding = 0) readonly buffer Frame { wd_frame_uniforms frame; };
layout(set = 0, binding = 5) uniform sampler2DArray looks;
layout(scalar, push_constant) uniform Push { wd_tree_push push; };

#include "lib/tree.glsl"

layout(location = 0) in vec3 in_normal;
layout(location = 1) in vec3 in_uv;
layout(location = 2) in vec4 in_tint;
layout(location = 3) flat in uvec3 in_flat;
layout(location = 4) flat in float in_show;

layout(location = 0) out vec4 out_albedo;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out uint out_surface;

void main()
{
    /* G7: leaf by leaf: whole triangles come and go. */
    float noise = wd_hash_unit(in_flat.z);
    if (noise >= in_show)
        discard;
    vec4 look = texture(looks, in_uv);
    if (look.a < WD_LOOK_CUT)
        discard;
    vec3 albedo = look.rgb * in_tint.rgb;
    if (frame.view_mode == WD_MODE_LOD)
        albedo = level_color(push.level) * (0.3 + 0.7 * in_tint.a);
    out_albedo = vec4(albedo, in_tint.a);
    out_normal = vec4(normalize(in_normal) * 0.5 + 0.5, float(in_flat.y) / 3.0);
    out_surface = in_flat.x;
}
