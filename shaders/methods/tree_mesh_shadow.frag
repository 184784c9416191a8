#version 460
#include "shared/forest.h"
#include "shared/hash.h"

layout(set = 0, binding = 5) uniform sampler2DArray looks;

layout(location = 1) in vec3 in_uv;
layout(location = 3) flat in uvec3 in_flat;
layout(location = 4) flat in vec4 in_sun_show;

void main()
{
    float alpha = texture(looks, in_uv).a;
    if (wd_hash_unit(in_flat.z) >= in_sun_show.a || alpha < WD_LOOK_CUT)
        discard;
}
