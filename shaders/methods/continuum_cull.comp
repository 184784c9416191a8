#version 460
/* Which clusters the view sees. */
#include "shared/frame.h"
#include "shared/continuum.h"

layout(local_size_x = 64) in;

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame_block; };
layout(scalar, set = 0, binding = 1) uniform View { wd_splat_view view_block; };
layout(scalar, set = 0, binding = 2) readonly buffer Clusters { wd_cluster clusters[]; };
layout(scalar, set = 0, binding = 3) buffer Counts { wd_splat_counts counts; };
layout(scalar, set = 0, binding = 4) writeonly buffer Visible { uint visible[]; };

layout(set = 0, binding = 5) uniform samplerBuffer pyramid;
layout(scalar, set = 0, binding = 6) readonly buffer Pages { uint pages[]; }; /* slots */
layout(scalar, set = 0, binding = 7) buffer PutOff { uint put_off[]; };

/* Read before any branch: lib/light_pixels.glsl tells why. */
wd_frame_uniforms frame = frame_block;
wd_splat_view view = view_block;

#define PYRAMID_TEXELS
#include "lib/frustum.glsl"
#include "lib/pyramid.glsl"
#include "lib/occlusion.glsl"
#include "lib/put_off.glsl"

void main()
{
    uint index = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * 64u
                 + gl_LocalInvocationID.x;
    if (index >= view.cluster_count + view.page_count * WD_CLUSTERS_A_PAGE)
        return;
    if (index >= view.cluster_count) {
        uint at = index - view.cluster_count;
        index = view.cluster_count + pages[at / WD_CLUSTERS_A_PAGE] * WD_CLUSTERS_A_PAGE
                + at % WD_CLUSTERS_A_PAGE;
    }
    if (clusters[index].count == 0u)
        return;
    vec3 low = rel_of_mm(ivec3(clusters[index].min_mm[0], clusters[index].min_mm[1],
                               clusters[index].min_mm[2]));
    vec3 high = rel_of_mm(ivec3(clusters[index].max_mm[0], clusters[index].max_mm[1],
                                clusters[index].max_mm[2]));
    if (box_is_outside(low, high))
        return;
    if (view.has_history != 0u && was_hidden(low, high)) {
        if (view.moved != 0u) {
            put_off_trees(2u * index, ~0u);
            put_off_trees(2u * index + 1u, ~0u);
        }
        return;
    }
    visible[atomicAdd(counts.clusters, 1u)] = index;
}
