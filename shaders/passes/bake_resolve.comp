#version 460
/* Texels of a baked picture from the samples in them: what shared/view_set.h says; and sums of what its leaves show. */
#include "shared/bake.h"
#include "shared/tree.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint DEPTHS = 0u;

layout(set = 0, binding = 0) uniform usamplerBuffer vertices;
layout(set = 0, binding = 1) uniform usamplerBuffer indices;
layout(set = 0, binding = 2) uniform usamplerBuffer samples; /* wd_bake_sample */
layout(set = 0, binding = 3) uniform usamplerBuffer rays;    /* wd_bake_ray */
layout(set = 0, binding = 4) uniform usamplerBuffer flats;   /* wd_bake_flat */
layout(set = 0, binding = 5) uniform sampler2DArray looks;
layout(scalar, set = 0, binding = 6) buffer Texels { uint texels[]; };
layout(scalar, push_constant) uniform Push { wd_bake_push push; };

#include "lib/bake_mesh.glsl"

/* Sums over the samples of a texel. */
struct bake_sum {
    vec3 color;
    vec4 around; /* normal * 0.5 + 0.5, sky openness */
    vec4 leaves; /* colour and openness of leaves alone */
    float front, back, sheets, leaf, count;
};

bool shows_leaf(uint seen)
{
    return seen >> 2 > push.wood_triangles;
}

void add_shown(inout bake_sum sum, vec3 color, vec4 around, bool leaf)
{
    sum.color += color;
    sum.around += around;
    sum.leaves += leaf ? vec4(color, around.a) : vec4(0.0);
}

/* What a small triangle shows; nothing of others, whose words may be anything. */
void add_flat(inout bake_sum sum, uint seen)
{
    uvec4 words = texelFetch(flats, max(int(seen >> 2) - 1, 0));
    words = WD_BAKE_IS_FLAT(seen) ? words : uvec4(0u);
    bool turned = WD_BAKE_IS_TURNED(seen);
    vec2 blues = unpackHalf2x16(words.z);
    vec3 color = vec3(unpackHalf2x16(turned ? words.y : words.x), turned ? blues.y : blues.x);
    add_shown(sum, color, unpackUnorm4x8(words.w), shows_leaf(seen));
}

/* What a triangle shows at a place of the picture. */
void add_surface(inout bake_sum sum, uint triangle, vec2 place)
{
    uvec3 corner = bake_triangle(triangle);
    vec3 a = bake_project(push.shot, bake_position(corner.x));
    vec3 b = bake_project(push.shot, bake_position(corner.y));
    vec3 c = bake_project(push.shot, bake_position(corner.z));
    float area = bake_area(a, b, c);
    vec2 bc = bake_shares(a, b, c, area, place);
    vec3 share = vec3(1.0 - bc.x - bc.y, bc);
    vec3 normal = share.x * bake_normal(corner.x) + share.y * bake_normal(corner.y)
                  + share.z * bake_normal(corner.z);
    vec4 tint = share.x * bake_tint(corner.x) + share.y * bake_tint(corner.y)
                + share.z * bake_tint(corner.z);
    vec3 color = bake_look_at(bake_look_of(corner, area), bc).rgb * tint.rgb;
    vec4 around = vec4(normalize(normal + vec3(0.0, 0.0, 1e-6)) * 0.5 + 0.5, tint.a);
    add_shown(sum, color, around, triangle >= push.wood_triangles);
}

/* Those of a sample that the texel sees at all, but for what a large triangle shows: returns 1 there. */
uint add_sample(inout bake_sum sum, int at)
{
    uint seen = texelFetch(samples, at).x;
    add_flat(sum, seen);
    sum.leaf += shows_leaf(seen) ? 1.0 : 0.0;
    sum.count += seen != 0u ? 1.0 : 0.0;
    if (DEPTHS != 0u) {
        uvec2 ray = texelFetch(rays, at).xy;
        sum.front += uintBitsToFloat(texelFetch(samples, at).y);
        sum.back += seen != 0u ? uintBitsToFloat(~ray.x) : 0.0;
        sum.sheets += float(ray.y);
    }
    return seen != 0u && !WD_BAKE_IS_FLAT(seen) ? 1u : 0u;
}

vec3 srgb_encode(vec3 linear)
{
    vec3 low = 12.92 * linear, high = 1.055 * pow(max(linear, vec3(1e-6)), vec3(1.0 / 2.4)) - 0.055;
    return mix(high, low, lessThanEqual(linear, vec3(0.0031308)));
}

void write_texel(bake_sum sum, uint within)
{
    uint picture = push.width * push.height, s = push.samples;
    uint at = push.shot_index * picture * 3u + within;
    float per = 1.0 / max(sum.count, 1.0);
    bool empty = sum.count == 0.0;
    vec4 albedo = vec4(srgb_encode(sum.color * per), sum.count / float(s * s));
    vec4 depth = vec4(sum.front, sum.back, 0.0, sum.leaf) * per;
    depth.z = 1.0 - exp(-0.25 * sum.sheets * per);
    texels[at] = empty ? 0u : packUnorm4x8(albedo);
    texels[at + picture] = empty ? 0u : packUnorm4x8(sum.around * per);
    texels[at + 2u * picture] = empty ? 0u : packUnorm4x8(depth);
    uvec4 leaves = uvec4(sum.leaves * (WD_BAKE_LEAF_STEPS / float(s * s)) + 0.5);
    for (uint k = 0u; k < 4u && sum.leaf > 0.0; k++)
        atomicAdd(texels[push.leaf_sums + 4u * push.shot_index + k], leaves[k]);
}

void main()
{
    uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    uint within = group * 64u + gl_LocalInvocationID.x, s = push.samples;
    if (within >= push.width * push.height)
        return;
    uvec2 corner = uvec2(within % push.width, within / push.width) * s;
    int stride = int(push.width * s);
    int first = int((push.shot_index * push.height * s + corner.y) * push.width * s + corner.x);
    bake_sum sum = bake_sum(vec3(0.0), vec4(0.0), vec4(0.0), 0.0, 0.0, 0.0, 0.0, 0.0);
    uvec2 large = uvec2(0u); /* bits of the samples that show large triangles */
    for (uint y = 0u, i = 0u; y < s; y++)
        for (uint x = 0u; x < s; x++, i++) {
            uint bit = add_sample(sum, first + int(y) * stride + int(x)) << (i & 31u);
            large |= i < 32u ? uvec2(bit, 0u) : uvec2(0u, bit);
        }
    while ((large.x | large.y) != 0u) {
        int i = large.x != 0u ? findLSB(large.x) : 32 + findLSB(large.y);
        large = large.x != 0u ? uvec2(large.x & (large.x - 1u), large.y)
                              : uvec2(0u, large.y & (large.y - 1u));
        ivec2 place = ivec2(i % int(s), i / int(s));
        uint seen = texelFetch(samples, first + place.y * stride + place.x).x;
        add_surface(sum, WD_BAKE_TRIANGLE(seen), vec2(corner) + vec2(place) + 0.5);
    }
    write_texel(sum, within);
}
