#version 460
/* DETAIL: full meshes near the camera, with the relief of their looks, backs of leaves, moss. What of the
 * frame is asked comes from the vertices: fragments of software devices read blocks lane by lane. */
#include "shared/frame.h"
#include "shared/forest.h"
#include "shared/hash.h"

layout(constant_id = 1) const uint DETAIL = 0u;

layout(scalar, set = 0, binding = 0) readonly buffer Frame { wd_frame_uniforms frame; };
layout(set = 0, binding = 5) uniform sampler2DArray looks;
layout(set = 0, binding = 6) uniform sampler2DArray look_details;
layout(scalar, push_constant) uniform Push { wd_tree_push push; };

#include "lib/tree.glsl"
#include "lib/look.glsl"
#include "lib/grain.glsl"
#include "lib/disc.glsl"
#include "lib/flat_mirrors.glsl"
#include "shared/snow.h"

layout(location = 0) in vec3 in_normal;
layout(location = 1) in vec3 in_uv;
layout(location = 2) in vec4 in_tint;
layout(location = 3) flat in uvec3 in_flat;
layout(location = 4) flat in vec4 in_sun_show;
layout(location = 5) in vec4 in_place;

layout(location = 0) out vec4 out_albedo;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out uint out_surface;

const vec3 MOSS = vec3(0.066, 0.086, 0.026);

struct wd_surface {
    vec3 albedo, normal;
    float openness;
};

bool is_blade()
{
    return (uint(in_uv.z + 0.5) & (WD_LOOK_LAYERS - 1u)) == WD_LOOK_LEAF;
}

/* Where the look of this side is: leaves have another below. */
vec3 seen_side()
{
    bool back = is_blade() && !look_upper(in_uv.xy, (in_flat.y & 4u) != 0u);
    return vec3(in_uv.xy, in_uv.z + (back ? float(WD_LOOK_LEAF_BACK - WD_LOOK_LEAF) : 0.0));
}

/* What comes through the place of a leaf, over what comes through all of it. */
float vein_through(float rest)
{
    return rest / max(textureLod(look_details, vec3(0.5, 0.5, seen_side().z), 16.0).a, 0.05);
}

/* A leaf as the sheet that it is: its lower side, its veins on top of how it is turned to the light, and
 * where the sun shines through, what comes through. */
void detail_leaf(inout wd_surface leaf, float near)
{
    vec3 face = look_face(in_place.xyz);
    wd_relief relief =
        look_relief(look_details, look_frame(face, in_place.xyz, in_uv.xy), seen_side());
    float lit = dot(face, in_sun_show.xyz);
    float through = mix(1.0, vein_through(relief.rest), near * (1.0 - smoothstep(-0.05, 0.05, lit)));
    leaf.albedo *= through;
    /* Seen or lit at a flat angle, veins hide their own far sides. */
    float seen_lit = min(abs(dot(leaf.normal, normalize(in_place.xyz))), abs(dot(leaf.normal, in_sun_show.xyz)));
    vec3 veins = (0.8 * near * smoothstep(0.0, 0.6, seen_lit)) * (relief.normal - face);
    leaf.normal = normalize(leaf.normal + (dot(face, leaf.normal) < 0.0 ? -veins : veins));
}

void detail_wood(inout wd_surface wood, wd_grain grain, float near)
{
    mat3 frame_of_uv = look_frame(wood.normal, in_place.xyz, in_uv.xy);
    wd_relief relief = look_relief(look_details, frame_of_uv, in_uv + vec3(grain.aside, 0.0));
    relief.normal = normalize(relief.normal - frame_of_uv * vec3(grain.slope, 0.0));
    float share = in_place.w + (in_place.w > 0.0 ? moss_patches(in_uv.xy, in_place.w) : 0.0);
    float moss = 0.85 * smoothstep(0.0, 0.6, share - 0.55 * relief.rest * (1.0 - 0.5 * in_place.w));
    wood.albedo = mix(wood.albedo, MOSS * (0.6 + 0.8 * relief.rest), moss);
    wood.normal = normalize(mix(wood.normal, relief.normal, near * (1.0 - 0.6 * moss)));
}

/* As the path tracer lights it: by its own face and side. */
vec4 pack_leaf(vec3 normal)
{
    bool above = is_blade() && look_upper(in_uv.xy, (in_flat.y & 4u) != 0u);
    return disc_pack_seen(normal, look_face(in_place.xyz), -normalize(in_place.xyz),
                          in_sun_show.xyz,
                          above ? disc_above(unpack_mirrors(in_flat.y)) : DISC_LEAF_BELOW, DISC_LIT_MESH);
}

void main()
{
    /* G7: leaf by leaf: whole triangles come and go. */
    float noise = wd_hash_unit(in_flat.z);
    if (noise >= in_sun_show.a)
        discard;
    uint material = in_flat.y & 3u;
    wd_grain grain = NO_GRAIN;
    if (DETAIL != 0u) {
        vec2 wide = fwidth(in_uv.xy) * BARK_TILE_M;
        if (material == WD_MATERIAL_WOOD)
            grain = bark_grain(in_uv.xy, max(wide.x, wide.y));
    }
    vec4 look = texture(looks, seen_side() + vec3(grain.aside, 0.0));
    if (look.a < WD_LOOK_CUT)
        discard;
    wd_surface surface = wd_surface(look.rgb * in_tint.rgb * grain.shade, normalize(in_normal), in_tint.a);
    float snow_up = wd_snow_up(surface.normal.z);
    if (DETAIL != 0u) {
        float near = 1.0 - smoothstep(RELIEF_WHOLE_M, RELIEF_NONE_M, length(in_place.xyz));
        if (material == WD_MATERIAL_LEAF)
            detail_leaf(surface, near);
        else
            detail_wood(surface, grain, near);
    }
    if ((in_flat.y & 8u) != 0u)
        surface.albedo = level_color(push.level) * (0.3 + 0.7 * in_tint.a);
    out_albedo = vec4(surface.albedo, surface.openness);
    out_normal = vec4(surface.normal * 0.5 + 0.5, float(material) / 3.0);
    if (DETAIL != 0u)
        out_normal = material == WD_MATERIAL_LEAF ? pack_leaf(surface.normal) : disc_pack_bark(surface.normal, snow_up);
    out_surface = in_flat.x;
}
