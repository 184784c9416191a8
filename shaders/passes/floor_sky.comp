#version 460
/* What of the sky crowns leave the ground about the eye (shared/crown_sky.h): a group a tile, a thread a square. */
#include "lib/sky_left.glsl"

layout(local_size_x = WD_FLOOR_SKY_TILE, local_size_y = WD_FLOOR_SKY_TILE) in;

layout(scalar, set = 0, binding = 5) readonly buffer Rises { float square_rise_m[]; }; /* over their tile's foot */

/* Quarters of the bearings: those about east are the first and the last. */
const int QUARTERS[8] = int[](0, 1, 1, 2, 2, 3, 3, 0);
const float LOW_SINE = 0.5; /* of ways that the field knows as low */

/* What the canopy's field says of the ground there, stems and hills included; of steep ways, of the leaves above them. */
vec4 past_reach(uint job, uint first, vec3 from_m, ring_ways ways)
{
    float across = (first == 0u ? 1.0 : -1.0) * inversesqrt(1.0 - ways.up * ways.up), reach_m = jobs[job].reach_m;
    float over_m = reach_m * ways.up * abs(across);
    bool low = ways.up < LOW_SINE;
    vec4 through;
    for (uint i = 0u; i < 4u; i++) {
        vec2 at = from_m.xy + reach_m * across * vec2(ways.east[i], ways.north[i]);
        at = (at - push.canopy_from_m) * push.canopy_scale;
        vec2 root_m = textureLod(canopy_light, vec3(at, 1.0), 0.0).xy;
        float left = textureLod(canopy_light, vec3(at, low ? 3.0 : 2.0), 0.0)[QUARTERS[first + i]];
        float above = low ? 1.0 : canopy_above(WD_CANOPY_MOST_M * root_m * root_m, over_m);
        through[i] = pow(max(left * left, 1e-3), above);
    }
    return through;
}

/* Within stands the field tells of more than crowns, as the floors of path-traced stands have it: as far as less than half
 * of the sky comes down to the ground that lies so far off on eight sides. */
const float STAND_M = 24.0;
const vec2 OPEN = vec2(0.25, 0.5);

float within_stand(vec2 place_m)
{
    float sum = 0.0;
    for (uint i = 0u; i < 8u; i++) {
        float bearing = WD_CROWN_SKY_BEARING(float(i));
        vec2 at = place_m + STAND_M * vec2(cos(bearing), sin(bearing));
        vec4 root = textureLod(canopy_light, vec3((at - push.canopy_from_m) * push.canopy_scale, 0.0), 0.0);
        sum += dot(root, 0.25 * root);
    }
    return 1.0 - smoothstep(OPEN.x, OPEN.y, sum * (1.0 / 8.0));
}

/* The two stems in reach that hide most of the square's middle's sky. */
uvec2 stems_about(uint job, vec2 aside_m)
{
    uvec2 first_two = uvec2(0u);
    vec2 most_wide = vec2(0.0), middle_m = vec2(foot_of(job).xy) * 0.001 + aside_m;
    ivec2 first = ivec2(push.first_column, push.first_row), most = ivec2(push.columns, push.rows) - 1;
    ivec2 low = clamp(ivec2(floor((middle_m - WD_STEM_FAR_M) / WD_CROWN_SKY_CELL_M)) - first, ivec2(0), most);
    ivec2 high = clamp(ivec2(floor((middle_m + WD_STEM_FAR_M) / WD_CROWN_SKY_CELL_M)) - first, ivec2(0), most);
    for (int row = low.y; row <= high.y; row++) {
        uint end = first_of[uint(row) * push.columns + uint(high.x) + 1u];
        for (uint i = first_of[uint(row) * push.columns + uint(low.x)]; i < end; i++) {
            wd_sky_crown crown = crowns[i];
            vec2 apart_m = vec2(ivec2(crown.foot_mm[0], crown.foot_mm[1]) - foot_of(job).xy) * 0.001 - aside_m;
            float away_m = length(apart_m);
            float wide = crown.stem_radius_m / max(away_m, max(crown.stem_radius_m, 1e-3));
            if (away_m >= WD_STEM_FAR_M || wide <= most_wide.y)
                continue;
            uint packed = wd_stem_pack(apart_m.x, apart_m.y, crown.stem_radius_m);
            bool widest = wide > most_wide.x;
            first_two = widest ? uvec2(packed, first_two.x) : uvec2(first_two.x, packed);
            most_wide = widest ? vec2(wide, most_wide.x) : vec2(most_wide.x, wide);
        }
    }
    return first_two;
}

void main()
{
    uint tile = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    if (tile >= push.tile_count)
        return;
    uint job = push.job_count + tile;
    ivec2 square = ivec2(gl_LocalInvocationID.xy) - WD_FLOOR_SKY_TILE / 2; /* from the tile's middle */
    vec2 aside_m = WD_FLOOR_SKY_M * (vec2(square) + 0.5);
    float rise_m = square_rise_m[tile * WD_FLOOR_SKY_TILE * WD_FLOOR_SKY_TILE + gl_LocalInvocationIndex];
    float over_m = rise_m + WD_FLOOR_SKY_OVER_M;
    sky_left left = sky_left_to(job, vec3(aside_m, over_m), aside_m);
    vec2 place_m = vec2(foot_of(job).xy) * 0.001 + aside_m;
    vec2 on_field = (place_m - push.canopy_from_m) * push.canopy_scale;
    vec4 level = textureLod(canopy_light, vec3(on_field, 0.0), 0.0);
    vec4 low = textureLod(canopy_light, vec3(on_field, 3.0), 0.0);
    float stand = within_stand(place_m);
    level = mix(sqrt(left.level), level, stand);
    low = mix(sqrt(left.low), low, stand);
    ivec2 at = ivec2(round(vec2(foot_of(job).xy) * (0.001 / WD_FLOOR_SKY_M))) + square;
    uint texel = 2u * wd_floor_sky_texel(at.x, at.y);
    table[texel] = uvec2(packUnorm4x8(level), packUnorm4x8(low));
    table[texel + 1u] = stems_about(job, aside_m);
}
