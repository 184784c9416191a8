#version 460
/* How many workgroups the next stage needs, in two dimensions: one may be too short. */
#include "shared/continuum.h"

layout(local_size_x = 1) in;

layout(scalar, set = 0, binding = 0) readonly buffer View { wd_splat_view view; };
layout(scalar, set = 0, binding = 1) buffer Counts { wd_splat_counts counts; };
layout(scalar, set = 0, binding = 2) writeonly buffer Groups { wd_splat_groups groups; };

void main()
{
    uint clusters = counts.clusters, items = min(counts.items, view.item_capacity);
    uint wood_items = min(counts.wood_items, view.item_capacity);
    counts.items = items;
    counts.wood_items = wood_items;
    groups.wood[0] = min(wood_items, 32768u);
    groups.wood[1] = (wood_items + 32767u) / 32768u;
    groups.wood[2] = 1u;
    groups.select[0] = min(clusters, 32768u);
    groups.select[1] = (clusters + 32767u) / 32768u;
    groups.select[2] = 1u;
    groups.splat[0] = min(items, 32768u);
    groups.splat[1] = (items + 32767u) / 32768u;
    groups.splat[2] = 1u;
}
