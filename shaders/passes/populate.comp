#version 460
#extension GL_GOOGLE_include_directive : require
/* Plants pages of layers on demand: a workgroup a cluster, a thread a tree. */
#include "shared/page_layer.h"
#include "shared/continuum.h"

layout(local_size_x = 64) in;
layout(scalar, push_constant) uniform Push { wd_page_push push; };
layout(set = 0, binding = 0, scalar) readonly buffer Ground { wd_place_ground place_ground; };
layout(set = 0, binding = 1, scalar) readonly buffer Heights { float heights_m[]; };
layout(set = 0, binding = 2, scalar) readonly buffer Holes { uint holes[]; }; /* a byte a sample */
layout(set = 0, binding = 3, scalar) readonly buffer Maps { float probabilities[]; };
layout(set = 0, binding = 4, scalar) readonly buffer Tables { uint tables[]; };
layout(set = 0, binding = 5, scalar) readonly buffer Layers { wd_page_layer layers[]; };
layout(set = 0, binding = 6, scalar) readonly buffer Jobs { wd_page_job jobs[]; };
layout(set = 0, binding = 7, scalar) writeonly buffer Trees { wd_packed_tree trees[]; };
layout(set = 0, binding = 8, scalar) writeonly buffer Clusters { wd_cluster clusters[]; };

uint own_layer; /* of the workgroup's page */

#define WD_GROUND(member) place_ground.member
#define WD_LAYER(member) layers[own_layer].layer.member
#define WD_HEIGHT_AT(index) heights_m[index]
#define WD_HOLE_AT(index) (holes[(index) >> 2] >> (((index) & 3u) * 8u) & 0xffu)
#define WD_MAP_AT(index) probabilities[layers[own_layer].map_first + (index)]
#define WD_TABLE_AT(index) tables[layers[own_layer].table_first + (index)]
#include "shared/page.h"

shared int low_mm[3], high_mm[3];
shared uint planted;

/* With the reach of crowns that lean and sway, and of those that stand for a block. */
void add_bounds(wd_tree tree, uint level)
{
    int height_mm = int(WD_TREE_HEIGHT_CM(tree)) * 10;
    int around_mm = int(float(WD_TREE_CROWN_CM(tree)) * 7.5 * exp2(float(min(level, 12u))
                                                            + (level > 0u ? 1.0 : 0.0)));
    int reach_mm = around_mm + height_mm / 10 + 500;
    int below_mm = level > 0u ? 1000 + around_mm / 2 : 1000;
    atomicMin(low_mm[0], tree.x_mm - reach_mm);
    atomicMin(low_mm[1], tree.y_mm - reach_mm);
    atomicMin(low_mm[2], tree.z_mm - below_mm);
    atomicMax(high_mm[0], tree.x_mm + reach_mm);
    atomicMax(high_mm[1], tree.y_mm + reach_mm);
    atomicMax(high_mm[2], tree.z_mm + height_mm + height_mm / 10 + below_mm);
    atomicAdd(planted, 1u);
}

void main()
{
    uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    uint at = group / WD_PAGE_CLUSTERS, cluster = group % WD_PAGE_CLUSTERS;
    if (at >= push.job_count)
        return;
    wd_page_job job = jobs[at];
    own_layer = job.layer;
    uint thread = gl_LocalInvocationID.x;
    if (thread == 0u) {
        for (uint k = 0u; k < 3u; k++) {
            low_mm[k] = 0x7fffffff;
            high_mm[k] = -0x7fffffff;
        }
        planted = 0u;
    }
    barrier();
    uint index = cluster * WD_PAGE_CLUSTER + thread;
    wd_page_cell cell = wd_page_cell_of(wd_page(job.layer, job.level, job.column, job.row), index);
    wd_tree tree = wd_page_tree(layers[own_layer].first_id, cell);
    tree.look = WD_TREE_LOOK_OF_LAYER(tree.look, layers[own_layer].fade);
    uint record = push.first_tree + job.slot * WD_PAGE_TREES + index;
    trees[WD_PACKED_AT(record)] = wd_tree_pack(tree, job.block);
    if (index == 0u)
        trees[WD_PACKED_HEAD(record)] = wd_tree_block_record(job.block);
    if (tree.size != 0u)
        add_bounds(tree, job.level);
    barrier();
    if (thread != 0u)
        return;
    uint count = planted == 0u ? 0u
                               : WD_CLUSTER_OF_PAGE(planted, job.level, layers[own_layer].grain_cm);
    clusters[push.first_cluster + job.slot * WD_PAGE_CLUSTERS + cluster] =
        wd_cluster(low_mm, high_mm,
                   push.first_tree + job.slot * WD_PAGE_TREES + cluster * WD_PAGE_CLUSTER, count);
}
