#version 460
/* What of the sky reaches places about a tree's crown past its neighbours. A thread a place. */
#include "lib/sky_left.glsl"

layout(local_size_x = 64) in;

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

/* Whether the ground rises over a ring, softly. */
vec4 past_ground(vec4 slopes, ring_ways ways)
{
    float slope = ways.up * inversesqrt(1.0 - ways.up * ways.up);
    return 1.0 - smoothstep(slope - 0.08, slope + 0.08, slopes);
}

vec4 past_reach(uint job, uint first, vec3 from_m, ring_ways ways)
{
    float per_level = (first == 0u ? 1.0 : -1.0) * inversesqrt(1.0 - ways.up * ways.up);
    vec4 through;
    for (uint i = 0u; i < 4u; i++)
        through[i] = past_canopy(job, first + i, from_m, per_level * vec2(ways.east[i], ways.north[i]), ways.up);
    return through * (first == 0u ? past_ground(jobs[job].ground, ways) : past_ground(jobs[job].ground_across, ways));
}

void main()
{
    uint index = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    if (index >= push.job_count * WD_CROWN_SKY_PLACES)
        return;
    uint job = index / WD_CROWN_SKY_PLACES, place = index % WD_CROWN_SKY_PLACES;
    float radius_m = jobs[job].radius_m, top_m = jobs[job].top_m;
    uvec3 at = uvec3(place, place / WD_CROWN_SKY_ACROSS, place / (WD_CROWN_SKY_ACROSS * WD_CROWN_SKY_ACROSS));
    at.xy %= WD_CROWN_SKY_ACROSS;
    vec2 aside_m = radius_m * (vec2(at.xy) * (2.0 / float(WD_CROWN_SKY_ACROSS - 1u)) - 1.0);
    vec3 place_m = vec3(aside_m, mix(WD_CROWN_SKY_LOW_M, top_m, float(at.z) * (1.0 / float(WD_CROWN_SKY_UP - 1u))));
    sky_left left = sky_left_to(job, place_m, vec2(0.0));
    uvec2 told = uvec2(packUnorm4x8(sqrt(left.high)), packUnorm4x8(sqrt(left.low)));
    const uint layer = WD_CROWN_SKY_ACROSS * WD_CROWN_SKY_ACROSS;
    uint texel = WD_CROWN_SKY_SETS + jobs[job].slot * WD_CROWN_SKY_TEXELS + place;
    if (at.z < WD_CROWN_SKY_UP - 1u)
        table[2u * texel] = told;
    if (at.z > 0u)
        table[2u * (texel - layer) + 1u] = told;
}
