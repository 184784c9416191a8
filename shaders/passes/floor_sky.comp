#version 460
/* What of the sky crowns leave the ground about the eye (shared/crown_sky.h): a group a tile, a thread a square. */
#define ELLIPSOID below
#include "lib/sky_left.glsl"

layout(local_size_x = WD_FLOOR_SKY_TILE, local_size_y = WD_FLOOR_SKY_TILE) in;

layout(scalar, set = 0, binding = 5) readonly buffer Rises { float rise_m[]; }; /* of squares over their tile's foot */

void main()
{
    uint tile = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    if (tile >= push.tile_count)
        return;
    uint job = push.job_count + tile;
    ivec2 square = ivec2(gl_LocalInvocationID.xy) - WD_FLOOR_SKY_TILE / 2; /* from the tile's middle */
    vec2 aside_m = WD_FLOOR_SKY_M * (vec2(square) + 0.5);
    float over_m = rise_m[tile * WD_FLOOR_SKY_TILE * WD_FLOOR_SKY_TILE + gl_LocalInvocationIndex] + WD_FLOOR_SKY_OVER_M;
    sky_left left = sky_left_to(job, vec3(aside_m, over_m), aside_m);
    ivec2 at = ivec2(round(vec2(foot_of(job).xy) * (0.001 / WD_FLOOR_SKY_M))) + square;
    table[2u * wd_floor_sky_texel(at.x, at.y)] = uvec2(packUnorm4x8(sqrt(left.level)), packUnorm4x8(sqrt(left.low)));
}
