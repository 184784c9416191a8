#version 460
/* Which pixels of far ground show canopy, and of which tree: a tree is drawn by lot among those
 * that stand there, and a place of it by lot from its picture from this side. So the mean over pixels is
 * that of the trees, at a cost that knows pixels only. */
#include "shared/frame.h"
#include "shared/forest.h"
#include "shared/hash.h"
#include "shared/canopy_map.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame; };
layout(set = 0, binding = 1) uniform sampler2D gbuffer_depth;
layout(set = 0, binding = 2) uniform sampler2D cover_map;
layout(scalar, set = 0, binding = 3) readonly buffer Trees { wd_packed_tree trees[]; };
layout(scalar, set = 0, binding = 4) readonly buffer Models { wd_model models[]; };
layout(scalar, set = 0, binding = 5) readonly buffer ViewModels { wd_view_model view_models[]; };
layout(scalar, set = 0, binding = 6) readonly buffer CellFirst { uint cell_first[]; };
layout(scalar, set = 0, binding = 7) readonly buffer CellTrees { uint cell_trees[]; };
layout(set = 0, binding = 8) uniform sampler2DArray view_albedo;
layout(set = 0, binding = 9) uniform sampler2DArray view_normal;
layout(set = 0, binding = 10) uniform sampler2DArray view_depth;
layout(scalar, set = 0, binding = 11) writeonly buffer Canopy { wd_canopy_pixel canopy[]; };
layout(scalar, push_constant) uniform Push { wd_canopy_push push; };

#include "lib/trees.glsl"
#include "lib/view.glsl"
#include "lib/tree.glsl"

vec3 ground_at(ivec2 at)
{
    ivec2 last = ivec2(frame.width, frame.height) - 1;
    float depth = texelFetch(gbuffer_depth, clamp(at, ivec2(0), last), 0).x;
    return pixel_ray(at) * (frame.near_m / max(depth, 1e-9));
}

/* Of the ground that a pixel and its neighbours show; steep where they lie far apart. */
float facing_of(ivec2 at, vec3 rel, vec3 ray)
{
    vec3 normal = cross(ground_at(at + ivec2(1, 0)) - rel, ground_at(at - ivec2(0, 1)) - rel);
    return abs(dot(ray, normal)) / max(length(normal), 1e-9);
}

/* A tree near a place by lot, or none: ~0. */
uint tree_near(vec2 local_m, uint random)
{
    ivec2 cell = ivec2(floor((local_m - push.cells_min_m) / push.cell_m));
    if (any(lessThan(cell, ivec2(0))) || cell.x >= int(push.columns) || cell.y >= int(push.rows))
        return ~0u;
    uint at = uint(cell.y) * push.columns + uint(cell.x);
    uint count = cell_first[at + 1u] - cell_first[at];
    return count == 0u ? ~0u : cell_trees[cell_first[at] + random % count];
}

wd_canopy_pixel canopy_of(uint index, vec3 ray, uint random)
{
    wd_tree tree = tree_at(index);
    uint model = WD_TREE_SPECIES(tree) * push.variants
                 + WD_TREE_VARIANT(tree) % push.variants % push.baked_variants;
    tree_pose pose = tree_pose_of(tree, models[model]);
    vec2 back = vec2(dot(-ray.xy, pose.turn), dot(-ray.xy, vec2(-pose.turn.y, pose.turn.x)));
    vec3 toward = normalize(vec3(back * pose.mirror / pose.across, -ray.z / pose.up));
    uint view = wd_hemisphere_nearest(push.atlas.hemisphere,
                                      wd_direction(toward.x, toward.y, max(toward.z, 0.0)));
    /* the coarsest mip has 4 x 4 texels: one of the middle columns, not of the foot */
    wd_view_point place;
    place.x = 0.25 * (1.5 + float(random & 1u));
    place.y = 0.25 * (0.5 + float((random >> 1) % 3u));
    place.depth = 0.0;
    float lod = float(push.atlas.mips - 1u);
    wd_view_point at = wd_view_texel(push.atlas, view, place, lod);
    vec3 uv = vec3(at.x, at.y, float(view_models[model].layer));
    vec4 normal = textureLod(view_normal, uv, lod);
    float leaf = textureLod(view_depth, uv, lod).a;
    vec3 albedo = textureLod(view_albedo, uv, lod).rgb * mix(vec3(1.0), tree_tint(tree, models[model]), leaf);
    vec3 mean = normal.xyz * 2.0 - 1.0;
    vec3 turned = tree_normal(pose, mean + vec3(0.0, 0.0, 1e-5)) * min(length(mean), 1.0);
    return wd_canopy_pixel(packUnorm4x8(vec4(sqrt(albedo), normal.a)),
                           packUnorm4x8(vec4(turned * 0.5 + 0.5, 0.0)), index + 1u);
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= int(frame.width) || at.y >= int(frame.height))
        return;
    uint slot = uint(at.y) * frame.width + uint(at.x);
    canopy[slot] = wd_canopy_pixel(0u, 0u, 0u);
    if (pixel_is_sky(texelFetch(gbuffer_depth, at, 0).x))
        return;
    vec3 rel = ground_at(at);
    float distance_m = length(rel);
    float shows = wd_canopy_shows(push.range_m, push.fade, distance_m);
    if (shows <= 0.0)
        return;
    vec3 ray = rel / distance_m;
    float facing = facing_of(at, rel, ray);
    /* the ray meets the canopy before it would meet the ground */
    vec3 met = rel - ray * min(0.7 * push.canopy_m / max(facing, 0.1), 0.1 * distance_m);
    float lod = log2(max(distance_m * push.pixel_rad / push.cover_texel_m, 1e-3));
    vec2 local_m = met.xy + push.camera_m;
    float cover = textureLod(cover_map, local_m * push.cover_scale, lod).x;
    uint random = wd_hash2(slot, frame.sample_index);
    if (wd_hash_unit(random) >= shows * wd_canopy_hides(cover, push.aspect, facing))
        return;
    random = wd_hash1(random);
    uint tree = tree_near(local_m, random >> 4);
    if (tree != ~0u)
        canopy[slot] = canopy_of(tree, ray, random);
}
