/* Triangles of wood into the visibility buffer, a thread a triangle, or of large ones a group. Expects SPLAT(pixel,
 * depth_bits, id) as lib/splat_draw.glsl does. */
#include "shared/continuum.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint ORTHOGRAPHIC = 0u;
layout(constant_id = 4) const uint RUNS = 1u;
/* What becomes of large triangles: they are drawn as all are, listed, or they are what is drawn. */
const uint LARGE_AS_ALL = 0u, LARGE_LISTED = 1u, LARGE_ALONE = 2u;
layout(constant_id = 6) const uint LARGE = LARGE_AS_ALL;

layout(scalar, set = 0, binding = 0) uniform View { wd_splat_view view_block; };
layout(scalar, set = 0, binding = 1) readonly buffer Counts { wd_splat_counts counts; };
layout(set = 0, binding = 2) uniform usamplerBuffer splat_trees; /* wd_splat_tree */
layout(set = 0, binding = 3) uniform usamplerBuffer items;       /* wd_splat_item */
layout(set = 0, binding = 4) uniform usamplerBuffer wood;        /* wd_splat_corner */
layout(set = 0, binding = 7, rg32ui) uniform readonly uimageBuffer drawn; /* the visibility buffer */

layout(scalar, set = 0, binding = 8) buffer Large {
    uint large_groups[3]; /* of an indirect dispatch: parts that are listed */
    uint large_wanted;    /* parts that were to be */
    wd_large_part large[];
};

/* Read before any branch: lib/light_pixels.glsl tells why. */
wd_splat_view view = view_block;

#include "lib/splat.glsl"
#include "lib/dealt.glsl"
#include "lib/drawn.glsl"
#include "lib/slice.glsl"

/* A triangle on screen: pixels whose middles may lie in it; of the first of these the shares of the corners, and what a
 * step right and down adds. Shares and depth are linear on screen. */
struct wd_bark {
    vec2 low, high;
    vec3 share, share_x, share_y, depths;
};

bool set_up(vec3 a, vec3 b, vec3 c, out wd_bark bark)
{
    vec2 size = vec2(view.width, view.height);
    bark.low = max(ceil(min(min(a.xy, b.xy), c.xy) - 0.5), vec2(0.0));
    bark.high = min(floor(max(max(a.xy, b.xy), c.xy) - 0.5), size - 1.0);
    vec2 u = b.xy - a.xy, v = c.xy - a.xy;
    float area = u.x * v.y - u.y * v.x;
    bark.share_x = vec3(0.0, v.y, -u.y) / area;
    bark.share_y = vec3(0.0, -v.x, u.x) / area;
    bark.share_x.x = -bark.share_x.y - bark.share_x.z;
    bark.share_y.x = -bark.share_y.y - bark.share_y.z;
    vec2 from = bark.low + 0.5 - a.xy;
    bark.share = vec3(1.0, 0.0, 0.0) + bark.share_x * from.x + bark.share_y * from.y + 1e-5;
    bark.depths = vec3(a.z, b.z, c.z);
    return bark.low.x <= bark.high.x && bark.low.y <= bark.high.y && area != 0.0;
}

void mark_bark(uint at, float depth, uint id)
{
    uint depth_bits = floatBitsToUint(ORTHOGRAPHIC != 0u ? min(depth, 1.0) : depth);
    if (may_show(at, depth_bits))
        SPLAT(at, depth_bits, id);
}

/* Row by row: from which column on, and up to which, all three shares are positive. */
void draw_rows(wd_bark bark, uint id)
{
    vec3 row = bark.share;
    vec3 inverse = -1.0 / mix(bark.share_x, vec3(1e-12), equal(bark.share_x, vec3(0.0)));
    bvec3 rises = greaterThan(bark.share_x, vec3(0.0));
    float last = bark.high.x - bark.low.x, y = bark.low.y;
    do {
        vec3 edges = row * inverse;
        vec3 begins = mix(vec3(0.0), edges, rises), ends = mix(edges, vec3(last), rises);
        float begin = max(ceil(max(max(begins.x, begins.y), begins.z)), 0.0);
        float end = min(floor(min(min(ends.x, ends.y), ends.z)), last);
        float depth = dot(row + bark.share_x * begin, bark.depths), step_x = dot(bark.share_x, bark.depths);
        uint at = uint(y) * view.width + uint(bark.low.x + begin);
        do { /* one turn where there is no pixel: lanes run in step */
            if (begin <= end)
                mark_bark(at, depth, id);
            depth += step_x;
            at++;
            begin += 1.0;
        } while (begin <= end);
        row += bark.share_y;
        y += 1.0;
    } while (y <= bark.high.y);
}

/* The same by all threads of a group, pixel by pixel: those of one part (WD_LARGE_PART_PX). */
void draw_together(wd_bark bark, uint part, uint id)
{
    uint width = uint(bark.high.x - bark.low.x) + 1u, height = uint(bark.high.y - bark.low.y) + 1u;
    uint i = part * WD_LARGE_PART_PX + gl_LocalInvocationID.x;
    uint end = min((part + 1u) * WD_LARGE_PART_PX, width * height);
    for (; i < end; i += gl_WorkGroupSize.x) {
        vec2 at = vec2(i % width, i / width);
        vec3 share = bark.share + bark.share_x * at.x + bark.share_y * at.y;
        if (min(min(share.x, share.y), share.z) >= 0.0)
            mark_bark(uint(bark.low.y + at.y) * view.width + uint(bark.low.x + at.x),
                      dot(share, bark.depths), id);
    }
}

/* False where nothing of it is to be drawn. */
bool bark_at(wd_splat_tree tree, uint index, out wd_bark bark)
{
    uvec3 corners = splat_wood_at(wood, tree.first_wood, index);
    vec3 at[3];
    vec2 low = vec2(1e9), high = vec2(-1e9);
    float nearest = 1e9;
    for (uint k = 0u; k < 3u; k++) {
        vec3 clip = splat_clip(tree, splat_place(splat_corner_at(wood, corners[k]).at));
        float w = ORTHOGRAPHIC != 0u ? 1.0 : clip.z;
        float depth = ORTHOGRAPHIC != 0u ? min(clip.z, 1.0) : view.near_m / w;
        at[k] = vec3((clip.xy / w * 0.5 + 0.5) * vec2(view.width, view.height), depth);
        nearest = min(nearest, clip.z);
        low = min(low, clip.xy);
        high = max(high, clip.xy);
    }
    bool shades = ORTHOGRAPHIC == 0u || may_shade(0.5 * (low + high), length(high - low));
    bool before = nearest > (ORTHOGRAPHIC != 0u ? 0.0 : view.near_m);
    return shades && before && set_up(at[0], at[1], at[2], bark);
}

/* Triangles that span more pixels than this are listed, in parts, for a group each: or one thread would work on when
 * all others are done. */
const float LARGE_PX = 64.0;

bool put_aside(wd_bark bark, uint id)
{
    vec2 size = bark.high - bark.low + 1.0;
    float span = size.x * size.y;
    if (span <= LARGE_PX)
        return false;
    uint parts = uint(ceil(span / float(WD_LARGE_PART_PX)));
    uint at = atomicAdd(large_wanted, parts); /* never falls: after one that does not fit none does */
    bool fits = at + parts <= WD_LARGE_MOST;
    if (fits)
        atomicMax(large_groups[0], at + parts);
    for (uint part = 0u; fits && part < parts; part++)
        large[at + part] = wd_large_part(id, part);
    return fits;
}

/* Groups share an item in the dispatch's third dimension. */
void draw_item(uint index)
{
    wd_splat_item item = splat_item_at(items, index);
    wd_splat_tree tree = splat_tree_at(splat_trees, item.tree);
    uint count = WD_ITEM_COUNT(item), from = WD_ITEM_FIRST(item), i = gl_LocalInvocationID.x + gl_WorkGroupSize.x * gl_WorkGroupID.z;
    wd_bark bark;
    if (i >= count)
        return;
    do {
        uint id = WD_ID_WOOD | (index * WD_ITEM_SPLATS + i + 1u);
        if (bark_at(tree, from + i, bark) && !(LARGE == LARGE_LISTED && put_aside(bark, id)))
            draw_rows(bark, id);
        i += gl_WorkGroupSize.x * gl_NumWorkGroups.z;
    } while (i < count);
}

void draw_large(wd_large_part part)
{
    uint at = (part.id & ~WD_ID_WOOD) - 1u;
    wd_splat_item item = splat_item_at(items, at / WD_ITEM_SPLATS);
    wd_splat_tree tree = splat_tree_at(splat_trees, item.tree);
    wd_bark bark;
    if (bark_at(tree, WD_ITEM_FIRST(item) + at % WD_ITEM_SPLATS, bark))
        draw_together(bark, part.part, part.id);
}

void main()
{
    uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    if (LARGE == LARGE_ALONE) {
        draw_large(large[group]);
        return;
    }
    uint groups = counts.wood_items - counts.done_wood;
    if (group < groups)
        draw_item(counts.done_wood + dealt(group, groups));
}
