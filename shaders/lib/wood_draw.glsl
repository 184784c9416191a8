/* Triangles of wood into the visibility buffer, a thread a triangle. Expects SPLAT(pixel,
 * depth_bits, id) as lib/splat_draw.glsl does. */
#include "shared/continuum.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint ORTHOGRAPHIC = 0u;
layout(constant_id = 4) const uint RUNS = 1u;

layout(scalar, set = 0, binding = 0) uniform View { wd_splat_view view_block; };
layout(scalar, set = 0, binding = 1) readonly buffer Counts { wd_splat_counts counts; };
layout(set = 0, binding = 2) uniform usamplerBuffer splat_trees; /* wd_splat_tree */
layout(set = 0, binding = 3) uniform usamplerBuffer items;       /* wd_splat_item */
layout(set = 0, binding = 4) uniform usamplerBuffer wood;        /* wd_splat_corner */
layout(set = 0, binding = 7, rg32ui) uniform readonly uimageBuffer drawn; /* the visibility buffer */

/* Read before any branch: lib/light_pixels.glsl tells why. */
wd_splat_view view = view_block;

#include "lib/splat.glsl"
#include "lib/dealt.glsl"
#include "lib/drawn.glsl"
#include "lib/slice.glsl"

/* Pixels whose middles lie in the triangle, row by row: from which column on, and up to which, all
 * three shares are positive. Shares and depth are linear on screen. */
void draw_triangle(vec3 a, vec3 b, vec3 c, uint id)
{
    vec2 size = vec2(view.width, view.height);
    vec2 low = max(ceil(min(min(a.xy, b.xy), c.xy) - 0.5), vec2(0.0));
    vec2 high = min(floor(max(max(a.xy, b.xy), c.xy) - 0.5), size - 1.0);
    vec2 u = b.xy - a.xy, v = c.xy - a.xy;
    float area = u.x * v.y - u.y * v.x;
    if (low.x > high.x || low.y > high.y || area == 0.0)
        return;
    vec3 share_x = vec3(0.0, v.y, -u.y) / area, share_y = vec3(0.0, -v.x, u.x) / area;
    share_x.x = -share_x.y - share_x.z;
    share_y.x = -share_y.y - share_y.z;
    vec2 from = low + 0.5 - a.xy;
    vec3 row = vec3(1.0, 0.0, 0.0) + share_x * from.x + share_y * from.y + 1e-5;
    vec3 depths = vec3(a.z, b.z, c.z);
    vec3 inverse = -1.0 / mix(share_x, vec3(1e-12), equal(share_x, vec3(0.0)));
    bvec3 rises = greaterThan(share_x, vec3(0.0));
    float last = high.x - low.x, y = low.y;
    do {
        vec3 edges = row * inverse;
        vec3 begins = mix(vec3(0.0), edges, rises), ends = mix(edges, vec3(last), rises);
        float begin = max(ceil(max(max(begins.x, begins.y), begins.z)), 0.0);
        float end = min(floor(min(min(ends.x, ends.y), ends.z)), last);
        float depth = dot(row + share_x * begin, depths), step_x = dot(share_x, depths);
        uint at = uint(y) * view.width + uint(low.x + begin);
        do { /* one turn where there is no pixel: lanes run in step */
            if (begin <= end && may_show(at, floatBitsToUint(depth)))
                SPLAT(at, floatBitsToUint(depth), id);
            depth += step_x;
            at++;
            begin += 1.0;
        } while (begin <= end);
        row += share_y;
        y += 1.0;
    } while (y <= high.y);
}

void main()
{
    uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    uint groups = counts.wood_items - counts.done_wood;
    if (group >= groups)
        return;
    group = counts.done_wood + dealt(group, groups);
    wd_splat_item item = splat_item_at(items, group);
    wd_splat_tree tree = splat_tree_at(splat_trees, item.tree);
    uint count = WD_ITEM_COUNT(item), from = WD_ITEM_FIRST(item);
    vec2 size = vec2(view.width, view.height);
    uint i = gl_LocalInvocationID.x;
    if (i >= count)
        return;
    do {
        uvec3 corners = splat_wood_at(wood, tree.first_wood, from + i);
        vec3 at[3];
        vec2 low = vec2(1e9), high = vec2(-1e9);
        float nearest = 1e9;
        for (uint k = 0u; k < 3u; k++) {
            vec3 clip = splat_clip(tree, splat_place(splat_corner_at(wood, corners[k]).at));
            float w = ORTHOGRAPHIC != 0u ? 1.0 : clip.z;
            float depth = ORTHOGRAPHIC != 0u ? clip.z : view.near_m / w;
            at[k] = vec3((clip.xy / w * 0.5 + 0.5) * size, depth);
            nearest = min(nearest, clip.z);
            low = min(low, clip.xy);
            high = max(high, clip.xy);
        }
        bool shades = ORTHOGRAPHIC == 0u || may_shade(0.5 * (low + high), length(high - low));
        if (shades && nearest > (ORTHOGRAPHIC != 0u ? 0.0 : view.near_m))
            draw_triangle(at[0], at[1], at[2], WD_ID_WOOD | (group * WD_ITEM_SPLATS + i + 1u));
        i += gl_WorkGroupSize.x;
    } while (i < count);
}
