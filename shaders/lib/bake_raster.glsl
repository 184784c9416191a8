/* The triangles of bake_raster*.comp: one thread a triangle, into all pictures of a batch. Triangles
 * of many samples are put on a list, which a second dispatch (LARGE 1) draws with a workgroup each:
 * no thread is left behind with one, and software devices, which end a thread's loops after 65,535
 * turns in all, see each to its end. Expects `draw`, IDENTITY (0 in the pass that makes the list) and
 * LARGE. */
layout(local_size_x = 64) in;

layout(scalar, set = 0, binding = 0) readonly buffer Vertices { wd_tree_vertex vertices[]; };
layout(scalar, set = 0, binding = 1) readonly buffer Indices { uint indices[]; };
layout(scalar, set = 0, binding = 2) readonly buffer Shots { wd_bake_shot shots[]; };
/* Groups of the dispatch, places taken, then triangles and their shots. All begin as 1. */
layout(scalar, set = 0, binding = 4) buffer List {
    uvec3 list_groups;
    uint list_count;
    uvec2 list[];
};
layout(set = 0, binding = 5) uniform sampler2DArray looks;

#include "lib/bake_mesh.glsl"

/* First and last sample of a row that lie inside the triangle, as x; empty where first > last. */
ivec2 row_span(vec2 a, vec2 b, vec2 c, float winding, float y)
{
    float from = -1e9, to = 1e9;
    vec2 p[3] = vec2[3](a, b, c);
    for (int k = 0; k < 3; k++) {
        vec2 edge = (p[(k + 1) % 3] - p[k]) * winding;
        float value = edge.x * (y - p[k].y) + edge.y * p[k].x; /* inside: value >= edge.y * x */
        if (edge.y > 0.0)
            to = min(to, value / edge.y);
        else if (edge.y < 0.0)
            from = max(from, value / edge.y);
        else if (value < 0.0)
            to = -1e9;
    }
    return ivec2(ceil(max(from, -1.0) - 0.5), floor(min(to, 1e6) - 0.5));
}

bake_look look_of(uint triangle, float area)
{
    uvec3 corner = bake_triangle(triangle);
    return bake_look_of(vertices[corner.x], vertices[corner.y], vertices[corner.z], area);
}

/* Rows first, first + step, .. of the triangle's. */
void draw_rows(uint shot_index, uint triangle, vec3 a, vec3 b, vec3 c, ivec2 rows, int step)
{
    float area = bake_area(a, b, c);
    ivec2 size = ivec2(push.width, push.height) * int(push.samples);
    bake_look look;
    if (push.cut_out != 0u)
        look = look_of(triangle, area);
    int row = rows.x, column = 0, last = -1;
    float y = 0.0;
    uint at = 0u;
    /* one loop over all samples: threads whose rows are short need not wait at each for long ones */
    while (column <= last || row <= rows.y) {
        if (column > last) {
            y = float(row) + 0.5;
            ivec2 span = row_span(a.xy, b.xy, c.xy, area > 0.0 ? 1.0 : -1.0, y);
            column = max(span.x, 0);
            last = min(span.y, size.x - 1);
            at = (shot_index * uint(size.y) + uint(row)) * uint(size.x);
            row += step;
        }
        if (column <= last) {
            vec2 shares = bake_shares(a, b, c, area, vec2(float(column) + 0.5, y));
            precise float depth = a.z + shares.x * (b.z - a.z) + shares.y * (c.z - a.z);
            if (push.cut_out == 0u || bake_look_at(look, shares).a >= WD_LOOK_CUT)
                draw(at + uint(column), clamp(depth, 1e-6, 1.0), triangle);
            column++;
        }
    }
}

/* First and last row that a triangle may touch. */
ivec2 rows_of(vec3 a, vec3 b, vec3 c)
{
    float low = min(a.y, min(b.y, c.y)), high = max(a.y, max(b.y, c.y));
    return ivec2(max(int(ceil(max(low, -1.0) - 0.5)), 0),
                 min(int(floor(min(high, 1e6) - 0.5)), int(push.height * push.samples) - 1));
}

/* Whether a triangle of that many samples is left to the list. Should the list be full, the first
 * pass draws on its own and the second pass, which cannot tell which, draws all. */
bool listed(uint shot_index, uint triangle)
{
    if (IDENTITY != 0u)
        return list_count <= WD_BAKE_LIST;
    uint place = atomicAdd(list_count, 1u);
    if (place >= WD_BAKE_LIST)
        return false;
    list[place] = uvec2(triangle, shot_index);
    atomicMax(list_groups.x, place + 1u);
    return true;
}

void draw_small(uint shot_index, uint triangle, vec3 a, vec3 b, vec3 c)
{
    if (abs(bake_area(a, b, c)) < 1e-9)
        return;
    ivec2 rows = rows_of(a, b, c);
    float across = max(a.x, max(b.x, c.x)) - min(a.x, min(b.x, c.x));
    if (float(rows.y - rows.x) * across > WD_BAKE_LARGE && listed(shot_index, triangle))
        return;
    draw_rows(shot_index, triangle, a, b, c, rows, 1);
}

void draw_listed()
{
    if (gl_WorkGroupID.x == 0u)
        return;
    uvec2 entry = list[gl_WorkGroupID.x];
    wd_bake_shot shot = shots[entry.y];
    uvec3 corner = bake_triangle(entry.x);
    vec3 a = bake_project(shot, vertices[corner.x].position_m);
    vec3 b = bake_project(shot, vertices[corner.y].position_m);
    vec3 c = bake_project(shot, vertices[corner.z].position_m);
    ivec2 rows = rows_of(a, b, c);
    rows.x += int(gl_LocalInvocationID.x);
    draw_rows(entry.y, entry.x, a, b, c, rows, 64);
}

void main()
{
    if (LARGE != 0u) {
        draw_listed();
        return;
    }
    uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    uint triangle = group * 64u + gl_LocalInvocationID.x;
    if (triangle >= push.triangle_count)
        return;
    triangle += push.first_triangle;
    uvec3 corner = bake_triangle(triangle);
    vec3 a = vertices[corner.x].position_m, b = vertices[corner.y].position_m;
    vec3 c = vertices[corner.z].position_m;
    for (uint i = 0u; i < push.shot_count; i++) {
        wd_bake_shot shot = shots[i];
        draw_small(i, triangle, bake_project(shot, a), bake_project(shot, b),
                   bake_project(shot, c));
    }
}
