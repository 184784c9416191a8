#version 460
/* Small trees' items by their counts: threads of the splat pass that draw eight or more of them side by side
 * end together. A workgroup sorts a block of the list, so that neighbours stay near each other. */
#include "shared/continuum.h"

layout(local_size_x_id = 0) in;

layout(scalar, set = 0, binding = 0) uniform View { wd_splat_view view; };
layout(scalar, set = 0, binding = 1) readonly buffer Counts { wd_splat_counts counts; };
layout(scalar, set = 0, binding = 2) buffer Items { wd_splat_item items[]; };

shared uint firsts[WD_SMALL_SPLATS + 1u]; /* by count: how many there are, then where the next one goes */
shared uint block[WD_SORT_ITEMS];         /* count in WD_SORT_BITS under the tree */

uint place_of(uint at)
{
    return view.item_capacity - 1u - at;
}

/* Of all shorter counts. */
void sum_up()
{
    uint sum = 0u;
    for (uint count = 0u; count <= WD_SMALL_SPLATS; count++) {
        uint own = firsts[count];
        firsts[count] = sum;
        sum += own;
    }
}

void main()
{
    uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    uint begin = counts.done_small + group * WD_SORT_ITEMS, lane = gl_LocalInvocationID.x;
    if (begin >= counts.small_items)
        return;
    uint count = min(counts.small_items - begin, WD_SORT_ITEMS);
    for (uint k = lane; k <= WD_SMALL_SPLATS; k += gl_WorkGroupSize.x)
        firsts[k] = 0u;
    barrier();
    for (uint i = lane; i < count; i += gl_WorkGroupSize.x) {
        wd_splat_item item = items[place_of(begin + i)];
        block[i] = item.tree << WD_SORT_BITS | WD_ITEM_COUNT(item);
        atomicAdd(firsts[WD_ITEM_COUNT(item)], 1u);
    }
    barrier();
    if (lane == 0u)
        sum_up();
    barrier();
    for (uint i = lane; i < count; i += gl_WorkGroupSize.x) {
        uint tree = block[i] >> WD_SORT_BITS, splats = block[i] & ((1u << WD_SORT_BITS) - 1u);
        items[place_of(begin + atomicAdd(firsts[splats], 1u))] = wd_splat_item(tree, splats);
    }
}
