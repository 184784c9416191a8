/* Fragments of trees that are drawn by their view sets. VIEW_DEPTH defined: where on its ray a
 * pixel meets the tree follows from the pictures' depths; else the quad is all there is. */
#include "shared/frame.h"
#include "shared/view_draw.h"

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 5) readonly buffer ViewModels { wd_view_model view_models[]; };
layout(set = 0, binding = 6) uniform sampler2DArray view_albedo;
layout(set = 0, binding = 7) uniform sampler2DArray view_normal;
layout(set = 0, binding = 8) uniform sampler2DArray view_depth;
layout(scalar, push_constant) uniform Push { wd_view_push push; };

#include "lib/tree.glsl"
#include "lib/card.glsl"
#include "lib/card_material.glsl"

layout(location = 0) in vec3 in_model;
layout(location = 1) in vec2 in_side;
layout(location = 2) flat in vec3 in_eye;
layout(location = 3) flat in vec4 in_pose;
layout(location = 4) flat in vec4 in_foot;
layout(location = 5) flat in vec4 in_tint;
layout(location = 6) flat in uvec4 in_flat;
layout(location = 7) flat in vec3 in_weights;
layout(location = 8) flat in vec3 in_toward[3];

layout(location = 0) out vec4 out_albedo;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out uint out_surface;

/* What the three views show of a place, weighted by what each covers. */
struct view_sum {
    vec3 color, normal;
    float openness, leaf, covered;
};

uint view_of(uint i)
{
    return in_flat.w >> (10u * i) & 1023u;
}

bool in_picture(wd_view_point p)
{
    return p.x >= 0.0 && p.x <= 1.0 && p.y >= 0.0 && p.y <= 1.0;
}

/* The texel there: pictures smaller than their texels show these as they are, since means over
 * neighbours would mix in what stands beside the leaves. */
vec3 nearest_texel(vec3 uv, float lod)
{
    vec2 size = vec2(textureSize(view_albedo, int(lod)).xy);
    return vec3((floor(uv.xy * size) + 0.5) / size, uv.z);
}

/* Opacities are kept as they are to four times the pictures' size: edges are sharpened only beyond. From twice on blades
 * of grass, thinner than texels, lost a sixteenth. */
float view_opacity(float alpha)
{
    return card_opacity(alpha, in_foot.w + 3.0);
}

void add_view(inout view_sum sum, uint view, float weight, wd_view_point p, float layer)
{
    float lod = floor(max(in_foot.w, 0.0) + 0.5);
    wd_view_point at = wd_view_texel(push.atlas, view, p, lod);
    vec3 uv = vec3(at.x, at.y, layer), own = nearest_texel(uv, lod);
    vec4 albedo = textureLod(view_albedo, own, lod), normal = textureLod(view_normal, own, lod);
    uv = own;
    float share = in_picture(p) ? weight * view_opacity(albedo.a) : 0.0;
    sum.color += share * albedo.rgb;
    sum.normal += share * (normal.xyz * 2.0 - 1.0);
    sum.openness += share * normal.a;
    sum.leaf += share * textureLod(view_depth, uv, lod).a;
    sum.covered += share;
}

#ifdef VIEW_DEPTH
wd_view_frame frame_of(uint i)
{
    vec3 d = in_toward[i];
    return wd_view_frame_of(view_models[in_flat.z], wd_direction(d.x, d.y, d.z));
}

/* Where the surface that view i shows around `place` meets the ray: metres from `place` toward the
 * eye; y: how far the view is to be believed. */
vec2 surface_along(uint i, vec3 place, vec3 toward, float layer)
{
    wd_view_frame f = frame_of(i);
    wd_view_point p = wd_view_project(f, place.x, place.y, place.z);
    float lod = max(in_foot.w, 0.0);
    wd_view_point at = wd_view_texel(push.atlas, view_of(i), p, lod);
    vec3 uv = vec3(at.x, at.y, layer);
    float front = textureLod(view_depth, uv, lod).x;
    float covered = in_picture(p) ? textureLod(view_albedo, uv, lod).a : 0.0;
    float facing = dot(toward, in_toward[i]);
    return vec2((front - p.depth) * 2.0 * f.half_depth_m / max(facing, 0.2),
                in_weights[i] * (covered + 1e-3));
}

/* The place on the pixel's ray where the z-fields of the three views lie (Bruneton and Neyret 2012,
 * section 4): their mean at the quad, looked up again at the place found. */
vec3 refined_place(vec3 toward, float layer)
{
    vec3 place = in_model;
    for (uint step = 0u; step <= push.refine; step++) {
        vec2 sum = vec2(0.0);
        for (uint i = 0u; i < 3u; i++) {
            vec2 found = surface_along(i, place, toward, layer);
            sum += vec2(found.x * found.y, found.y);
        }
        place += toward * (sum.x / max(sum.y, 1e-6));
    }
    return place;
}

/* The search for a surface finds what covers rather than the holes between, the more texels it may move by. Six species'
 * rows at 8 to 128 pixels covered up to 8 % too much. */
float found_cover(float covered)
{
    return pow(covered, 1.0 + 0.09 * exp2(-0.8 * max(in_foot.w + 1.0, 0.0)));
}
#else
float found_cover(float covered)
{
    return covered;
}
#endif

vec3 world_vector(vec3 v, vec2 scale)
{
    v.x *= sign(in_pose.z);
    vec2 turned = vec2(in_pose.x * v.x - in_pose.y * v.y, in_pose.y * v.x + in_pose.x * v.y);
    return vec3(turned * scale.x, v.z * scale.y);
}

uvec2 view_cell()
{
    return uvec2((in_side * 0.5 + 1.0) * float(push.atlas.size) * exp2(-max(floor(in_foot.w), 0.0)));
}

float view_noise()
{
    uvec2 cell = view_cell();
    return wd_hash_unit(wd_hash_mix((cell.x | cell.y << 16) ^ in_flat.y
                                    ^ frame.sample_index * 0x9e3779b9u));
}

void main()
{
    float layer = float(view_models[in_flat.z].layer);
    view_sum sum = view_sum(vec3(0.0), vec3(0.0), 0.0, 0.0, 0.0);
#ifdef VIEW_DEPTH
    vec3 place = refined_place(normalize(in_eye - in_model), layer);
    for (uint i = 0u; i < 3u; i++)
        add_view(sum, view_of(i), in_weights[i],
                 wd_view_project(frame_of(i), place.x, place.y, place.z), layer);
#else
    wd_view_point p = wd_view_point(in_side.x * 0.5 + 0.5, in_side.y * 0.5 + 0.5, 0.0);
    for (uint i = 0u; i < (push.nearest != 0u ? 1u : 3u); i++)
        add_view(sum, view_of(i), in_weights[i], p, layer);
#endif
    if (view_noise() >= found_cover(sum.covered) * in_tint.a)
        discard;
    float per = 1.0 / max(sum.covered, 1e-5), leaf_share = sum.leaf * per;
    bool wood = card_material(leaf_share, view_cell(), in_flat.y) == WD_MATERIAL_WOOD;
    vec4 own = unmixed(vec4(sum.color, sum.openness) * per, leaf_share, wood, view_models[in_flat.z].mixed);
    vec3 albedo = wood ? own.rgb : own.rgb * in_tint.rgb;
    float openness = own.a;
    if (frame.view_mode == WD_MODE_LOD)
        albedo = level_color(WD_LEVEL_CARD) * (0.3 + 0.7 * openness);
    vec2 scale = vec2(in_pose.w, abs(in_pose.z));
    vec3 normal = world_vector(sum.normal * per, scale);
    normal *= length(sum.normal * per) / max(length(normal), 1e-5);
#ifdef VIEW_DEPTH
    vec3 rel = in_foot.xyz + world_vector(place, vec2(abs(in_pose.z), in_pose.w));
    vec4 clip = frame.clip_from_rel * vec4(rel, 1.0);
    gl_FragDepth = clamp(clip.z / clip.w, 0.0, 1.0);
    uint leaf = WD_MATERIAL_LEAF;
#else
    uint leaf = WD_MATERIAL_CARD;
#endif
    out_albedo = vec4(albedo, openness);
    out_normal = vec4(normal * 0.5 + 0.5, float(wood ? WD_MATERIAL_WOOD : leaf) / 3.0);
    out_surface = in_flat.x;
}
