#version 460
/* Trees of a patch as billboards that face the eye, back to front (shared/patch_order.h). A
 * patch's table holds, for every cell, where its trees begin, then the trees; once by rows, once by
 * columns. */
#include "shared/frame.h"
#include "shared/forest.h"
#define WD_PATCH_FIRST(cell) first_tree(cell)
uint first_tree(uint cell);
#include "shared/patch_order.h"

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 1) readonly buffer Trees { wd_packed_tree trees[]; };
layout(scalar, set = 0, binding = 2) readonly buffer Models { wd_model models[]; };
layout(scalar, set = 0, binding = 3) readonly buffer Table { uint table[]; };
layout(scalar, set = 0, binding = 6) readonly buffer Fades { wd_layer_fade fades[]; };
/* by layer: billboards are nothing nearer than x, whole beyond y */
layout(scalar, set = 0, binding = 10) readonly buffer Near { vec2 near_m[]; };
layout(scalar, push_constant) uniform Push { wd_patch_push push; };

uint first_tree(uint cell)
{
    return table[push.table + cell];
}

#include "lib/trees.glsl"
#include "lib/tree.glsl"
#include "lib/billboard.glsl"

/* as tree_card.vert */
layout(location = 0) out vec2 out_uv;
layout(location = 1) flat out uvec4 out_card;
layout(location = 2) flat out uvec4 out_more;

/* The tree that is number `place` from the back. */
uint ordered_tree(uint place)
{
    if (push.cells == 0u)
        return table[place];
    uint at = wd_patch_tree(push.cells, push.before_line, push.before_cell, place);
    return table[push.table + push.cells * push.cells + 1u + at];
}

float shown(wd_tree tree, float distance_m)
{
    vec2 near = push.near_scale * near_m[WD_TREE_LAYER(tree)];
    float show = wd_layer_show(fades[WD_TREE_LAYER(tree)], distance_m)
                 * wd_ramp(near.x, near.y, distance_m);
    return push.whole_fades != 0u ? floor(show) : show;
}

void main()
{
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
    uint index = ordered_tree(uint(gl_VertexIndex) / 4u);
    wd_tree tree = tree_at(index);
    wd_model model = models[WD_TREE_SPECIES(tree) * push.light.variants
                            + WD_TREE_VARIANT(tree) % push.light.variants];
    vec3 foot = tree_foot_rel(tree);
    float distance_m = length(foot), show = shown(tree, distance_m);
    if (show <= 0.0)
        return;
    tree_pose pose = tree_pose_of(tree, model);
    vec2 side = vec2(float(gl_VertexIndex & 1), float((gl_VertexIndex >> 1) & 1)) * 2.0 - 1.0;
    vec3 toward = -normalize(foot + vec3(0.0, 0.0, 0.5 * WD_TREE_HEIGHT_M(tree)));
    wd_billboard board = billboard_corner(model, pose, toward, side, false);
    vec3 offset = board.offset
                  + tree_bend(tree_wind(), tree, model.flexibility, max(board.offset.z, 0.0), frame.time_s);

    float tall_px = WD_TREE_HEIGHT_M(tree) * push.pixels_per_radian / distance_m;
    wd_card_flat packed =
        billboard_flat(board, model, pose, tree, show, tall_px, toward.z, index + 1u);
    out_uv = board.uv;
    out_card = uvec4(packed.turn, packed.tint_show, packed.normal, packed.ratio_flags);
    out_more = uvec4(packed.layer_lod, card_noise_shift(tree, foot) | (packed.random_stem & 0xffu), packed.surface, packed.mixed);
    gl_Position = frame.clip_from_rel * vec4(card_over_ground(foot + offset, foot), 1.0);
}
