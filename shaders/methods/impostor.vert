#version 460
/* An octant, or a cell of a cluster, as a sprite whose colour lies between those of the three sides
 * that face the eye, or as these three sides themselves. */
#include "shared/frame.h"
#include "shared/forest.h"
#include "shared/impostor.h"
#include "shared/hash.h"
#include "lib/mixed.glsl"

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 1) readonly buffer Impostors { wd_impostor impostors[]; };
layout(scalar, set = 0, binding = 2) readonly buffer List { uint list[]; };
layout(scalar, push_constant) uniform Push { wd_impostor_push push; };

layout(location = 0) out vec2 out_uv;
layout(location = 1) flat out float out_cover;
layout(location = 2) flat out vec3 out_normal;
layout(location = 3) flat out vec3 out_cells;  /* of noise across and down; z: share of leaves */
layout(location = 4) flat out uvec4 out_flat;  /* first tree, trees, random */
layout(location = 5) flat out vec4 out_leaf;   /* linear; a: sky openness */
layout(location = 6) flat out vec4 out_wood;

vec3 linear_of(vec3 c)
{
    return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(vec3(0.04045), c));
}

struct side_look {
    vec4 leaf, wood; /* colour and openness */
    vec3 normal;
    float leaves, cover; /* share of leaves in what is covered */
};

side_look side_of(wd_octant_look look, uint axis, float toward)
{
    uint side = axis * 2u + (toward > 0.0 ? 0u : 1u);
    vec4 color = unpackUnorm4x8(look.color[side]), normal = unpackUnorm4x8(look.normal[side]);
    float leaves = unpackUnorm4x8(look.leaf[side / 4u])[side % 4u];
    vec4 mean = vec4(linear_of(color.rgb), normal.a);
    return side_look(unmixed(mean, leaves, false, look.mixed[side]), unmixed(mean, leaves, true, look.mixed[side]),
                     normal.xyz * 2.0 - 1.0, leaves, wd_octant_coverage(look.color[side]));
}

/* Each side counts by the area that it shows. Sides that are covered all over are those of a box, whose
 * outlines add; crowns are round, of outlines whose squares add (a spheroid covers pi / 4 of each side
 * of its box), and the trees' own slant tells how far from round. `cover` is in square metres.
 * `boxy`: 0 round, 1 a box; `area`: of the box's outline. */
side_look mixed_sides(wd_octant_look look, vec3 toward, vec3 areas, float area, out float boxy)
{
    side_look sum = side_look(vec4(0.0), vec4(0.0), vec3(0.0), 0.0, 0.0);
    float covered = 0.0, squares[3];
    for (uint axis = 0u; axis < 3u; axis++) {
        side_look side = side_of(look, axis, toward[axis]);
        float weight = abs(toward[axis]) * areas[axis] * side.cover;
        sum.leaf += weight * side.leaves * side.leaf;
        sum.wood += weight * (1.0 - side.leaves) * side.wood;
        sum.normal += weight * side.normal;
        sum.leaves += weight * side.leaves;
        covered += weight;
        squares[axis] = weight * weight;
    }
    sum.leaf /= max(sum.leaves, 1e-6);
    sum.wood /= max(covered - sum.leaves, 1e-6);
    sum.normal /= max(covered, 1e-6);
    sum.leaves /= max(covered, 1e-6);
    /* what would be seen level, from half above and from above, squared */
    float sine = abs(toward.z), slant = wd_octant_slant(look);
    float level = (squares[0] + squares[1]) / max(1.0 - sine * sine, 1e-6);
    float above = squares[2] / max(sine * sine, 1e-6);
    float half_above = 0.5 * slant * slant * (level + above);
    float round_m2 = sqrt(wd_seen_squared(level, half_above, above, sine));
    boxy = clamp((covered / area - 0.785) / 0.215, 0.0, 1.0);
    sum.cover = mix(round_m2, covered, boxy);
    return sum;
}

/* Noise as fine as the picture's pixels, in whole powers of two so that it keeps still. */
float noise_cells(float length_m, float distance_m)
{
    return exp2(max(floor(log2(length_m * push.pixels_per_radian / distance_m)), 0.0));
}

void main()
{
    uint vertices = push.cubes != 0u ? WD_CUBE_VERTICES : WD_SPRITE_VERTICES;
    uint slot = uint(gl_VertexIndex) / vertices, vertex = uint(gl_VertexIndex) - slot * vertices;
    uint index = push.listed != 0u ? list[slot] : push.first + slot;
    wd_impostor impostor = impostors[index];
    vec3 size_m = vec3(impostor.size_m[0], impostor.size_m[1], impostor.size_m[2]);
    vec3 half_m = 0.5 * size_m;
    vec3 eye_m = vec3(frame.camera_mm[0], frame.camera_mm[1], frame.camera_mm[2]) * 0.001
                 + frame.camera_frac_m;
    vec3 center = impostor.min_m + half_m - eye_m;
    float distance_m = max(length(center), 0.1);
    vec3 toward = -center / distance_m;
    vec2 side = vec2(float(vertex & 1u), float((vertex >> 1) & 1u)) * 2.0 - 1.0;
    vec3 rel;
    side_look look;
    vec2 extent_m;
    if (push.cubes != 0u) {
        uint axis = vertex / 4u, next = (axis + 1u) % 3u, last = (axis + 2u) % 3u;
        vec3 corner;
        corner[axis] = toward[axis] > 0.0 ? 1.0 : -1.0;
        corner[next] = side.x;
        corner[last] = side.y;
        rel = center + corner * half_m;
        look = side_of(impostor.look, axis, toward[axis]);
        extent_m = vec2(size_m[next], size_m[last]);
    } else {
        float level = max(length(toward.xy), 1e-4);
        vec3 right = vec3(-toward.y, toward.x, 0.0) / level;
        vec3 up = vec3(-toward.xy * (toward.z / level), level);
        vec2 box = vec2(dot(abs(right), half_m), dot(abs(up), half_m));
        vec2 round = vec2(length(right * half_m), length(up * half_m));
        float boxy;
        look = mixed_sides(impostor.look, toward, size_m.yzx * size_m.zxy, 4.0 * box.x * box.y, boxy);
        vec2 reach = mix(round, box, boxy);
        look.cover = min(look.cover / (4.0 * reach.x * reach.y), 1.0);
        rel = center + right * (side.x * reach.x) - up * (side.y * reach.y);
        /* from the box's near edge at its bottom to the far one at its top: the ground hides none */
        float nearer_m = dot(abs(toward.xy), half_m.xy) - toward.z * half_m.z;
        rel *= 1.0 - nearer_m * side.y / distance_m;
        extent_m = 2.0 * reach;
    }
    out_uv = side * 0.5 + 0.5;
    out_cover = look.cover;
    out_leaf = look.leaf;
    out_wood = look.wood;
    out_normal = look.normal;
    out_cells = vec3(noise_cells(extent_m.x, distance_m), noise_cells(extent_m.y, distance_m),
                     look.leaves);
    out_flat = uvec4(impostor.first_tree, impostor.tree_count, wd_hash2(index, vertex / 4u), 0u);
    gl_Position = look.cover > 0.0 ? frame.clip_from_rel * vec4(rel, 1.0)
                                     : vec4(0.0, 0.0, 0.0, 1.0);
}
