#version 460
/* A tree from afar as one picture that faces the eye, of branches and leaves apart (row W6). */
#include "shared/frame.h"
#include "shared/dissolve.h"

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 1) readonly buffer Trees { wd_packed_tree trees[]; };
layout(scalar, set = 0, binding = 2) readonly buffer Models { wd_model models[]; };
layout(scalar, set = 0, binding = 3) readonly buffer Instances { wd_instance instances[]; };
layout(scalar, push_constant) uniform Push { wd_one_view_push push; };

#include "lib/trees.glsl"
#include "lib/tree.glsl"
#include "lib/billboard.glsl"

/* as tree_card.vert */
layout(location = 0) out vec2 out_uv;
layout(location = 1) flat out uvec4 out_card;
layout(location = 2) flat out uvec4 out_more;

void main()
{
    wd_instance instance = instances[gl_VertexIndex / 4];
    wd_tree tree = tree_at(instance.tree);
    wd_model model = models[WD_TREE_SPECIES(tree) * push.variants
                            + WD_TREE_VARIANT(tree) % push.variants];
    vec3 foot = tree_foot_rel(tree);
    tree_pose pose = tree_pose_of(tree, model);
    vec2 side = vec2(float(gl_VertexIndex & 1), float((gl_VertexIndex >> 1) & 1)) * 2.0 - 1.0;
    vec3 toward = -normalize(foot + vec3(0.0, 0.0, 0.5 * WD_TREE_HEIGHT_M(tree)));
    wd_billboard board = billboard_corner(model, pose, toward, side, push.one_view != 0u);
    vec3 offset = board.offset
                  + tree_bend(tree_wind(), tree, model.flexibility, max(board.offset.z, 0.0), frame.time_s);
    float tall_px = WD_TREE_HEIGHT_M(tree) * push.pixels_per_radian / length(foot);
    wd_card_flat packed = billboard_flat(board, model, pose, tree, instance.show, tall_px, toward.z,
                                         instance.tree + 1u);
    out_uv = board.uv;
    out_card = uvec4(packed.turn, packed.tint_show, packed.normal, packed.ratio_flags);
    out_more = uvec4(packed.layer_lod, packed.random_stem, packed.surface, packed.mixed);
    gl_Position = frame.clip_from_rel * vec4(card_over_ground(foot + offset, foot), 1.0);
}
