/* The ground at a place that is seen. Expects `frame`, `view` (wd_terrain_view), IS_NEAR, and what is bound. */
layout(set = 0, binding = 4) uniform sampler2D slopes;
layout(set = 0, binding = 5) uniform sampler2D cover_map; /* x: of the place, y: about it, z: a
                                                            quarter of the sward's layers */
layout(scalar, set = 0, binding = 7) readonly buffer Waters { float water_m[]; };

#define WATER_AT(index) water_m[index]
#include "lib/river.glsl"
#define WD_STREWN_SHOWN (IS_NEAR != 0u)
#include "shared/ground_cover.h"

vec3 curtain_normal(int side)
{
    return side == WD_EDGE_SOUTH  ? vec3(0.0, -1.0, 0.0)
           : side == WD_EDGE_EAST ? vec3(1.0, 0.0, 0.0)
           : side == WD_EDGE_NORTH ? vec3(0.0, 1.0, 0.0)
                                   : vec3(-1.0, 0.0, 0.0);
}

/* Size of the pixel's sample on the ground: a mean of its length away from the eye and its width. Taken from
 * distance and slope, as differences between pixels are wrong where triangles end. */
float footprint_of(vec3 rel, float distance_m, vec2 slope)
{
    vec3 normal = normalize(vec3(-slope, 1.0));
    float facing = abs(dot(normal, rel)) / distance_m;
    return distance_m * view.sample_rad / sqrt(max(facing, 0.02));
}

/* Share of the sky's light that a sward leaves to the ground that is seen between its blades; where it
 * is too far off to be drawn, the ground stands for all of it. */
float sward_open(float layers, float distance_m)
{
    return exp(-0.35 * layers * (1.0 - wd_sward_gone(distance_m)));
}

/* `side`: of the curtain that is seen, WD_EDGE_* */
wd_ground_look ground_look(vec3 rel, int side)
{
    vec2 local_m = rel.xy + view.camera_m;
    float distance_m = length(rel);
    float level = log2(distance_m * view.pixel_rad * 1.5);
    vec2 slope = textureLod(slopes, local_m * view.slopes_scale + view.slopes_offset,
                            level - log2(view.slopes_texel_m)).xy;
    vec3 cover = textureLod(cover_map, local_m * view.cover_scale,
                            level - log2(view.cover_texel_m)).xyz;
    float river_m = water_m.length() > 1 ? river_level(local_m) : WD_NO_WATER_M;
    wd_ground_look look = wd_ground_cover(rel, slope.x, slope.y, cover.x, cover.y, 4.0 * cover.z, river_m,
                                          footprint_of(rel, distance_m, slope));
    look.openness *= sward_open(4.0 * cover.z, distance_m);
    if (side != WD_EDGE_NONE) {
        look.albedo = frame.soil * (0.75 + 0.25 * cos(rel.z * 1.3));
        look.normal = curtain_normal(side);
        look.openness = 1.0;
    }
    return look;
}
