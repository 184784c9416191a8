#version 460
/* How many workgroups the next stage needs, in two dimensions: one may be too short. AGAIN begins the
 * second round: what has been put off is chosen from, and the rest is done. */
#include "shared/continuum.h"

layout(local_size_x = 1) in;

layout(constant_id = 0) const uint THREADS = 64u; /* of a splat's group */
layout(constant_id = 1) const uint AGAIN = 0u;
layout(constant_id = 2) const uint LANES = 1u; /* threads of a small item */
layout(constant_id = 3) const uint PARTS = 1u; /* groups of an item of wood */

layout(scalar, set = 0, binding = 0) uniform View { wd_splat_view view; };
layout(scalar, set = 0, binding = 1) buffer Counts { wd_splat_counts counts; };
layout(scalar, set = 0, binding = 2) writeonly buffer Groups { wd_splat_groups groups; };
layout(scalar, set = 0, binding = 3) buffer Lost { wd_splat_lost lost; };
layout(scalar, set = 0, binding = 4) writeonly buffer Large { uint large_groups[3], large_wanted; };

uint[3] groups_of(uint count)
{
    return uint[3](min(count, 32768u), (count + 32767u) / 32768u, 1u);
}

uint above(uint count, uint capacity)
{
    return count - min(count, capacity);
}

void keep_to_capacity()
{
    uint items = above(counts.items + counts.small_items, view.item_capacity)
                 + above(counts.wood_items, view.item_capacity);
    lost.trees = max(lost.trees, above(counts.trees, view.tree_capacity));
    lost.items = max(lost.items, items);
    counts.trees = min(counts.trees, view.tree_capacity);
    counts.items = min(counts.items, view.item_capacity);
    counts.small_items = min(counts.small_items, view.item_capacity - counts.items);
    counts.wood_items = min(counts.wood_items, view.item_capacity);
}

void main()
{
    keep_to_capacity();
    if (AGAIN != 0u) {
        counts.done_items = counts.items;
        counts.done_small = counts.small_items;
        counts.done_wood = counts.wood_items;
    }
    groups.select = groups_of(AGAIN != 0u ? counts.put_off : counts.clusters);
    uint each = THREADS / LANES, large = counts.items - counts.done_items;
    uint small = (counts.small_items - counts.done_small + each - 1u) / each;
    groups.splat = groups_of(large);
    groups.small = groups_of(small);
    groups.all_splats = groups_of(large + small);
    groups.sort = groups_of((counts.small_items - counts.done_small + WD_SORT_ITEMS - 1u) / WD_SORT_ITEMS);
    groups.wood = groups_of(counts.wood_items - counts.done_wood);
    groups.wood[2] = PARTS;
    large_groups = uint[3](0u, 1u, 1u);
    large_wanted = 0u;
}
