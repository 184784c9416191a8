#version 460
/* Sorts the picture's tiles by what their pixels show into one list a pipeline of the light pass.
 * The order within a list may vary; the picture does not depend on it. A thread a tile: barriers and
 * shared atomics for each pixel cost software devices four times as much. */
#include "shared/frame.h"
#include "shared/light.h"

layout(local_size_x = WD_TILE_THREADS) in;

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame_block; };
layout(set = 0, binding = 1) uniform usampler2D gbuffer_surface;
layout(set = 0, binding = 2) uniform sampler2D gbuffer_depth;
layout(scalar, set = 0, binding = 3) buffer Tiles { wd_tile_lists lists; uint tiles[]; };
layout(scalar, push_constant) uniform Push { wd_light_push push_block; };

/* Read before any branch: lib/light_pixels.glsl tells why. */
wd_frame_uniforms frame = frame_block;
wd_light_push push = push_block;

#include "lib/view.glsl"

uint pixel_parts(ivec2 at)
{
    float depth = texelFetch(gbuffer_depth, at, 0).x;
    uint surface = texelFetch(gbuffer_surface, at, 0).x;
    vec3 ray = pixel_ray(at);
    uint found = pixel_is_sky(depth) ? WD_PART_SKY
                 : surface == 0u     ? WD_PART_GROUND
                                     : WD_PART_GROUND | WD_PART_TREES;
    float water_m = water_distance(ray); /* in units of the ray: along the view axis */
    if (water_m > 0.0 && water_m * depth < frame.near_m)
        found |= WD_PART_WATER;
    if (push.has_rivers != 0u && !pixel_is_sky(depth))
        found |= WD_PART_WATER;
    return found;
}

void main()
{
    uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    uint tile = group * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
    if (tile >= push.tile_columns * push.tile_rows)
        return;
    uvec2 place = uvec2(tile % push.tile_columns, tile / push.tile_columns);
    ivec2 corner = ivec2(place) * WD_TILE;
    ivec2 last = min(corner + WD_TILE, ivec2(frame.width, frame.height)) - 1;
    uint parts = 0u;
    ivec2 at = corner;
    do {
        parts |= pixel_parts(at);
        at = at.x < last.x ? ivec2(at.x + 1, at.y) : ivec2(corner.x, at.y + 1);
    } while (at.y <= last.y);
    uint list = max(wd_tile_list_of(parts), push.few_tiles != 0u ? WD_TILE_LIST_DRY : 0u);
    uint slot = atomicAdd(lists.count[list], 1u);
    tiles[list * push.tile_columns * push.tile_rows + slot] = place.y << 16 | place.x;
}
