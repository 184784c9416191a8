/* Splats into the visibility buffer. A pixel holds the greatest of depth above id: the nearest
 * splat, and of those at the same depth the one with the greatest id, in whatever order they come.
 * Expects SPLAT(pixel, depth_bits, id). */
#include "shared/continuum.h"
#include "shared/sun_ways.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint ORTHOGRAPHIC = 0u;
/* Whose items are drawn: large trees', an item a group's work, small ones', that of LANES threads, or both. */
const uint OF_LARGE = 0u, OF_SMALL = 1u, OF_BOTH = 2u;
layout(constant_id = 3) const uint ITEMS = OF_LARGE;
layout(constant_id = 4) const uint RUNS = 1u;
layout(constant_id = 5) const uint LANES = 1u; /* threads of a small item */

layout(scalar, set = 0, binding = 0) uniform View { wd_splat_view view_block; };
layout(scalar, set = 0, binding = 1) readonly buffer Counts { wd_splat_counts counts; };
layout(set = 0, binding = 2) uniform usamplerBuffer splat_trees; /* wd_splat_tree */
layout(set = 0, binding = 3) uniform usamplerBuffer items;       /* wd_splat_item */
layout(set = 0, binding = 4) uniform usamplerBuffer splats;      /* wd_splat */
layout(set = 0, binding = 6) uniform usamplerBuffer lit;         /* ways that are open, of each */
layout(set = 0, binding = 7, rg32ui) uniform readonly uimageBuffer drawn; /* the visibility buffer */

/* Read before any branch: lib/light_pixels.glsl tells why. */
wd_splat_view view = view_block;

#include "lib/splat.glsl"
#include "lib/dealt.glsl"
#include "lib/drawn.glsl"
#include "lib/slice.glsl"

bool small = ITEMS == OF_SMALL;

/* What a splat covers: pixels whose middles lie within `reach` of its middle each way and, of a leaf, in
 * its outline. */
struct wd_outline {
    vec2 reach; /* in pixels */
    vec2 along; /* of a leaf or twig: its length's direction, over half its length; else 0 */
    float width; /* of that: over its length */
};

/* From this radius on, in pixels, a splat has a leaf's outline, or a twig's. */
const float LEAF_PX = 1.0, TWIG_PX = 0.1;
/* Largest width over length. */
const float LEAF_WIDTH = 0.5, TWIG_WIDTH = 0.03;

/* A square as large as the disc: small ones look alike, and one loop of few steps costs half of what rows
 * of a disc cost where lanes run in step. */
wd_outline disc_outline(float radius)
{
    return wd_outline(vec2(radius * 0.886227), vec2(0.0), LEAF_WIDTH);
}

/* A leaf's outline of the disc's area: pointed at both ends, width falling with the square of the
 * distance from the middle. */
wd_outline leaf_outline(float radius, vec2 along, float width)
{
    float long_px = radius * sqrt(0.375 * 3.14159265 / width);
    along *= inversesqrt(max(dot(along, along), 1e-12));
    vec2 tip = abs(along), side = width * tip.yx; /* where the outline reaches farthest is between */
    vec2 bulge = side + tip * tip / max(4.0 * side, 1e-6);
    return wd_outline(long_px * mix(tip, bulge, lessThan(tip, 2.0 * side)), along / long_px, width);
}

bool outline_holds(wd_outline outline, vec2 from)
{
    float u = dot(from, outline.along);
    float v = outline.along.x * from.y - outline.along.y * from.x;
    return abs(v) <= outline.width * (1.0 - u * u);
}

/* Whether splats may have a leaf's outline. */
bool has_leaves()
{
    return ORTHOGRAPHIC == 0u && !small;
}

/* Asked at its end, the loop spares software devices a last turn with all lanes off. */
void draw_outline(vec2 center, wd_outline outline, uint depth_bits, uint id)
{
    ivec2 low = max(ivec2(ceil(center - outline.reach - 0.5)), ivec2(0));
    ivec2 high = min(ivec2(floor(center + outline.reach - 0.5)),
                     ivec2(view.width, view.height) - 1);
    ivec2 size = high - low + 1;
    if (size.x <= 0 || size.y <= 0)
        return;
    vec2 first = vec2(low) + 0.5 - center, from = first;
    uint at = uint(low.y) * view.width + uint(low.x), column = 0u;
    int left = size.x * size.y;
    do {
        bool holds = !has_leaves() || outline_holds(outline, from);
        if (holds && may_show(at, depth_bits))
            SPLAT(at, depth_bits, id);
        at++;
        from.x += 1.0;
        if (++column == uint(size.x)) {
            column = 0u;
            from = vec2(first.x, from.y + 1.0);
            at += view.width - uint(size.x);
        }
    } while (--left > 0);
}

/* On screen, of any length. */
vec2 leaf_along(wd_splat_tree tree, vec3 along, vec3 clip)
{
    vec2 moved = vec2(dot(tree.clip_x.xyz, along), dot(tree.clip_y.xyz, along));
    return (moved * clip.z - clip.xy * dot(tree.clip_w.xyz, along)) * vec2(view.width, view.height);
}

/* The tree's splat number `at`. */
void draw_splat(wd_splat_tree tree, uint at, uint id)
{
    uvec2 turn = splat_turn(tree, at);
    uint at_disc = splat_index(tree, turn);
    wd_splat disc = splat_at(splats, at_disc);
    vec3 clip = splat_clip(tree, splat_place(disc));
    float w = ORTHOGRAPHIC != 0u ? 1.0 : clip.z;
    uint random = disc.xy * 0x9e3779b9u;
    uint way = wd_sun_way_by_lot(tree.eye, random >> 8);
    float seen = wd_sun_way_lit(texelFetch(lit, int(at_disc)).x, way);
    float depth = ORTHOGRAPHIC != 0u ? min(clip.z, 1.0)
                                     : view.near_m / max(w - tree.nearer_m * seen, view.near_m);
    if (w < view.near_m || depth <= 0.0 || (ORTHOGRAPHIC != 0u && !may_shade(clip.xy, 0.0)))
        return;
    float inverse = 1.0 / w;
    bool twig = WD_TREE_TWIGS(tree), wood = turn.x == WD_LEAF_STRATA || twig;
    vec3 normal = splat_normal(disc);
    float facing = dot(normal, tree.facing) * inversesqrt(dot(normal, normal));
    float open = wd_disc_open(seen, WD_TREE_CLOSE(tree));
    float share = (wood ? max(facing, 0.0) : 2.0 * max(facing * WD_TREE_UPPER(tree), -facing)) * open;
    float radius = (wood ? tree.wood_radius : tree.radius) * inverse * sqrt(share);
    vec2 center = (clip.xy * inverse * 0.5 + 0.5) * vec2(view.width, view.height);
    wd_outline outline = disc_outline(radius);
    if (has_leaves() && (twig || !wood) && radius > (twig ? TWIG_PX : LEAF_PX))
        outline = leaf_outline(radius, leaf_along(tree, splat_along(disc), clip), twig ? TWIG_WIDTH : LEAF_WIDTH);
    uint depth_bits = floatBitsToUint(depth);
    if (ORTHOGRAPHIC == 0u) /* lib/splat_depth.glsl asks that of it */
        depth_bits = depth_bits & ~1u | uint(seen);
    draw_outline(center, outline, depth_bits, id);
}

void main()
{
    uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    if (ITEMS == OF_BOTH) {
        small = group >= counts.items - counts.done_items;
        group -= small ? counts.items - counts.done_items : 0u;
    }
    uint done = small ? counts.done_small : counts.done_items;
    uint end = small ? counts.small_items : counts.items;
    uint each = small ? gl_WorkGroupSize.x / LANES : 1u, groups = (end - done + each - 1u) / each;
    if (group >= groups)
        return;
    uint index = done + dealt(group, groups) * each;
    uint first = gl_LocalInvocationID.x, step_size = gl_WorkGroupSize.x;
    if (small) {
        index += first / LANES;
        first %= LANES;
        step_size = LANES;
    }
    if (index >= end)
        return;
    if (small)
        index = view.item_capacity - 1u - index;
    wd_splat_item item = splat_item_at(items, index);
    wd_splat_tree tree = splat_tree_at(splat_trees, item.tree);
    uint count = WD_ITEM_COUNT(item), from = WD_ITEM_FIRST(item);
    if (first >= count)
        return;
    uint i = first;
    do {
        draw_splat(tree, from + i, index * WD_ITEM_SPLATS + i + 1u);
        i += step_size;
    } while (i < count);
}
