/* Light on ground, wood and leaves. Every costly step stands here once, whatever the material:
 * software devices run both sides of a branch.
 * Expects `frame`, `push` (wd_light_push), `trees`, `models`, PARTS and the libraries of noise,
 * shadow, gbuffer, tree and crown. */

#include "shared/canopy.h"

const float PER_PI = 0.318309886;

/* Skylight on a surface, with what the ground throws back from below. Under a canopy it has come
 * through leaves. */
vec3 ambient(vec3 normal, float openness)
{
    float up = 0.5 + 0.5 * normal.z;
    float toward = dot(normal.xy, frame.sun_direction.xy);
    vec3 sky = frame.sky_irradiance * (up * (1.0 + 0.25 * toward));
    vec3 lit_ground = frame.sun_irradiance * (0.35 * max(frame.sun_direction.z, 0.0))
                      + 0.6 * frame.sky_irradiance;
    vec3 leafy = mix(vec3(0.90, 0.82, 0.80), vec3(1.0), openness);
    return (sky + lit_ground * frame.grass * (1.0 - up)) * leafy * openness;
}

/* acos within 0.02 (Lagarde 2014) */
float angle_of(float cosine)
{
    float x = min(abs(cosine), 1.0);
    float angle = (1.5707963 - 0.21 * x) * sqrt(1.0 - x);
    return cosine < 0.0 ? 3.14159265 - angle : angle;
}

/* Leaves turned every way, seen and lit from directions whose cosine is given: mean share of their
 * reflected (x) and transmitted (y) light relative to a lit wall (Ross 1981). */
vec2 leaf_cloud(float cosine)
{
    float angle = angle_of(cosine), sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    return vec2(sine + (3.14159265 - angle) * cosine, sine - angle * cosine) * (2.0 / 9.4247780);
}

/* Leaves that the eye sees from the sun's side are those that the sun reaches: the nearer both
 * directions, the fewer shaded leaves are seen (Kuusk 1985). From above, most of the others lie in the
 * shade of neighbours; a forest's edge, seen level, has few. Factors on the light that an even cloud
 * of leaves would return, set by the path tracer's curve over a closed canopy (docs/lighting.md). */
float sunlit_seen(vec3 eye)
{
    float apart = angle_of(dot(eye, frame.sun_direction));
    return mix(0.95, 0.33, smoothstep(0.0, 0.5, eye.z)) + 1.55 * exp(-2.7 * apart);
}

/* One leaf with its own normal: which side the sun and the eye are on. */
vec2 leaf_blade(vec3 normal, vec3 eye)
{
    float facing = dot(normal, frame.sun_direction) * (dot(normal, eye) < 0.0 ? -1.0 : 1.0);
    return vec2(max(facing, 0.0), max(-facing, 0.0));
}

/* What a leaf's wax mirrors of the sun, relative to a lit wall: Blinn and Phong's lobe with the
 * normal reflection of wax (0.04), as wide as GGX of this roughness. Far off, leaves of every
 * direction share a pixel and the lobe widens; no leaf is flat enough for less than 0.42. */
float leaf_gloss(wd_pixel pixel, float roughness, float near)
{
    float wide = max(mix(0.8, roughness, near), 0.42);
    wide *= wide;
    float power = max(2.0 / (wide * wide) - 2.0, 1.0);
    float shine = abs(dot(pixel.normal, normalize(frame.sun_direction - pixel.direction)));
    return near * 0.04 * 0.125 * (power + 2.0) * exp2(power * log2(max(shine, 1e-3)));
}

/* What light meets at a pixel. */
struct wd_place {
    vec3 rel;           /* where it is taken to be */
    vec3 normal;        /* for skylight and for the shadow maps */
    float own;          /* share of the sun left after the tree's own leaves */
    float ahead_m;      /* how far toward the sun to go before asking the maps */
    vec2 sides;         /* share of the sun reflected and transmitted toward the eye */
    vec3 transmittance; /* over albedo */
    float gloss;
    float wax;          /* of leaves: mean reflection of their surface, white */
    float sky;          /* of the skylight that its openness says: leaves shade each other */
};

wd_place ground_place(wd_pixel pixel)
{
    wd_place place;
    place.rel = pixel.rel;
    place.normal = pixel.normal;
    place.own = 1.0;
    place.ahead_m = 0.0;
    place.sides = vec2(max(dot(pixel.normal, frame.sun_direction), 0.0), 0.0);
    place.transmittance = vec3(0.0);
    place.gloss = 0.0;
    place.wax = 0.0;
    place.sky = 1.0;
    return place;
}

/* What a tree's own leaves leave of the sun: `mapped` of their shade is in the shadow map, the rest
 * follows from depth in the crown, behind which the map is then asked. */
void shade_by_crown(inout wd_place place, wd_crown crown, float openness, float mapped,
                    uint cascade)
{
    float path_m = crown_path_m(crown, place.rel);
    float through = crown_through(crown, path_m) * min(openness * 1.2, 1.0);
    place.own = mix(through, 1.0, mapped);
    place.ahead_m = mapped > 0.0 ? 0.0 : path_m + frame.cascade_texel_m[min(cascade, 3u)];
}

/* Wood within a crown is in its shade as leaves are. */
wd_place wood_place(wd_pixel pixel, uint cascade)
{
    wd_tree tree = trees[pixel.surface - 1u];
    wd_model model = models[WD_TREE_SPECIES(tree) * push.variants
                            + WD_TREE_VARIANT(tree) % push.variants];
    wd_place place = ground_place(pixel);
    shade_by_crown(place, crown_of(tree, model), pixel.openness, cascade == 0u ? 1.0 : 0.0,
                   cascade);
    return place;
}

/* Near, the maps hold each leaf and the crown's depth adds little; far, they hold crowns only: the
 * crown is left behind before the map is asked, and depth along the sun does the rest. A crown is no
 * even cloud: what sees little of the sky sees little of the sun. Both factors are set so that
 * dense forest from above and from within is as bright as path-traced (docs/reference.md). */
wd_place leaf_place(wd_pixel pixel, uint cascade)
{
    wd_tree tree = trees[pixel.surface - 1u];
    wd_model model = models[WD_TREE_SPECIES(tree) * push.variants
                            + WD_TREE_VARIANT(tree) % push.variants];
    wd_crown crown = crown_of(tree, model);
    bool card = pixel.material == WD_MATERIAL_CARD;
    vec3 eye = -pixel.direction;
    float near = card ? 0.25 : mix(0.8, 0.3, clamp(pixel.axis_m / 120.0, 0.0, 1.0));
    float mapped = cascade == 0u && !card ? 0.75 : 0.0;
    wd_place place;
    place.rel = card ? crown_card_place(crown, pixel.direction) : pixel.rel;
    shade_by_crown(place, crown, pixel.openness, mapped, cascade);
    vec3 outward = crown_normal(crown, place.rel);
    float cosine = dot(eye, frame.sun_direction);
    place.sides = mix(leaf_cloud(cosine), leaf_blade(pixel.normal, eye), near);
    place.sides *= mix(sunlit_seen(eye), 1.0, mapped);
    place.transmittance = model.transmittance;
    place.gloss = leaf_gloss(pixel, model.roughness, near) + 0.010;
    place.wax = 0.024;
    place.sky = mix(1.05, 0.80, smoothstep(0.0, 0.5, eye.z));
    place.normal = normalize(mix(outward, pixel.normal, 0.4 * near));
    return place;
}

/* Where the shader does not say what canopy covers a place, none does. */
#ifndef COVER_AT
#define COVER_AT(at) 0.0
#endif

/* Share of the sky that the forest around leaves to a place on a tree: as little as to the ground at
 * its foot, all of it at its top, for trees stand among their like. */
float forest_openness(wd_pixel pixel)
{
    wd_tree tree = trees[pixel.surface - 1u];
    vec2 at = (pixel.rel.xy + push.camera_m) * push.cover_scale;
    float up = (pixel.rel.z - tree_foot_rel(tree).z) / max(WD_TREE_HEIGHT_M(tree), 0.1);
    return mix(wd_canopy_openness(COVER_AT(at)), 1.0,
               smoothstep(0.0, 0.75, up));
}

/* `sun_share` is what of the sun reaches the place, `ground_share` what the ground leaves of it. */
vec3 shade(wd_pixel pixel, uvec2 at, out float sun_share, out float ground_share)
{
    float noise = pixel_noise(at, frame.sample_index);
    uint cascade = shadow_cascade(pixel.axis_m, noise);
    wd_place place = ground_place(pixel);
    float openness = pixel.openness;
    if ((PARTS & WD_PART_TREES) != 0u && pixel.surface != 0u)
        openness *= forest_openness(pixel);
    if ((PARTS & WD_PART_TREES) != 0u && pixel.surface != 0u) {
        if (pixel.material >= WD_MATERIAL_LEAF)
            place = leaf_place(pixel, cascade);
        else
            place = wood_place(pixel, cascade);
    }
    ground_share = ground_shadow(place.rel);
    vec3 ahead = place.rel + frame.sun_direction * place.ahead_m;
    sun_share = place.own * ground_share * tree_shadow(ahead, place.normal, cascade, noise);
    if (pixel.surface == 0u) { /* no maps so far out: the canopy's cover stands for its shadow */
        float out_of_maps = smoothstep(0.75, 1.0, pixel.axis_m / frame.cascade_far_m.w);
        sun_share *= mix(1.0, pixel.openness * pixel.openness, out_of_maps);
    }
    vec3 transmitted = pixel.albedo * place.transmittance;
    vec3 sunlit = pixel.albedo * place.sides.x + transmitted * place.sides.y + place.gloss;
    vec3 skylit = pixel.albedo + 0.4 * transmitted + place.wax;
    vec3 light = frame.sun_irradiance * sun_share * sunlit
                 + ambient(place.normal, openness) * place.sky * skylit;
    return light * PER_PI;
}
