#version 460
/* From ids in the visibility buffer to surface, once a pixel. */
#include "shared/frame.h"
#include "shared/forest.h"
#include "shared/continuum.h"

layout(scalar, set = 0, binding = 0) readonly buffer Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 1) readonly buffer Pixels { uvec2 pixels[]; };
layout(scalar, set = 0, binding = 2) readonly buffer SplatTrees { wd_splat_tree splat_trees[]; };
layout(scalar, set = 0, binding = 3) readonly buffer Items { wd_splat_item items[]; };
layout(scalar, set = 0, binding = 4) readonly buffer Splats { wd_splat splats[]; };
layout(scalar, set = 0, binding = 5) readonly buffer Looks { uint looks[]; };
layout(scalar, set = 0, binding = 6) readonly buffer Trees { wd_tree trees[]; };
layout(scalar, set = 0, binding = 7) readonly buffer Models { wd_model models[]; };
layout(scalar, push_constant) uniform Push { wd_tree_push push; };

#include "lib/tree.glsl"
#include "lib/splat.glsl"

layout(location = 0) out vec4 out_albedo;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out uint out_surface;

void main()
{
    uvec2 at = uvec2(gl_FragCoord.xy);
    uvec2 seen = pixels[at.y * frame.width + at.x];
    if (seen.x == 0u)
        discard;
    gl_FragDepth = uintBitsToFloat(seen.y);
    uint id = seen.x - 1u;
    wd_splat_item item = items[id / WD_ITEM_SPLATS];
    wd_splat_tree splat_tree = splat_trees[item.tree];
    uint index = splat_index(splat_tree, item.first + id % WD_ITEM_SPLATS);
    wd_tree tree = trees[splat_tree.tree];
    wd_model model = models[WD_TREE_SPECIES(tree) * push.variants
                            + WD_TREE_VARIANT(tree) % push.variants];
    uint look = looks[index];
    bool wood = (look & WD_SPLAT_WOOD) != 0u;
    vec3 albedo = unpackUnorm4x8(look).rgb;
    albedo *= albedo;
    if (!wood)
        albedo *= tree_tint(tree);
    float openness = float(look >> 24 & 0x7fu) * (1.0 / 127.0);
    if (frame.view_mode == WD_MODE_LOD)
        albedo = vec3(0.1, 0.6, 0.15) * (0.3 + 0.7 * openness);
    vec3 normal = tree_normal(tree_pose_of(tree, model), splat_normal(splats[index]));
    out_albedo = vec4(albedo, openness);
    out_normal = vec4(normal * 0.5 + 0.5, float(wood ? WD_MATERIAL_WOOD : WD_MATERIAL_LEAF) / 3.0);
    out_surface = splat_tree.tree + 1u;
}
