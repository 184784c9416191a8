/* Radiance of the pixels of some tiles. One pipeline for each combination of parts that tiles have
 * (light_tiles.comp), so that a tile of sky does not pay for trees. Expects FRAME_BLOCK: the kind of block
 * that the frame is read from. With WET tiles hold pixels with and without water: one kind is shaded, that of
 * PARTS; the other after or before. */
#include "shared/frame.h"
#include "shared/forest.h"
#include "shared/light.h"

layout(local_size_x = WD_TILE, local_size_y_id = 4) in; /* rows at once; a thread takes every so manieth */

layout(constant_id = 0) const uint PARTS = WD_PART_ALL;
layout(constant_id = 1) const uint LIST = 0;
layout(constant_id = 2) const uint RUNS = 1u;
layout(constant_id = 3) const uint SINGLE = 0u; /* 1: all leaves are single ones */
layout(constant_id = 5) const uint COMPARES = 0u; /* see lib/shadow.glsl */

layout(scalar, set = 0, binding = 0) FRAME_BLOCK Frame { wd_frame_uniforms frame_block; };
layout(set = 0, binding = 1) uniform sampler2D gbuffer_albedo;
layout(set = 0, binding = 2) uniform sampler2D gbuffer_normal;
layout(set = 0, binding = 3) uniform usampler2D gbuffer_surface;
layout(set = 0, binding = 4) uniform sampler2D gbuffer_depth;
layout(set = 0, binding = 5) uniform sampler2DArrayShadow shadow_map;
layout(set = 0, binding = 6) uniform sampler2DArray shadow_depth;
layout(set = 0, binding = 7) uniform samplerBuffer sun_height_m;
layout(set = 0, binding = 8) uniform usamplerBuffer trees; /* wd_packed_tree */
layout(set = 0, binding = 9) uniform usamplerBuffer lit_models; /* wd_lit_model */
layout(set = 0, binding = 10, rgba32f) uniform image2D radiance_image;
layout(scalar, set = 0, binding = 11) readonly buffer Tiles { wd_tile_lists lists; uint tiles[]; };
layout(set = 0, binding = 12) uniform sampler2D overlay;
layout(set = 0, binding = 13) uniform sampler2DArray canopy_light;
layout(set = 0, binding = 14) uniform sampler2D sky_map;
layout(scalar, set = 0, binding = 15) readonly buffer Waters { float river_m[]; };
layout(scalar, set = 0, binding = 16) readonly buffer Shafts { float shafts[]; };
layout(set = 0, binding = 17) uniform usamplerBuffer crown_sky;
layout(scalar, push_constant) uniform Push { wd_light_push push_block; };

/* llvmpipe reads a block once for all lanes only where all of them run, which is before any branch; within
 * one it gathers what it reads lane by lane. */
wd_frame_uniforms frame = frame_block;
wd_light_push push = push_block;

#define TREE_TEXELS
#define SHADOW_DEPTH shadow_depth
#define SHADOW_COMPARES (COMPARES != 0u)
#define ALL_SINGLE (SINGLE != 0u)
#define SUN_HEIGHT_AT(index) texelFetch(sun_height_m, int(index)).x
#define CANOPY_LIGHT_AT(at, layer) textureLod(canopy_light, vec3(at, layer), 0.0)
#define CANOPY_LIGHT canopy_light
#define SKY_MAP sky_map
#define CROWN_SKY crown_sky

#define WATER_AT(index) river_m[index]
#define SHAFT_AT(tile, slice) shafts[(tile) * WD_SHAFT_SLICES + (slice)]

#include "lib/dealt.glsl"
#include "lib/trees.glsl"
#include "lib/noise.glsl"
#include "lib/sky.glsl"
#include "lib/shadow.glsl"
#include "lib/gbuffer.glsl"
#include "lib/tree.glsl"
#include "lib/crown.glsl"
#include "lib/shade.glsl"
#ifdef WET
#include "lib/river.glsl"
#include "lib/water.glsl"

/* How far off the eye sees water at a pixel; negative: it sees none. */
float pixel_water_m(ivec2 at)
{
    float depth = texelFetch(gbuffer_depth, at, 0).x;
    vec3 ray = pixel_ray(at);
    float way_m = pixel_is_sky(depth) ? WD_SKY_M : length(ray) * frame.near_m / depth;
    return water_ahead_m(normalize(ray), way_m);
}
#endif

/* Ground or sky as the eye gets it, through water and air. */
vec3 seen(uvec2 at, vec3 radiance, vec3 direction, float distance_m, float water_m,
          float sun_share, float ground_share)
{
#ifdef WET
    if ((PARTS & WD_PART_WATER) != 0u) {
        float depth_m = distance_m < WD_SKY_M ? distance_m - water_m : 1e4;
        radiance = water_radiance(at, radiance, direction, water_m, depth_m, sun_share);
        distance_m = water_m;
        haze_end = IN_THE_OPEN;
    }
#endif
    bool sky = distance_m >= WD_SKY_M;
    if (sky && frame.fog_over <= 0.0)
        return radiance;
    if (sky) {
        distance_m = WD_FOG_SHADED_M;
        haze_end = over_eye(direction, distance_m);
    }
    vec2 open = haze_open(direction, distance_m);
    return sky ? wd_fog_shade_sky(radiance, direction, open.x, open.y)
               : wd_fog_apply(radiance, direction, distance_m, ground_share, open.x, open.y);
}

vec3 pixel_radiance(ivec2 at, float water_m)
{
    float depth = texelFetch(gbuffer_depth, at, 0).x;
    vec3 direction = normalize(pixel_ray(at));
    vec3 radiance = vec3(0.0);
    float distance_m = WD_SKY_M, sun_share = 1.0, ground_share = 1.0;
    if ((PARTS & WD_PART_GROUND) != 0u) {
        wd_pixel pixel = gbuffer_pixel(at, max(depth, 1e-9));
        radiance = shade(pixel, uvec2(at), sun_share, ground_share);
        distance_m = length(pixel.rel);
    }
    if ((PARTS & WD_PART_SKY) != 0u && pixel_is_sky(depth)) {
        radiance = sky_radiance(direction) + sun_disc(direction);
        distance_m = WD_SKY_M;
        sun_share = ground_share = 1.0;
    }
    return seen(uvec2(at), radiance, direction, distance_m, water_m, sun_share, ground_share);
}

void light_pixel(ivec2 at)
{
    if (at.x >= int(frame.width) || at.y >= int(frame.height))
        return;
    float water_m = -1.0;
#ifdef WET
    water_m = pixel_water_m(at);
    if ((water_m > 0.0) != ((PARTS & WD_PART_WATER) != 0u))
        return;
#endif
    haze_pixel = uvec2(at);
    haze_noise = pixel_noise(haze_pixel, frame.sample_index);
    vec4 radiance = vec4(pixel_radiance(at, water_m), 1.0);
    if (push.has_overlay != 0u) {
        vec4 over = texelFetch(overlay, at, 0);
        radiance.rgb = radiance.rgb * (1.0 - over.a) + over.rgb;
    }
    if (frame.adds != 0u)
        radiance += imageLoad(radiance_image, at);
    imageStore(radiance_image, at, radiance);
}

/* Software devices take a tile's rows one by one: what is the same for all of them is found once. */
void main()
{
    uint index = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    if (index >= lists.count[LIST])
        return;
    index = dealt(index, lists.count[LIST]);
    uint tile = tiles[LIST * push.tile_columns * push.tile_rows + index];
    ivec2 corner = ivec2(tile & 0xffffu, tile >> 16) * WD_TILE + ivec2(gl_LocalInvocationID.xy);
    know_eye();
    uint row = 0u;
    do {
        light_pixel(corner + ivec2(0, row));
        row += gl_WorkGroupSize.y;
    } while (row < WD_TILE);
}
