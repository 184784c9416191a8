#version 460
/* Texels of baked pictures from the samples in them: what shared/view_set.h says. */
#include "shared/bake.h"
#include "shared/tree.h"

layout(local_size_x = 64) in;

layout(scalar, set = 0, binding = 0) readonly buffer Vertices { wd_tree_vertex vertices[]; };
layout(scalar, set = 0, binding = 1) readonly buffer Indices { uint indices[]; };
layout(scalar, set = 0, binding = 2) readonly buffer Shots { wd_bake_shot shots[]; };
layout(scalar, set = 0, binding = 3) readonly buffer Samples { wd_bake_sample samples[]; };
layout(scalar, set = 0, binding = 4) writeonly buffer Texels { uint texels[]; };
layout(set = 0, binding = 5) uniform sampler2DArray looks;
layout(scalar, push_constant) uniform Push { wd_bake_push push; };

#include "lib/bake_mesh.glsl"

/* Sums over the samples of a texel. */
struct bake_sum {
    vec3 color, normal;
    float openness, front, back, sheets, leaf, count;
};

/* What a triangle shows at a place of a picture. */
void add_surface(inout bake_sum sum, wd_bake_shot shot, uint triangle, vec2 place)
{
    uvec3 corner = bake_triangle(triangle);
    wd_tree_vertex u = vertices[corner.x], v = vertices[corner.y], w = vertices[corner.z];
    vec3 a = bake_project(shot, u.position_m), b = bake_project(shot, v.position_m);
    vec3 c = bake_project(shot, w.position_m);
    float area = bake_area(a, b, c);
    vec2 bc = bake_shares(a, b, c, area, place);
    vec3 share = vec3(1.0 - bc.x - bc.y, bc);
    vec3 normal = share.x * tree_vertex_normal(u) + share.y * tree_vertex_normal(v)
                  + share.z * tree_vertex_normal(w);
    vec4 tint = share.x * unpackUnorm4x8(u.tint) + share.y * unpackUnorm4x8(v.tint)
                + share.z * unpackUnorm4x8(w.tint);
    bool leaf = triangle >= push.wood_triangles;
    sum.color += bake_look_at(bake_look_of(u, v, w, area), bc).rgb * tint.rgb;
    sum.normal += normalize(normal + vec3(0.0, 0.0, 1e-6));
    sum.openness += tint.a;
    sum.leaf += leaf ? 1.0 : 0.0;
}

vec3 srgb_encode(vec3 linear)
{
    vec3 low = 12.92 * linear, high = 1.055 * pow(max(linear, vec3(1e-6)), vec3(1.0 / 2.4)) - 0.055;
    return mix(high, low, lessThanEqual(linear, vec3(0.0031308)));
}

void main()
{
    uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    uint texel = group * 64u + gl_LocalInvocationID.x, picture = push.width * push.height;
    if (texel >= picture * push.shot_count)
        return;
    uint shot_index = texel / picture, within = texel % picture, s = push.samples;
    uvec2 corner = uvec2(within % push.width, within / push.width) * s;
    wd_bake_shot shot = shots[shot_index];
    bake_sum sum = bake_sum(vec3(0.0), vec3(0.0), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for (uint i = 0u; i < s * s; i++) {
        uvec2 place = corner + uvec2(i % s, i / s);
        wd_bake_sample seen =
            samples[(shot_index * push.height * s + place.y) * push.width * s + place.x];
        if (seen.triangle == 0u)
            continue;
        sum.front += uintBitsToFloat(seen.front);
        sum.back += seen.back != 0u ? uintBitsToFloat(~seen.back) : 0.0;
        sum.sheets += float(seen.sheets);
        sum.count += 1.0;
        add_surface(sum, shot, seen.triangle - 1u, vec2(place) + 0.5);
    }
    float per = 1.0 / max(sum.count, 1.0);
    uint at = shot_index * picture * 3u + within;
    bool empty = sum.count == 0.0;
    vec4 albedo = vec4(srgb_encode(sum.color * per), sum.count / float(s * s));
    vec4 normal = vec4(sum.normal * per * 0.5 + 0.5, sum.openness * per);
    vec4 depth = vec4(sum.front, sum.back, 0.0, sum.leaf) * per;
    depth.z = 1.0 - exp(-0.25 * sum.sheets * per);
    texels[at] = empty ? 0u : packUnorm4x8(albedo);
    texels[at + picture] = empty ? 0u : packUnorm4x8(normal);
    texels[at + 2u * picture] = empty ? 0u : packUnorm4x8(depth);
}
