#version 460
/* A thread finds the shafts of a tile: places on its pixels' ways, some in each slice, are looked up in the maps of
 * shadows (ray-marched volumetric shadows; Toth and Umenhoffer 2009, but for what is kept of them: slices of a tile,
 * as Wronski 2014 has them). */
#include "shared/frame.h"
#include "shared/light.h"

layout(local_size_x = WD_TILE_THREADS) in;

layout(constant_id = 0) const uint COMPARES = 0u; /* see lib/shadow.glsl */

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame_block; };
layout(set = 0, binding = 1) uniform sampler2DArrayShadow shadow_map;
layout(set = 0, binding = 2) uniform sampler2DArray shadow_depth;
layout(scalar, set = 0, binding = 3) writeonly buffer Shafts { float shafts[]; };
layout(scalar, push_constant) uniform Push { wd_light_push push_block; };

/* Read before any branch: lib/light_pixels.glsl tells why. */
wd_frame_uniforms frame = frame_block;
wd_light_push push = push_block;

#define SHADOW_DEPTH shadow_depth
#define SHADOW_COMPARES (COMPARES != 0u)

#include "lib/dither.glsl"
#include "lib/view.glsl"
#include "lib/shadow.glsl"
#include "shared/air.h"
#include "lib/shafts.glsl"

const uint PLACES = 4u; /* a slice */

void main()
{
    uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    uint tile = group * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
    if (tile >= push.tile_columns * push.tile_rows)
        return;
    uvec2 place = uvec2(tile % push.tile_columns, tile / push.tile_columns);
    vec2 within = fract(vec2(0.7548777, 0.5698403) * float(frame.sample_index) + dither(vec2(place)));
    float noise = fract(dither(vec2(place.yx)) + 0.618033989 * float(frame.sample_index));
    float from_m = 0.0, from_through = 1.0, lit = 0.0, all = 1e-9;
    uint slice = 0u;
    do {
        float seen = 0.0, end_m = 0.0, through = 1.0;
        for (uint i = 0u; i < PLACES; i++) {
            within = fract(within + vec2(0.7548777, 0.5698403));
            vec3 ray = pixel_ray(ivec2(place * WD_TILE + uvec2(within * float(WD_TILE))));
            float per_axis = length(ray), part = (float(i) + noise) / float(PLACES);
            end_m = slice_end_m(shafts_reach_m(1.0 / per_axis), slice);
            through = wd_fog_through(ray / per_axis, end_m).y;
            float axis_m = mix(from_m, end_m, part) / per_axis;
            seen += sun_in_air(ray * axis_m, axis_m, noise);
        }
        float weight = max(from_through - through, 0.0);
        lit += weight * seen * (1.0 / float(PLACES));
        all += weight;
        shafts[tile * WD_SHAFT_SLICES + slice] = lit / all;
        from_m = end_m;
        from_through = through;
    } while (++slice < WD_SHAFT_SLICES);
}
