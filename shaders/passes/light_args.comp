#version 460
/* How many workgroups each list of tiles needs, in two dimensions: one may be too short. */
#include "shared/light.h"

layout(local_size_x = WD_TILE_LISTS) in;

layout(scalar, set = 0, binding = 0) buffer Tiles { wd_tile_lists lists; };

void main()
{
    uint list = gl_LocalInvocationIndex, count = lists.count[list];
    lists.groups[list].x = min(count, 32768u);
    lists.groups[list].y = (count + 32767u) / 32768u;
    lists.groups[list].z = 1u;
}
