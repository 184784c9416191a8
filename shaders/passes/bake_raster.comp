#version 460
/* Rasterises a tree's triangles into all pictures of a batch: one thread a triangle. IDENTITY 0
 * finds the nearest and the farthest surface and counts leaves; 1 then finds whose the nearest is. */
#include "shared/bake.h"
#include "shared/tree.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint IDENTITY = 0u;

layout(scalar, set = 0, binding = 0) readonly buffer Vertices { wd_tree_vertex vertices[]; };
layout(scalar, set = 0, binding = 1) readonly buffer Indices { uint indices[]; };
layout(scalar, set = 0, binding = 2) readonly buffer Shots { wd_bake_shot shots[]; };
layout(scalar, set = 0, binding = 3) buffer Samples { wd_bake_sample samples[]; };
layout(scalar, push_constant) uniform Push { wd_bake_push push; };

#include "lib/bake_mesh.glsl"

void draw(uint at, float depth, uint triangle)
{
    uint bits = floatBitsToUint(depth);
    if (IDENTITY != 0u) {
        if (samples[at].front == bits)
            atomicMax(samples[at].triangle, triangle + 1u);
        return;
    }
    atomicMax(samples[at].front, bits);
    atomicMax(samples[at].back, ~bits);
    if (triangle >= push.wood_triangles)
        atomicAdd(samples[at].sheets, 1u);
}

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

void draw_triangle(uint shot_index, uint triangle, vec3 a, vec3 b, vec3 c)
{
    float area = bake_area(a, b, c);
    if (abs(area) < 1e-9)
        return;
    ivec2 size = ivec2(push.width, push.height) * int(push.samples);
    float low = min(a.y, min(b.y, c.y)), high = max(a.y, max(b.y, c.y));
    int first_row = max(int(ceil(max(low, -1.0) - 0.5)), 0);
    int last_row = min(int(floor(min(high, 1e6) - 0.5)), size.y - 1);
    for (int row = first_row; row <= last_row; row++) {
        float y = float(row) + 0.5;
        ivec2 span = row_span(a.xy, b.xy, c.xy, area > 0.0 ? 1.0 : -1.0, y);
        span = ivec2(max(span.x, 0), min(span.y, size.x - 1));
        uint at = (shot_index * uint(size.y) + uint(row)) * uint(size.x);
        for (int column = span.x; column <= span.y; column++) {
            vec2 shares = bake_shares(a, b, c, area, vec2(float(column) + 0.5, y));
            precise float depth = a.z + shares.x * (b.z - a.z) + shares.y * (c.z - a.z);
            draw(at + uint(column), clamp(depth, 1e-6, 1.0), triangle);
        }
    }
}

void main()
{
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
        draw_triangle(i, triangle, bake_project(shot, a), bake_project(shot, b),
                      bake_project(shot, c));
    }
}
