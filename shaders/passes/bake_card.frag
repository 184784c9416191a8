#version 460
#include "shared/forest.h"

layout(set = 0, binding = 1) uniform sampler2DArray looks;

layout(location = 0) in vec3 in_normal;
layout(location = 1) in vec2 in_uv;
layout(location = 2) in vec4 in_tint;
layout(location = 3) flat in uvec2 in_kind;

layout(location = 0) out vec4 out_albedo;
layout(location = 1) out vec4 out_normal;

void main()
{
    vec4 look = texture(looks, vec3(in_uv, float(in_kind.x)));
    if (look.a < WD_LOOK_CUT)
        discard;
    /* Cards are lit as the crown's outside; wood within, seen through gaps, has little of that. */
    float inside = in_kind.y != 0u ? 1.0 : clamp(1.6 * in_tint.a, 0.15, 1.0);
    out_albedo = vec4(look.rgb * in_tint.rgb * inside, 1.0);
    out_normal = vec4(normalize(in_normal) * 0.5 + 0.5, in_tint.a);
}
