#version 460
#include "shared/forest.h"
#include "shared/hash.h"
#include "shared/octant.h"

layout(scalar, set = 0, binding = 0) readonly buffer Trees { wd_packed_tree trees[]; };
layout(scalar, set = 0, binding = 1) readonly buffer Models { wd_model models[]; };
layout(scalar, set = 0, binding = 2) readonly buffer Pictures { wd_octant_picture pictures[]; };
layout(set = 0, binding = 4) uniform sampler2DArray card_albedo;
layout(set = 0, binding = 5) uniform sampler2DArray card_normal;
layout(set = 0, binding = 6) uniform sampler2DArray card_depth;
layout(scalar, push_constant) uniform Push { wd_octant_push push; };

#include "lib/trees.glsl"
#include "lib/octant.glsl"
#include "lib/dither.glsl"
#include "lib/mixed.glsl"
#include "lib/card_picture.glsl"

layout(location = 0) in vec2 in_place;
layout(location = 1) flat in uvec2 in_entry;

layout(location = 0) out vec4 out_albedo;
layout(location = 1) out vec4 out_normal;

/* The card to show, where in it, and how it is turned: its width and its normal in model axes. */
struct octant_card {
    vec3 uv;
    vec2 width, normal;
    float behind, mirrored; /* 1: seen from behind; -1: its width runs to the left */
    float denser; /* factor on its opacity */
};

/* Factor from a way from the foot in the picture to the one in the tree. Crowns reach beyond the bounds by
 * which cubes hold trees; where no other cube holds what sticks out of this one, it is pressed into it. */
float pressed(octant_tree t, float foot_m, float off_m)
{
    float room_m = off_m < 0.0 ? foot_m : t.picture.size_m - foot_m;
    float reach_m = t.model.half_width_m * t.pose.across;
    bool alone = room_m > 0.5 * WD_TREE_CROWN_M(t.tree) - 0.002;
    return alone ? clamp(reach_m / room_m, 1.0, 1.3) : 1.0;
}

/* Seen from the side: the card that faces the viewer most, turned to face it wholly. */
octant_card upright_card(octant_tree t, vec2 at_m)
{
    vec2 toward = octant_model_axis(t, t.axes.toward.xy);
    vec2 right = octant_model_axis(t, t.axes.right.xy);
    octant_card card;
    float best = -1.0;
    uint index = 0u;
    for (uint i = 0u; i < WD_CARD_SIDES; i++) {
        float angle = 1.0471975512 * float(i);
        vec2 normal = vec2(sin(angle), -cos(angle));
        if (abs(dot(normal, toward)) > best) {
            best = abs(dot(normal, toward));
            card.normal = normal;
            index = i;
        }
    }
    card.width = vec2(-card.normal.y, card.normal.x);
    card.behind = dot(card.normal, toward) < 0.0 ? 1.0 : 0.0;
    card.mirrored = dot(card.width, right) < 0.0 ? -1.0 : 1.0;
    float off_m = at_m.x - t.foot.x;
    card.denser = pressed(t, t.foot.x, off_m);
    float across = off_m * card.denser / (t.model.half_width_m * t.pose.across);
    float z = (at_m.y - t.foot.y) / t.pose.up;
    vec2 place = vec2(0.5 + 0.5 * card.mirrored * across, (t.model.top_m - z) / (t.model.top_m - t.model.bottom_m));
    card.uv = vec3(card_picture_uv(place, card_lies(t.model)), float(t.model.card_layer + index));
    return card;
}

octant_card level_card(octant_tree t, vec2 at_m)
{
    vec2 off = at_m - t.foot.xy;
    vec2 press = vec2(pressed(t, t.foot.x, off.x), pressed(t, t.foot.y, off.y));
    off *= press;
    vec2 world = off.x * t.axes.right.xy + off.y * t.axes.up.xy;
    vec2 own = octant_model_axis(t, world) / (t.pose.across * t.model.half_depth_m);
    octant_card card;
    card.denser = press.x * press.y;
    card.behind = t.picture.side == 5u ? 1.0 : 0.0;
    card.mirrored = 1.0;
    card.width = card.normal = vec2(0.0);
    card.uv = vec3(card_picture_uv(vec2(0.5 + 0.5 * own.x, 0.5 - 0.5 * own.y), card_lies(t.model)),
                   float(t.model.card_layer + WD_CARD_SIDES));
    return card;
}

/* Metres from the cube's far side toward the viewer of what the card shows. */
float depth_m(octant_tree t, octant_card card, vec4 depth)
{
    float near = card.behind > 0.5 ? 1.0 - depth.y : depth.x;
    if (!octant_level(t))
        return t.foot.z + (near - 0.5) * 2.0 * t.model.half_width_m * t.pose.across;
    float from = t.model.bottom_m, to = t.model.top_m;
    return t.foot.z + t.pose.up * (card.behind > 0.5 ? mix(-to, -from, near) : mix(from, to, near));
}

/* What of a tree reaches beyond its bounds is in the cube that these are in: no other holds it. */
float within_m(octant_tree t, float toward_m)
{
    float half_m = 0.5 * WD_TREE_CROWN_M(t.tree), height_m = WD_TREE_HEIGHT_M(t.tree);
    vec2 bounds_m = t.foot.z + (t.picture.side == 4u   ? vec2(0.0, height_m)
                                : t.picture.side == 5u ? vec2(-height_m, 0.0)
                                                       : vec2(-half_m, half_m));
    float least_m = bounds_m.x > -0.002 ? 0.0 : min(toward_m, 0.0);
    float most_m = bounds_m.y < t.picture.size_m + 0.002 ? 0.9999 * t.picture.size_m : toward_m;
    return clamp(toward_m, least_m, max(most_m, least_m));
}

vec3 world_normal(octant_tree t, octant_card card, vec3 n)
{
    if (!octant_level(t))
        return dot(n.xy, card.width) * card.mirrored * t.axes.right
               + dot(n.xy, card.normal) * t.axes.toward + vec3(0.0, 0.0, n.z);
    n.x *= t.pose.mirror;
    n.xy = vec2(n.x * t.pose.turn_cos - n.y * t.pose.turn_sin,
                n.x * t.pose.turn_sin + n.y * t.pose.turn_cos);
    return card.behind > 0.5 ? vec3(n.xy, -n.z) : n;
}

/* A place in a pixel, -0.5..0.5: pixels are coarse beside a tree, and stand alike to many of them. */
vec2 within_pixel(uvec2 at, uint seed)
{
    uint random = wd_hash2(seed, at.x | at.y << 16);
    return vec2(random & 0xffffu, random >> 16) * (1.0 / 65536.0) - 0.5;
}

void main()
{
    octant_tree t = octant_tree_of(in_entry.x, in_entry.y);
    float pixel_m = t.picture.size_m / float(push.tile_pixels);
    uvec2 at = uvec2(gl_FragCoord.xy) % push.tile_pixels;
    uint seed = wd_hash1(in_entry.x * 6u + t.picture.side);
    vec2 place = in_place + pixel_m * within_pixel(at, seed);
    octant_card card;
    if (octant_level(t))
        card = level_card(t, place);
    else
        card = upright_card(t, place);
    float texels = float(card_lies(t.model) ? WD_CARD_HEIGHT_TEXELS : WD_CARD_WIDTH_TEXELS);
    float texel_m = 2.0 * t.model.half_width_m * t.pose.across / texels;
    float lod = max(log2(pixel_m / texel_m), 0.0);
    vec4 albedo = textureLod(card_albedo, card.uv, lod);
    float noise = dither_from(at, seed);
    vec4 depth = textureLod(card_depth, card.uv, lod);
    float toward_m = within_m(t, depth_m(t, card, depth));
    float slice_m = t.picture.size_m / float(t.picture.slices);
    float from_m = float(t.picture.slice) * slice_m;
    bool inside = all(greaterThanEqual(card.uv.xy, vec2(0.0)))
                  && all(lessThan(card.uv.xy, vec2(1.0))) && toward_m >= from_m && toward_m < from_m + slice_m;
    if (noise >= albedo.a * card.denser || !inside)
        discard;
    vec4 normal = textureLod(card_normal, card.uv, lod - float(WD_CARD_NORMAL_MIP));
    vec3 turned = world_normal(t, card, normal.xyz * 2.0 - 1.0);
    bool wood = dither_from(at, wd_hash1(seed)) >= depth.a;
    vec4 own = unmixed(vec4(albedo.rgb, normal.a), depth.a, wood, t.model.mixed);
    out_albedo = wood ? vec4(own.rgb, WD_OCTANT_SHOWN) : vec4(own.rgb * wd_tree_tint(t.tree, t.model), 1.0);
    out_normal = vec4(turned * 0.5 + 0.5, own.a);
    gl_FragDepth = (toward_m - from_m) / slice_m * 0.999 + 0.001;
}
