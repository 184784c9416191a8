/* From an id in the visibility buffer to the surface of a pixel. Expects `frame`, of which size, eye's rays, sun and
 * view mode are asked. */
layout(set = 0, binding = 1) uniform usamplerBuffer pixels;      /* id, depth */
layout(set = 0, binding = 2) uniform usamplerBuffer splat_trees; /* wd_splat_tree */
layout(set = 0, binding = 3) uniform usamplerBuffer items;       /* wd_splat_item */
layout(set = 0, binding = 4) uniform usamplerBuffer splats;      /* wd_splat */
layout(set = 0, binding = 5) uniform usamplerBuffer looks;       /* WD_SPLAT_* looks */
layout(set = 0, binding = 6) uniform usamplerBuffer wood_items;  /* wd_splat_item */
layout(set = 0, binding = 7) uniform usamplerBuffer wood;        /* wd_splat_corner */
layout(set = 0, binding = 8) uniform sampler2DArray bark;
layout(set = 0, binding = 9) uniform usamplerBuffer lit;         /* ways that are open, of each splat */

#include "lib/tree.glsl"
#include "lib/splat.glsl"
#include "lib/view.glsl"
#include "lib/disc.glsl"
#include "lib/mirror.glsl"

/* What the G-buffer holds of a pixel besides its depth. */
struct wd_resolved {
    vec4 albedo; /* linear; a: openness */
    vec4 normal;
    uint surface;
};

/* What is seen, in the model's axes. */
struct wd_seen {
    wd_splat_tree tree;
    vec3 albedo, normal, face;
    float openness;
    float lit; /* share of the sun that its tree lets through */
    uint open; /* ways that it leaves open */
    bool wood;
};

vec3 look_albedo(uint look)
{
    uvec3 level = uvec3(look, look >> 5, look >> 10) & uint(WD_SPLAT_ALBEDO_MOST);
    return exp2(vec3(level) * WD_SPLAT_ALBEDO_STEP + WD_SPLAT_ALBEDO_LEAST);
}

vec3 look_normal(uint look)
{
    ivec2 e = ivec2(bitfieldExtract(int(look), int(WD_SPLAT_NORMAL_BIT), 6),
                    bitfieldExtract(int(look), int(WD_SPLAT_NORMAL_BIT) + 6, 6));
    return octahedral(vec2(e) * (1.0 / WD_SPLAT_NORMAL_MOST));
}

wd_seen seen_splat(uint id)
{
    wd_splat_item item = splat_item_at(items, id / WD_ITEM_SPLATS);
    wd_splat_tree tree = splat_tree_at(splat_trees, item.tree);
    uint index =
        splat_index(tree, splat_turn(tree, WD_ITEM_FIRST(item) + id % WD_ITEM_SPLATS));
    uint look = texelFetch(looks, int(index)).x;
    wd_seen seen;
    seen.tree = tree;
    seen.face = splat_normal(splat_at(splats, index));
    seen.normal = look_normal(look);
    seen.albedo = look_albedo(look);
    seen.openness = float(bitfieldExtract(look, int(WD_SPLAT_OPENNESS_BIT), 4))
                    * (1.0 / WD_SPLAT_OPENNESS_MOST);
    seen.open = texelFetch(lit, int(index)).x;
    seen.lit = wd_sun_lit(seen.open, tree.sun);
    seen.wood = (look >> WD_SPLAT_WOOD_BIT & 1u) != 0u;
    return seen;
}

/* Perspective-correct shares of the corners at the pixel's middle, and pixels the triangle covers. */
vec4 corner_shares(wd_splat_tree tree, wd_splat_corner corners[3], vec2 middle)
{
    vec2 size = vec2(frame.width, frame.height), at[3];
    vec3 w;
    for (uint k = 0u; k < 3u; k++) {
        vec3 clip = splat_clip(tree, splat_place(corners[k].at));
        at[k] = (clip.xy / clip.z * 0.5 + 0.5) * size;
        w[k] = clip.z;
    }
    vec2 u = at[1] - at[0], v = at[2] - at[0], p = middle - at[0];
    float area = u.x * v.y - u.y * v.x;
    vec3 share = vec3(0.0, p.x * v.y - p.y * v.x, u.x * p.y - u.y * p.x) / area;
    share.x = 1.0 - share.y - share.z;
    share = max(share, 0.0) / w;
    return vec4(share / (share.x + share.y + share.z), abs(area));
}

wd_seen seen_wood(uint id, vec2 middle)
{
    wd_splat_item item = splat_item_at(wood_items, id / WD_ITEM_SPLATS);
    wd_splat_tree tree = splat_tree_at(splat_trees, item.tree);
    uvec3 at_corner =
        splat_wood_at(wood, tree.first_wood, WD_ITEM_FIRST(item) + id % WD_ITEM_SPLATS);
    wd_splat_corner corners[3];
    for (uint k = 0u; k < 3u; k++)
        corners[k] = splat_corner_at(wood, at_corner[k]);
    vec4 share = corner_shares(tree, corners, middle);
    vec2 uv[3];
    wd_seen seen;
    seen.tree = tree;
    seen.normal = seen.albedo = vec3(0.0);
    seen.openness = seen.lit = 0.0;
    seen.open = 0u;
    seen.face = vec3(0.0);
    for (uint k = 0u; k < 3u; k++) {
        vec4 tint = unpackUnorm4x8(corners[k].tint);
        seen.albedo += share[k] * tint.rgb * tint.rgb;
        seen.openness += share[k] * tint.a;
        seen.normal += share[k] * normalize(splat_normal(corners[k].at));
        uv[k] = unpackHalf2x16(corners[k].uv);
    }
    vec2 u = uv[1] - uv[0], v = uv[2] - uv[0];
    float texels = abs(u.x * v.y - u.y * v.x) * float(textureSize(bark, 0).x)
                   * float(textureSize(bark, 0).y);
    float lod = 0.5 * log2(max(texels / max(share.w, 1e-6), 1.0));
    vec2 at = share.x * uv[0] + share.y * uv[1] + share.z * uv[2];
    seen.albedo *= textureLod(bark, vec3(at, float(WD_TREE_BARK(tree))), lod).rgb;
    seen.wood = true;
    return seen;
}

vec4 pack_splat(wd_seen seen, tree_pose pose, vec3 normal, vec3 face, bool below, vec3 eye)
{
    float beyond = mirrors_beyond(seen.open, pose, -eye, dot(normal, eye) < 0.0 ? -normal : normal, face);
    uint kind = seen.wood ? DISC_WOOD : below ? DISC_LEAF_BELOW : disc_above(beyond);
    return disc_pack_seen(normal, below ? -face : face, eye, frame.sun_direction, kind,
                          clamp(seen.lit, DISC_LIT_LEAST, DISC_LIT_MOST));
}

/* `id` is that of a disc or, with `of_wood`, of a triangle of wood. */
wd_resolved resolve(uvec2 at, uint id, bool of_wood)
{
    wd_seen seen;
    if (of_wood)
        seen = seen_wood((id & ~WD_ID_WOOD) - 1u, vec2(at) + 0.5);
    else
        seen = seen_splat(id - 1u);
    vec2 turn = unpackHalf2x16(seen.tree.turn);
    vec2 shape = unpackHalf2x16(seen.tree.shape);
    vec4 tint = unpackUnorm4x8(seen.tree.tint) * 2.0;
    tree_pose pose = tree_pose(turn, vec2(shape.x, 1.0), 1.0, shape.y);
    vec3 normal = tree_normal(pose, seen.normal), eye = -normalize(pixel_ray(ivec2(at)));
    vec3 face = of_wood ? normal : tree_normal(pose, seen.face);
    bool below = dot(face, eye) < 0.0;
    vec4 lower = unpackUnorm4x8(seen.tree.lower) * vec4(4.0, 4.0, 4.0, 2.0);
    if (!seen.wood)
        seen.albedo = min(seen.albedo * tint.rgb * (below ? lower.rgb : vec3(1.0)), 1.0);
    if (!of_wood)
        seen.openness = min(seen.openness * (seen.wood ? lower.a : tint.a), 1.0);
    seen.lit *= seen.wood ? lower.a : 1.0;
    if (frame.view_mode == WD_MODE_LOD)
        seen.albedo = (seen.wood ? vec3(0.5, 0.3, 0.1) : vec3(0.1, 0.6, 0.15))
                      * (0.3 + 0.7 * seen.openness);
    return wd_resolved(vec4(seen.albedo, seen.openness),
                       of_wood ? vec4(normal * 0.5 + 0.5, float(WD_MATERIAL_WOOD) / 3.0)
                               : pack_splat(seen, pose, normal, face, below, eye),
                       seen.tree.tree + 1u);
}
