/* Splats into the visibility buffer. A pixel holds the greatest of depth above id: the nearest
 * splat, and of those at the same depth the one with the greatest id, in whatever order they come.
 * Expects SPLAT(pixel, depth_bits, id). */
#include "shared/continuum.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint ORTHOGRAPHIC = 0u;

layout(scalar, set = 0, binding = 0) readonly buffer View { wd_splat_view view; };
layout(scalar, set = 0, binding = 1) readonly buffer Counts { wd_splat_counts counts; };
layout(scalar, set = 0, binding = 2) readonly buffer SplatTrees { wd_splat_tree splat_trees[]; };
layout(scalar, set = 0, binding = 3) readonly buffer Items { wd_splat_item items[]; };
layout(scalar, set = 0, binding = 4) readonly buffer Splats { wd_splat splats[]; };

#include "lib/splat.glsl"

void draw_disc(vec2 center, float radius, uint depth_bits, uint id)
{
    int low = max(int(ceil(center.y - radius - 0.5)), 0);
    int high = min(int(floor(center.y + radius - 0.5)), int(view.height) - 1);
    for (int y = low; y <= high; y++) {
        float dy = float(y) + 0.5 - center.y;
        float half_width = sqrt(max(radius * radius - dy * dy, 0.0));
        int begin = max(int(ceil(center.x - half_width - 0.5)), 0);
        int end = min(int(floor(center.x + half_width - 0.5)), int(view.width) - 1);
        for (int x = begin; x <= end; x++)
            SPLAT(uint(y) * view.width + uint(x), depth_bits, id);
    }
}

void main()
{
    uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    if (group >= counts.items)
        return;
    wd_splat_item item = items[group];
    wd_splat_tree tree = splat_trees[item.tree];
    vec2 size = vec2(view.width, view.height);
    for (uint i = gl_LocalInvocationID.x; i < item.count; i += gl_WorkGroupSize.x) {
        wd_splat splat = splats[splat_index(tree, item.first + i)];
        vec3 p = splat_place(splat);
        vec3 clip = vec3(dot(tree.clip_x.xyz, p) + tree.clip_x.w,
                         dot(tree.clip_y.xyz, p) + tree.clip_y.w,
                         dot(tree.clip_w.xyz, p) + tree.clip_w.w) + tree.sway * (p.z * p.z);
        float w = ORTHOGRAPHIC != 0u ? 1.0 : clip.z;
        if (w < view.near_m)
            continue;
        float inverse = 1.0 / w;
        float depth = ORTHOGRAPHIC != 0u ? clip.z : view.near_m * inverse;
        if (depth <= 0.0)
            continue;
        vec3 normal = splat_normal(splat);
        float facing = dot(normal, tree.toward) * inversesqrt(dot(normal, normal));
        bool wood = (splat.z_normal & WD_SPLAT_Z_WOOD) != 0u;
        float radius = (wood ? tree.wood_radius : tree.radius) * inverse
                       * sqrt(wood ? max(facing, 0.0) : abs(facing));
        vec2 at = (clip.xy * inverse * 0.5 + 0.5) * size;
        draw_disc(at, radius, floatBitsToUint(depth), group * WD_ITEM_SPLATS + i + 1u);
    }
}
