#version 460
/* Trees as cards in pictures of octants, two triangles each. */
#include "shared/forest.h"
#include "shared/octant.h"

layout(scalar, set = 0, binding = 0) readonly buffer Trees { wd_packed_tree trees[]; };
layout(scalar, set = 0, binding = 1) readonly buffer Models { wd_model models[]; };
layout(scalar, set = 0, binding = 2) readonly buffer Pictures { wd_octant_picture pictures[]; };
layout(scalar, set = 0, binding = 3) readonly buffer Entries { wd_octant_entry entries[]; };
layout(scalar, push_constant) uniform Push { wd_octant_push push; };

#include "lib/trees.glsl"
#include "lib/octant.glsl"

layout(location = 0) out vec2 out_place;
layout(location = 1) flat out uvec2 out_entry;

void main()
{
    const uint corners[6] = uint[6](0u, 1u, 2u, 2u, 1u, 3u);
    uint vertex = uint(gl_VertexIndex), corner = corners[vertex % 6u];
    wd_octant_entry entry = entries[push.first_entry + vertex / 6u];
    octant_tree t = octant_tree_of(entry.tree, entry.picture);
    vec4 box = octant_rectangle(t);
    vec2 place = vec2((corner & 1u) != 0u ? box.z : box.x, (corner & 2u) != 0u ? box.w : box.y);
    uint tile = t.picture.tile;
    vec2 within = vec2(place.x, t.picture.size_m - place.y) / t.picture.size_m;
    vec2 at = vec2(tile % push.tile_columns, tile / push.tile_columns) + within;
    out_place = place;
    out_entry = uvec2(entry.tree, entry.picture);
    gl_Position = vec4(at / float(push.tile_columns) * 2.0 - 1.0, 0.5, 1.0);
}
