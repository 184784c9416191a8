#version 460
/* What each triangle of a mesh shows in the mean, from either side: enough of those that are small in a
 * picture, and made once for all pictures. */
#include "shared/bake.h"
#include "shared/tree.h"

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer vertices;
layout(set = 0, binding = 1) uniform usamplerBuffer indices;
layout(scalar, set = 0, binding = 2) writeonly buffer Flats { wd_bake_flat flats[]; };
layout(set = 0, binding = 3) uniform sampler2DArray looks;
layout(scalar, push_constant) uniform Push { wd_bake_push push; };

#include "lib/bake_mesh.glsl"

/* The mean of a triangle's four quarters. Of each the part that a whole mip shows, the next finer one: a
 * leaf's coarser mips take in what lies beyond its outline, and between two mips both would be read. */
vec3 look_from(uvec3 corner, float side)
{
    bake_look look = bake_look_of(corner, side * 8.0);
    look.lod = floor(look.lod);
    return (bake_look_at(look, vec2(1.0, 1.0) / 6.0).rgb
            + bake_look_at(look, vec2(4.0, 1.0) / 6.0).rgb
            + bake_look_at(look, vec2(1.0, 4.0) / 6.0).rgb
            + bake_look_at(look, vec2(2.0, 2.0) / 6.0).rgb) * 0.25;
}

void main()
{
    uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    uint triangle = group * 64u + gl_LocalInvocationID.x;
    if (triangle >= push.triangle_count)
        return;
    triangle += push.first_triangle;
    uvec3 corner = bake_triangle(triangle);
    vec3 normal = normalize(bake_normal(corner.x) + bake_normal(corner.y) + bake_normal(corner.z)
                            + vec3(0.0, 0.0, 1e-6));
    vec4 tint = (bake_tint(corner.x) + bake_tint(corner.y) + bake_tint(corner.z)) / 3.0;
    vec3 before = look_from(corner, 1.0) * tint.rgb, behind = look_from(corner, -1.0) * tint.rgb;
    flats[triangle] =
        wd_bake_flat(packHalf2x16(before.rg), packHalf2x16(behind.rg),
                     packHalf2x16(vec2(before.b, behind.b)),
                     packUnorm4x8(vec4(normal * 0.5 + 0.5, tint.a)));
}
