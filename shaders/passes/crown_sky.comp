#version 460
/* What of the sky reaches places about a tree's crown past its neighbours: crowns are ellipsoids of leaves, in which
 * light falls off with the way that it has come (Guerrero 2006, section 5). A thread a place. Beyond
 * the job's reach the canopy's field says what is left. The same whatever else is in the grid. */
#include "shared/crown_sky.h"
#include "shared/light.h"
#include "shared/sky_rings.h"

layout(local_size_x = 64) in;

layout(scalar, set = 0, binding = 0) readonly buffer Crowns { wd_sky_crown crowns[]; }; /* by cells of the grid */
layout(scalar, set = 0, binding = 1) readonly buffer Cells { uint first_of[]; };
layout(scalar, set = 0, binding = 2) readonly buffer Jobs { wd_crown_sky_job jobs[]; };
layout(set = 0, binding = 3) uniform sampler2DArray canopy_light;
layout(scalar, set = 0, binding = 4) writeonly buffer Table { uvec2 table[]; }; /* half texels */
layout(scalar, push_constant) uniform Push { wd_crown_sky_push push; };

#include "lib/canopy_above.glsl"

const uint RINGS = uint(WD_SKY_RINGS);
const float SINES[RINGS] = float[](WD_SKY_RING_SINES);
const float HIGH[RINGS] = float[](WD_SKY_RINGS_HIGH), LOW[RINGS] = float[](WD_SKY_RINGS_LOW);
const float TURNS[3] = float[](-0.12, 0.0, 0.12); /* of rings one after the other, in radians: rays at several bearings */

/* Four bearings of a ring, and the four across from these. */
struct ring_ways {
    vec4 east, north;
    float up;
};

ring_ways ways_of(uint ring)
{
    vec4 turns = WD_CROWN_SKY_BEARING(vec4(0.0, 1.0, 2.0, 3.0)) + TURNS[ring % 3u];
    float up = SINES[ring], level = sqrt(1.0 - up * up);
    return ring_ways(level * cos(turns), level * sin(turns), up);
}

/* Optical depth of a crown along each way. `from_m`: from its middle to the place. */
void add_crown(inout vec4 depth, inout vec4 across, wd_sky_crown crown, vec3 from_m, ring_ways ways)
{
    float per_r = 1.0 / crown.radius_m, per_h = 1.0 / crown.half_m;
    vec3 q = from_m * vec3(per_r, per_r, per_h);
    float level = 1.0 - ways.up * ways.up, qq = dot(q, q) - 1.0;
    float ss = level * per_r * per_r + ways.up * ways.up * per_h * per_h;
    vec4 along = (q.x * ways.east + q.y * ways.north) * per_r;
    float rise = q.z * ways.up * per_h;
    vec4 one = rise + along, other = rise - along;
    vec4 root = sqrt(max(one * one - ss * qq, vec4(0.0))), root_other = sqrt(max(other * other - ss * qq, vec4(0.0)));
    float per_way = crown.per_m / ss;
    depth += per_way * (max(root - one, vec4(0.0)) - max(-root - one, vec4(0.0)));
    across += per_way * (max(root_other - other, vec4(0.0)) - max(-root_other - other, vec4(0.0)));
}

void add_cells(inout vec4 depth, inout vec4 across, uint job, vec3 place_m, ring_ways ways, ivec2 low, ivec2 high)
{
    uint own = jobs[job].crown;
    float reach_m = jobs[job].reach_m;
    wd_sky_crown self = crowns[own];
    ivec3 foot_mm = ivec3(self.foot_mm[0], self.foot_mm[1], self.foot_mm[2]);
    for (int row = low.y; row <= high.y; row++) {
        uint first = first_of[uint(row) * push.columns + uint(low.x)];
        uint end = first_of[uint(row) * push.columns + uint(high.x) + 1u];
        for (uint i = first; i < end; i++) {
            wd_sky_crown crown = crowns[i];
            vec3 apart_m = vec3(ivec3(crown.foot_mm[0], crown.foot_mm[1], crown.foot_mm[2]) - foot_mm) * 0.001;
            bool near = dot(apart_m.xy, apart_m.xy) < reach_m * reach_m;
            apart_m.z += crown.middle_m;
            if (i == own || !near || place_m.z > apart_m.z + crown.half_m)
                continue;
            add_crown(depth, across, crown, place_m - apart_m, ways);
        }
    }
}

/* Share of light that comes to the place along a level direction, rising, past the canopy beyond the neighbours: by what
 * of the sky its floors have, whose light came, on average, through the whole layer with a sine of MEAN_RISE. */
const float MEAN_RISE = 0.67;

float past_canopy(uint job, uint bearing, vec3 from_m, vec2 toward, float rise)
{
    float slope = rise * inversesqrt(1.0 - rise * rise), depth = 0.0, way_m = jobs[job].reach_m;
    for (uint i = 0u; i < WD_CROWN_SKY_STEPS; i++) {
        float next_m = WD_CROWN_SKY_NEXT * way_m;
        float over_m = from_m.z - jobs[job].rise_m[bearing * WD_CROWN_SKY_STEPS + i];
        vec2 at = (from_m.xy + 0.5 * (way_m + next_m) * toward - push.canopy_from_m) * push.canopy_scale;
        vec4 sky = textureLod(canopy_light, vec3(at, 0.0), 0.0), layer = textureLod(canopy_light, vec3(at, 1.0), 0.0);
        vec2 layer_m = WD_CANOPY_MOST_M * layer.xy * layer.xy;
        float met = canopy_above(layer_m, over_m + way_m * slope) - canopy_above(layer_m, over_m + next_m * slope);
        depth -= met * log(max(dot(sky, 0.25 * sky), 1e-3));
        way_m = next_m;
    }
    return exp(-depth * (MEAN_RISE / rise));
}

/* `first`: bearing. */
vec4 past_canopy_along(uint job, uint first, vec3 from_m, ring_ways ways)
{
    float per_level = (first == 0u ? 1.0 : -1.0) * inversesqrt(1.0 - ways.up * ways.up);
    vec4 through;
    for (uint i = 0u; i < 4u; i++)
        through[i] = past_canopy(job, first + i, from_m, per_level * vec2(ways.east[i], ways.north[i]), ways.up);
    return through;
}

/* From eight bearings to quarters: those about east are the first of four and the last of the four across. */
vec4 quarters_of(vec4 one, vec4 other)
{
    return 0.5 * vec4(one.x + other.w, one.y + one.z, one.w + other.x, other.y + other.z);
}

/* Whether the ground rises over a ring, softly. */
vec4 past_ground(vec4 slopes, ring_ways ways)
{
    float slope = ways.up * inversesqrt(1.0 - ways.up * ways.up);
    return 1.0 - smoothstep(slope - 0.08, slope + 0.08, slopes);
}

void main()
{
    uint index = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    if (index >= push.job_count * WD_CROWN_SKY_PLACES)
        return;
    uint job = index / WD_CROWN_SKY_PLACES, place = index % WD_CROWN_SKY_PLACES;
    wd_sky_crown own = crowns[jobs[job].crown];
    float reach_m = jobs[job].reach_m;
    uvec3 at = uvec3(place, place / WD_CROWN_SKY_ACROSS, place / (WD_CROWN_SKY_ACROSS * WD_CROWN_SKY_ACROSS));
    at.xy %= WD_CROWN_SKY_ACROSS;
    float top_m = own.middle_m + own.half_m;
    vec2 aside_m = own.radius_m * (vec2(at.xy) * (2.0 / float(WD_CROWN_SKY_ACROSS - 1u)) - 1.0);
    vec3 place_m = vec3(aside_m, mix(WD_CROWN_SKY_LOW_M, top_m, float(at.z) * (1.0 / float(WD_CROWN_SKY_UP - 1u))));
    vec2 foot_m = vec2(own.foot_mm[0], own.foot_mm[1]) * 0.001;
    ivec2 first = ivec2(push.first_column, push.first_row), most = ivec2(push.columns, push.rows) - 1;
    ivec2 low = ivec2(floor((foot_m - reach_m) / WD_CROWN_SKY_CELL_M)) - first;
    ivec2 high = ivec2(floor((foot_m + reach_m) / WD_CROWN_SKY_CELL_M)) - first;
    vec4 high_sky = vec4(0.0), low_sky = vec4(0.0);
    for (uint ring = 0u; ring < RINGS; ring++) {
        ring_ways ways = ways_of(ring);
        vec4 depth = vec4(0.0), across = vec4(0.0);
        add_cells(depth, across, job, place_m, ways, clamp(low, ivec2(0), most), clamp(high, ivec2(0), most));
        vec4 one = exp(-depth) * past_ground(jobs[job].ground, ways);
        vec4 other = exp(-across) * past_ground(jobs[job].ground_across, ways);
        vec3 from_m = vec3(foot_m, 0.0) + place_m;
        one *= past_canopy_along(job, 0u, from_m, ways);
        other *= past_canopy_along(job, 4u, from_m, ways);
        high_sky += HIGH[ring] * quarters_of(one, other);
        low_sky += LOW[ring] * quarters_of(one, other);
    }
    uvec2 told = uvec2(packUnorm4x8(sqrt(high_sky)), packUnorm4x8(sqrt(low_sky)));
    const uint layer = WD_CROWN_SKY_ACROSS * WD_CROWN_SKY_ACROSS;
    uint texel = WD_CROWN_SKY_SETS + jobs[job].slot * WD_CROWN_SKY_TEXELS + place;
    if (at.z < WD_CROWN_SKY_UP - 1u)
        table[2u * texel] = told;
    if (at.z > 0u)
        table[2u * (texel - layer) + 1u] = told;
}
