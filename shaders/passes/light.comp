#version 460
#include "shared/frame.h"
#include "shared/forest.h"
#include "shared/light.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, set = 0, binding = 0) readonly buffer Frame { wd_frame_uniforms frame; };
layout(set = 0, binding = 1) uniform sampler2D gbuffer_albedo;
layout(set = 0, binding = 2) uniform sampler2D gbuffer_normal;
layout(set = 0, binding = 3) uniform usampler2D gbuffer_surface;
layout(set = 0, binding = 4) uniform sampler2D gbuffer_depth;
layout(set = 0, binding = 5) uniform sampler2DArrayShadow shadow_map;
layout(scalar, set = 0, binding = 6) readonly buffer SunHeights { float sun_height_m[]; };
layout(scalar, set = 0, binding = 7) readonly buffer Trees { wd_tree trees[]; };
layout(scalar, set = 0, binding = 8) readonly buffer Models { wd_model models[]; };
layout(set = 0, binding = 9, rgba32f) uniform image2D radiance_image;
layout(scalar, push_constant) uniform Push { wd_light_push push; };

#define SUN_HEIGHT_AT(index) sun_height_m[index]

#include "lib/noise.glsl"
#include "lib/sky.glsl"
#include "lib/fog.glsl"
#include "lib/shadow.glsl"
#include "lib/gbuffer.glsl"
#include "lib/tree.glsl"
#include "lib/crown.glsl"
#include "lib/water.glsl"
#include "shared/hash.h"

const float PER_PI = 0.318309886;

/* Skylight on a surface, with what the ground throws back from below. */
vec3 ambient(vec3 normal, float openness)
{
    float up = 0.5 + 0.5 * normal.z;
    vec3 across = vec3(frame.sun_direction.xy, 0.0);
    vec3 sky = frame.sky_irradiance * (up * (1.0 + 0.25 * dot(normal, across)));
    vec3 lit_ground = frame.sun_irradiance * (0.35 * max(frame.sun_direction.z, 0.0))
                      + 0.6 * frame.sky_irradiance;
    return (sky + lit_ground * frame.grass * (1.0 - up)) * openness;
}

vec3 shade_ground(wd_pixel pixel, uint cascade, float noise, out float sun_share)
{
    sun_share = ground_shadow(pixel.rel);
    float facing = max(dot(pixel.normal, frame.sun_direction), 0.0);
    if (sun_share * facing > 0.0)
        sun_share *= tree_shadow(pixel.rel, pixel.normal, cascade, noise);
    if (cascade >= WD_CASCADES) /* no map so far out: the canopy's cover stands for its shadow */
        sun_share *= pixel.openness * pixel.openness;
    vec3 light = frame.sun_irradiance * (facing * sun_share) + ambient(pixel.normal, pixel.openness);
    return pixel.albedo * light * PER_PI;
}

/* Leaves turned every way, seen and lit from directions whose cosine is given: mean share of their
 * reflected (x) and transmitted (y) light relative to a lit wall (Ross 1981). */
vec2 leaf_cloud(float cosine)
{
    float angle = acos(clamp(cosine, -1.0, 1.0));
    float opposite = 3.14159265 - angle;
    return vec2(sin(angle) + opposite * cosine, sin(angle) - angle * cosine) * (2.0 / 9.4247780);
}

/* One leaf with its own normal: which side the sun and the eye are on. */
vec2 leaf_blade(vec3 normal, vec3 eye)
{
    vec3 seen = dot(normal, eye) < 0.0 ? -normal : normal;
    float facing = dot(seen, frame.sun_direction);
    return vec2(max(facing, 0.0), max(-facing, 0.0));
}

struct leaf_place {
    vec3 rel;     /* where the place is taken to be */
    float sun;    /* share of the sun left after the tree's own leaves */
    float own;    /* how far toward the sun the tree's own crown reaches, for the shadow map */
    vec3 outward; /* smooth normal of the crown */
};

/* Near, the maps hold each leaf and the crown's depth adds little; far, they hold crowns only: the
 * crown is left behind before the map is asked, and depth along the sun does the rest. */
leaf_place place_leaf(wd_pixel pixel, wd_tree tree, wd_model model, uint cascade)
{
    wd_crown crown = crown_of(tree, model);
    leaf_place place;
    place.rel = pixel.material == WD_MATERIAL_CARD ? crown_card_place(crown, pixel.rel) : pixel.rel;
    float path_m = crown_path_m(crown, place.rel);
    float mapped = cascade == 0u && pixel.material != WD_MATERIAL_CARD ? 1.0 : 0.0;
    place.own = mapped > 0.0 ? 0.0 : path_m + frame.cascade_texel_m[min(cascade, 3u)];
    place.sun = mix(crown_through(crown, path_m), 1.0, 0.6 * mapped);
    place.outward = crown_normal(crown, place.rel);
    return place;
}

vec3 shade_leaf(wd_pixel pixel, uint cascade, float noise, out float sun_share)
{
    wd_tree tree = trees[pixel.surface - 1u];
    wd_model model = models[WD_TREE_SPECIES(tree) * push.variants + WD_TREE_VARIANT(tree)];
    leaf_place place = place_leaf(pixel, tree, model, cascade);
    sun_share = ground_shadow(place.rel) * place.sun;
    if (sun_share > 0.02)
        sun_share *= tree_shadow(place.rel + frame.sun_direction * place.own, place.outward,
                                 cascade, noise);
    vec3 eye = -pixel.direction;
    float cosine = dot(eye, frame.sun_direction);
    float near = pixel.material == WD_MATERIAL_CARD ? 0.25
                                                    : mix(0.8, 0.3, smoothstep(15.0, 120.0, pixel.axis_m));
    vec2 sides = mix(leaf_cloud(cosine), leaf_blade(pixel.normal, eye), near);
    vec3 transmitted = pixel.albedo * model.transmittance;
    vec3 leaf = pixel.albedo * sides.x + transmitted * sides.y;
    vec3 half_way = normalize(frame.sun_direction + eye);
    float gloss = 0.05 * near * pow(abs(dot(pixel.normal, half_way)), 24.0);
    float hotspot = 1.0 + 0.3 * smoothstep(0.9, 1.0, cosine);
    vec3 sun = frame.sun_irradiance * sun_share * (leaf * hotspot + gloss);
    vec3 normal = normalize(mix(place.outward, pixel.normal, 0.4 * near));
    vec3 sky = ambient(normal, pixel.openness) * (pixel.albedo + 0.4 * transmitted);
    return (sun + sky) * PER_PI;
}

vec3 shade_wood(wd_pixel pixel, uint cascade, float noise, out float sun_share)
{
    sun_share = ground_shadow(pixel.rel);
    float facing = max(dot(pixel.normal, frame.sun_direction), 0.0);
    if (sun_share * facing > 0.0)
        sun_share *= tree_shadow(pixel.rel, pixel.normal, cascade, noise);
    vec3 light = frame.sun_irradiance * (facing * sun_share) + ambient(pixel.normal, pixel.openness);
    return pixel.albedo * light * PER_PI;
}

vec3 shade(wd_pixel pixel, uvec2 at, out float sun_share)
{
    float noise = pixel_noise(at, frame.sample_index);
    uint cascade = shadow_cascade(pixel.axis_m, noise);
    if (pixel.material == WD_MATERIAL_GROUND || pixel.surface == 0u)
        return shade_ground(pixel, cascade, noise, sun_share);
    if (pixel.material == WD_MATERIAL_WOOD)
        return shade_wood(pixel, cascade, noise, sun_share);
    return shade_leaf(pixel, cascade, noise, sun_share);
}

/* What the other view modes show, for display without tone mapping. */
vec3 diagnose(wd_pixel pixel, float sun_share)
{
    switch (frame.view_mode) {
    case WD_MODE_LOD: return pixel.albedo * (0.6 + 0.4 * pixel.normal.z);
    case WD_MODE_NORMAL: return pow(pixel.normal * 0.5 + 0.5, vec3(2.2));
    case WD_MODE_SHADOW: return vec3(sun_share);
    case WD_MODE_TREE_ID:
        if (pixel.surface != 0u) {
            uint h = wd_hash1(trees[pixel.surface - 1u].id);
            return vec3(h & 0xffu, (h >> 8) & 0xffu, (h >> 16) & 0xffu) * (0.9 / 255.0) + 0.1;
        }
        return vec3(0.02);
    }
    return pixel.albedo;
}

/* Under the sky, or the ground under water, as the eye gets it. */
vec3 with_water_and_fog(vec3 radiance, vec3 direction, float distance_m, float sun_share)
{
    float water_m = water_distance(direction);
    if (water_m > 0.0 && water_m < distance_m) {
        float depth_m = distance_m < 1e8 ? distance_m - water_m : 1e4;
        radiance = water_radiance(radiance, direction, water_m, depth_m, sun_share);
        distance_m = water_m;
    }
    return distance_m < 1e8 ? apply_fog(radiance, direction, distance_m) : radiance;
}

vec3 pixel_radiance(ivec2 at)
{
    float depth = texelFetch(gbuffer_depth, at, 0).x;
    bool lit = frame.view_mode == WD_MODE_LIT;
    if (pixel_is_sky(depth)) {
        vec3 direction = normalize(pixel_ray(at));
        vec3 sky = lit ? sky_radiance(direction) + sun_disc(direction) : vec3(0.0);
        return lit ? with_water_and_fog(sky, direction, 1e9, 1.0) : sky;
    }
    wd_pixel pixel = gbuffer_pixel(at, depth);
    float sun_share;
    vec3 radiance = shade(pixel, uvec2(at), sun_share);
    if (!lit)
        return diagnose(pixel, sun_share);
    return with_water_and_fog(radiance, pixel.direction, length(pixel.rel), sun_share);
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= int(frame.width) || at.y >= int(frame.height))
        return;
    vec4 radiance = vec4(pixel_radiance(at), 1.0);
    if (frame.sample_index > 0u)
        radiance += imageLoad(radiance_image, at);
    imageStore(radiance_image, at, radiance);
}
