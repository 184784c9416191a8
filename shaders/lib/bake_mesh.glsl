/* A mesh's triangles in the frame of a picture. Expects `vertices`, `indices`, `shots` and `push`. */
#include "lib/tree_vertex.glsl"


/* Both passes must find the same depth to the bit. */
vec3 bake_project(wd_bake_shot shot, vec3 p)
{
    precise vec3 at = vec3(shot.x.x * p.x + shot.x.y * p.y + shot.x.z * p.z + shot.x.w,
                           shot.y.x * p.x + shot.y.y * p.y + shot.y.z * p.z + shot.y.w,
                           shot.depth.x * p.x + shot.depth.y * p.y + shot.depth.z * p.z
                               + shot.depth.w);
    return at;
}

/* Shares of b and c in a place of the triangle a, b, c: a's is the rest. `area` is that of
 * bake_area and not 0. */
vec2 bake_shares(vec3 a, vec3 b, vec3 c, float area, vec2 place)
{
    precise vec2 ab = b.xy - a.xy, ac = c.xy - a.xy, ap = place - a.xy;
    precise vec2 shares = vec2(ap.x * ac.y - ap.y * ac.x, ab.x * ap.y - ab.y * ap.x) / area;
    return shares;
}

float bake_area(vec3 a, vec3 b, vec3 c)
{
    precise vec2 ab = b.xy - a.xy, ac = c.xy - a.xy;
    precise float area = ab.x * ac.y - ab.y * ac.x;
    return area;
}

uvec3 bake_triangle(uint triangle)
{
    uint at = push.first_index + 3u * triangle;
    return uvec3(indices[at], indices[at + 1u], indices[at + 2u]);
}
