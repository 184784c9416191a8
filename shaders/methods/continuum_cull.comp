#version 460
/* Which clusters the view sees. */
#include "shared/frame.h"
#include "shared/continuum.h"

layout(local_size_x = 64) in;

layout(scalar, set = 0, binding = 0) readonly buffer Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 1) readonly buffer View { wd_splat_view view; };
layout(scalar, set = 0, binding = 2) readonly buffer Clusters { wd_cluster clusters[]; };
layout(scalar, set = 0, binding = 3) buffer Counts { wd_splat_counts counts; };
layout(scalar, set = 0, binding = 4) writeonly buffer Visible { uint visible[]; };

#include "lib/frustum.glsl"

void main()
{
    uint index = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * 64u
                 + gl_LocalInvocationID.x;
    if (index >= view.cluster_count)
        return;
    vec3 low = rel_of_mm(ivec3(clusters[index].min_mm[0], clusters[index].min_mm[1],
                               clusters[index].min_mm[2]));
    vec3 high = rel_of_mm(ivec3(clusters[index].max_mm[0], clusters[index].max_mm[1],
                                clusters[index].max_mm[2]));
    if (box_is_outside(low, high))
        return;
    visible[atomicAdd(counts.clusters, 1u)] = index;
}
