/* What of the sky reaches a place past the crowns beside it: these are ellipsoids of leaves, in which light falls off with
 * the way that it has come (Guerrero 2006, section 5). Beyond a job's reach the canopy's field says what is left. The same
 * whatever else is in the grid. */
#include "shared/crown_sky.h"
#include "shared/light.h"
#include "shared/sky_rings.h"

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
const float LEVEL[RINGS] = float[](WD_SKY_RINGS_LEVEL);
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
    float per_way = crown.per_m * exp(crown.steeper * (ways.up - WD_SHADE_SINE)) / ss;
    depth += per_way * (max(root - one, vec4(0.0)) - max(-root - one, vec4(0.0)));
    across += per_way * (max(root_other - other, vec4(0.0)) - max(-root_other - other, vec4(0.0)));
}

ivec3 foot_of(uint job)
{
    return ivec3(jobs[job].foot_mm[0], jobs[job].foot_mm[1], jobs[job].foot_mm[2]);
}

/* Of crowns whose stems are in reach of a place over the foot. */
void add_cells(inout vec4 depth, inout vec4 across, uint job, vec3 place_m, vec2 about_m, ring_ways ways, ivec2 low, ivec2 high)
{
    uint own = jobs[job].crown;
    float reach_m = jobs[job].reach_m;
    ivec3 foot_mm = foot_of(job);
    for (int row = low.y; row <= high.y; row++) {
        uint first = first_of[uint(row) * push.columns + uint(low.x)];
        uint end = first_of[uint(row) * push.columns + uint(high.x) + 1u];
        for (uint i = first; i < end; i++) {
            wd_sky_crown crown = crowns[i];
            vec3 apart_m = vec3(ivec3(crown.foot_mm[0], crown.foot_mm[1], crown.foot_mm[2]) - foot_mm) * 0.001;
            vec2 aside_m = apart_m.xy - about_m;
            bool near = dot(aside_m, aside_m) < reach_m * reach_m;
            apart_m.z += crown.middle_m;
            if (i == own || !near || place_m.z > apart_m.z + crown.half_m)
                continue;
            add_crown(depth, across, crown, place_m - apart_m, ways);
        }
    }
}

/* Share of light that comes in along four ways, from the bearing `first` on, past what lies beyond the job's reach. */
vec4 past_reach(uint job, uint first, vec3 from_m, ring_ways ways);

/* From eight bearings to quarters: those about east are the first of four and the last of the four across. */
vec4 quarters_of(vec4 one, vec4 other)
{
    return 0.5 * vec4(one.x + other.w, one.y + one.z, one.w + other.x, other.y + other.z);
}

/* Shares of an upright face's light from the quarters, from above 30 degrees and from below, and of level ground's. */
struct sky_left {
    vec4 high, low, level;
};

/* At a place over the job's foot; neighbours are in reach of `about_m`, aside from the foot. */
sky_left sky_left_to(uint job, vec3 place_m, vec2 about_m)
{
    vec2 foot_m = vec2(foot_of(job).xy) * 0.001;
    float reach_m = jobs[job].reach_m;
    ivec2 first = ivec2(push.first_column, push.first_row), most = ivec2(push.columns, push.rows) - 1;
    ivec2 low = ivec2(floor((foot_m + about_m - reach_m) / WD_CROWN_SKY_CELL_M)) - first;
    ivec2 high = ivec2(floor((foot_m + about_m + reach_m) / WD_CROWN_SKY_CELL_M)) - first;
    sky_left left = sky_left(vec4(0.0), vec4(0.0), vec4(0.0));
    for (uint ring = 0u; ring < RINGS; ring++) {
        ring_ways ways = ways_of(ring);
        vec4 depth = vec4(0.0), across = vec4(0.0);
        add_cells(depth, across, job, place_m, about_m, ways, clamp(low, ivec2(0), most), clamp(high, ivec2(0), most));
        vec3 from_m = vec3(foot_m, 0.0) + place_m;
        vec4 one = exp(-depth) * past_reach(job, 0u, from_m, ways), other = exp(-across) * past_reach(job, 4u, from_m, ways);
        vec4 quarters = quarters_of(one, other);
        left.high += HIGH[ring] * quarters;
        left.low += LOW[ring] * quarters;
        left.level += LEVEL[ring] * quarters;
    }
    return left;
}
