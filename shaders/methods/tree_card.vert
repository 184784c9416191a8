#version 460
/* A tree as crossed billboards. LISTED 0: vertex index / 12 (or 8) is the tree, so that any range in octree
 * order is one draw; LISTED 1: it is an index into the instances. SHADOW: one card that faces
 * the sun. */
#include "shared/frame.h"
#include "shared/forest.h"

layout(constant_id = 0) const uint SHADOW = 0u;
layout(constant_id = 1) const uint LISTED = 0u;

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 1) readonly buffer Trees { wd_packed_tree trees[]; };
layout(scalar, set = 0, binding = 2) readonly buffer Models { wd_model models[]; };
layout(scalar, set = 0, binding = 3) readonly buffer Instances { wd_instance instances[]; };
layout(scalar, set = 0, binding = 6) readonly buffer Fades { wd_layer_fade fades[]; };
layout(scalar, push_constant) uniform Push { wd_tree_push push; };

#include "lib/trees.glsl"
#include "lib/tree.glsl"
#include "lib/card_corner.glsl"

layout(location = 0) out vec2 out_uv;
layout(location = 1) flat out uvec4 out_card; /* turn, tint_show, normal, ratio_flags */
layout(location = 2) flat out uvec4 out_more; /* layer_lod, random_stem, surface, mixed */

void main()
{
    uint per_tree = SHADOW != 0u ? WD_SHADOW_CARD_VERTICES : push.card_vertices;
    uint slot = uint(gl_VertexIndex) / per_tree, vertex = uint(gl_VertexIndex) - slot * per_tree;
    uint index = slot;
    float show = push.show;
    if (LISTED != 0u) {
        index = instances[slot].tree;
        show = instances[slot].show;
    }
    wd_tree tree = tree_at(index);
    card_tree t = card_tree_of(tree, models[WD_TREE_SPECIES(tree) * push.variants
                                            + WD_TREE_VARIANT(tree) % push.variants]);
    card_frame card = card_at(t, vertex / 4u);
    vec2 side = vec2(float(vertex & 1u), float((vertex >> 1) & 1u)) * 2.0 - 1.0;
    wd_card_flat constants = card_constants(t, card, index, show);
    out_uv = card_picture_uv(side * 0.5 + 0.5, card_lies(t.model));
    out_card = uvec4(constants.turn, constants.tint_show, constants.normal, constants.ratio_flags);
    out_more = uvec4(constants.layer_lod, constants.random_stem, constants.surface, constants.mixed);
    bool shows = show * t.show * card.share > 0.0;
    gl_Position = shows ? card_clip(t, card, side) : vec4(0.0, 0.0, 0.0, 1.0);
}
