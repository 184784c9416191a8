/* What count and expand must agree on: which cards of a chunk's trees stand in the soup. */
#include "shared/frame.h"
#include "shared/forest.h"
#include "shared/card_soup.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint SHADOW = 0u;

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 1) readonly buffer Trees { wd_packed_tree trees[]; };
layout(scalar, set = 0, binding = 2) readonly buffer Models { wd_model models[]; };
layout(scalar, set = 0, binding = 3) readonly buffer Fades { wd_layer_fade fades[]; };
layout(scalar, set = 0, binding = 4) readonly buffer Planes { wd_cull_planes cull; };
layout(scalar, set = 0, binding = 5) readonly buffer Chunks { wd_card_chunk chunks[]; };
layout(scalar, set = 0, binding = 6) buffer Firsts { uint first_card[]; };
layout(scalar, push_constant) uniform Push { wd_card_soup_push push; };

#include "lib/trees.glsl"
#include "lib/tree.glsl"
#include "lib/card_corner.glsl"

uint chunk_index()
{
    uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    return group * 64u + gl_LocalInvocationID.x;
}

uint chunk_trees(wd_card_chunk chunk)
{
    return chunk.trees_slots & 0xffu;
}

uint chunk_slots(wd_card_chunk chunk)
{
    return SHADOW != 0u ? 1u : chunk.trees_slots >> 8;
}

card_tree soup_tree(uint index)
{
    wd_tree tree = tree_at(index);
    return card_tree_of(tree, models[WD_TREE_SPECIES(tree) * push.variants
                                     + WD_TREE_VARIANT(tree) % push.variants]);
}

/* Whether the view may see something of the tree: the sphere round its cards against each plane. */
bool soup_tree_seen(card_tree t)
{
    float half_m = 0.55 * WD_TREE_HEIGHT_M(t.tree);
    float radius = 1.2 * length(vec2(half_m, t.model.half_width_m * t.pose.across)) + 0.1 * half_m;
    vec4 middle = vec4(t.foot + vec3(0.0, 0.0, half_m), 1.0);
    float least = dot(cull.plane[0], middle);
    for (uint i = 1u; i < WD_CULL_PLANES; i++)
        least = min(least, dot(cull.plane[i], middle));
    return t.show > 0.0 && least > -radius;
}
