#version 460
/* What of the sky reaches places about a tree's crown past its neighbours. A thread a place. */
#define ELLIPSOID beside
#include "lib/sky_left.glsl"

layout(local_size_x = 64) in;

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
