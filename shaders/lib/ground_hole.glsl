/* Holes in the ground. Expects `view` (wd_terrain_view). */
#include "shared/grid.h"
layout(scalar, set = 0, binding = 6) readonly buffer Holes { uint holes[]; };

bool hole_at(uint index)
{
    return (holes[index >> 2] >> ((index & 3u) * 8u) & 0xffu) != 0u;
}

/* A triangle with a corner that is cut out is not drawn, whatever level draws the place. */
bool is_hole(vec2 local_m)
{
    vec2 at = vec2(wd_grid_along(local_m.x / view.cell_m, view.width),
                   wd_grid_along(local_m.y / view.cell_m, view.height));
    uvec2 cell = uvec2(wd_grid_cell(at.x, view.width), wd_grid_cell(at.y, view.height));
    vec2 share = at - vec2(cell);
    uint first = cell.y * view.width + cell.x;
    uint corner = share.x >= share.y ? first + 1u : first + view.width;
    return hole_at(first) || hole_at(corner) || hole_at(first + view.width + 1u);
}
