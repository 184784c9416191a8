/* A mesh's triangles in the frame of a picture. Its buffers are fetched from as texels: llvmpipe reads
 * storage buffers lane by lane. Expects `vertices`, `indices`, `looks` and `push`. */
#include "lib/tree_vertex.glsl"

const int VERTEX_WORDS = 7; /* of a wd_tree_vertex */

uvec3 bake_triangle(uint triangle)
{
    int at = 3 * int(triangle);
    return uvec3(texelFetch(indices, at).x, texelFetch(indices, at + 1).x,
                 texelFetch(indices, at + 2).x);
}

vec3 bake_position(uint vertex)
{
    int at = VERTEX_WORDS * int(vertex);
    return uintBitsToFloat(uvec3(texelFetch(vertices, at).x, texelFetch(vertices, at + 1).x,
                                 texelFetch(vertices, at + 2).x));
}

vec3 bake_normal(uint vertex)
{
    uint packed = texelFetch(vertices, VERTEX_WORDS * int(vertex) + 3).x;
    return octahedral_decode(unpackSnorm2x16(packed));
}

vec2 bake_uv(uint vertex)
{
    return unpackHalf2x16(texelFetch(vertices, VERTEX_WORDS * int(vertex) + 4).x);
}

vec4 bake_tint(uint vertex)
{
    return unpackUnorm4x8(texelFetch(vertices, VERTEX_WORDS * int(vertex) + 5).x);
}

uint bake_kind(uint vertex)
{
    return texelFetch(vertices, VERTEX_WORDS * int(vertex) + 6).x;
}

/* Both passes must find the same depth to the bit. */
vec3 bake_project(wd_bake_shot shot, vec3 p)
{
    precise vec3 at = vec3(shot.x.x * p.x + shot.x.y * p.y + shot.x.z * p.z + shot.x.w,
                           shot.y.x * p.x + shot.y.y * p.y + shot.y.z * p.z + shot.y.w,
                           shot.depth.x * p.x + shot.depth.y * p.y + shot.depth.z * p.z
                               + shot.depth.w);
    return at;
}

/* Twice the samples that a triangle has, below 0 seen from behind. */
float bake_area(vec3 a, vec3 b, vec3 c)
{
    precise vec2 ab = b.xy - a.xy, ac = c.xy - a.xy;
    precise float area = ab.x * ac.y - ab.y * ac.x;
    return area;
}

/* Shares of b and c in a place of the triangle a, b, c: a's is the rest. `area` is that of
 * bake_area and not 0. */
vec2 bake_shares(vec3 a, vec3 b, vec3 c, float area, vec2 place)
{
    precise vec2 ab = b.xy - a.xy, ac = c.xy - a.xy, ap = place - a.xy;
    precise vec2 shares = vec2(ap.x * ac.y - ap.y * ac.x, ab.x * ap.y - ab.y * ap.x) / area;
    return shares;
}

/* The look of a triangle, from its corners b and c as seen from a. */
struct bake_look {
    vec2 from, to_b, to_c;
    float layer, lod;
};

bake_look bake_look_of(uvec3 corner, float area)
{
    bake_look look;
    look.from = bake_uv(corner.x);
    look.to_b = bake_uv(corner.y) - look.from;
    look.to_c = bake_uv(corner.z) - look.from;
    float turn = look.to_b.x * look.to_c.y - look.to_b.y * look.to_c.x;
    uint layer = wd_vertex_layer(bake_kind(corner.x));
    /* y runs down: a sheet whose texture runs as it was drawn shows its upper side */
    if (layer == WD_LOOK_LEAF && turn * area > 0.0)
        layer = WD_LOOK_LEAF_BACK;
    look.layer = float(push.look_layer + layer);
    vec2 size = vec2(textureSize(looks, 0).xy);
    float texels = abs(turn) * size.x * size.y;
    look.lod = 0.5 * log2(max(texels / abs(area), 1.0));
    return look;
}

vec4 bake_look_at(bake_look look, vec2 shares)
{
    vec2 uv = look.from + shares.x * look.to_b + shares.y * look.to_c;
    return textureLod(looks, vec3(uv, look.layer), look.lod);
}
