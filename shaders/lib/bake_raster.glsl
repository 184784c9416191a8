/* The triangles of bake_raster*.comp: one thread a triangle, into one picture of a batch. Triangles
 * of many samples are put on a list, which a second dispatch (LARGE 1) draws with a workgroup each:
 * no thread is left behind with one, and software devices, which end a thread's loops after 65,535
 * turns in all, see each to its end. Expects `draw`, IDENTITY (0 in the pass that makes the list),
 * LARGE and CUT_OUT (1: texels of the look below WD_LOOK_CUT are holes). */
layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer vertices;
layout(set = 0, binding = 1) uniform usamplerBuffer indices;
layout(scalar, set = 0, binding = 4) buffer List {
    /* Groups of the dispatch, places taken, then triangles and their shots. All begin as 1. */
    uvec3 list_groups;
    uint list_count;
    uvec2 list[];
};
layout(set = 0, binding = 5) uniform sampler2DArray looks;
layout(scalar, set = 0, binding = 6) readonly buffer Shots { wd_bake_shot shots[]; };

#include "lib/bake_mesh.glsl"

/* A triangle of a picture. */
struct raster {
    vec3 a, b, c;
    float area;
    vec2 top, middle, bottom;                  /* the corners from above */
    float long_slope, upper_slope, lower_slope; /* samples right for each one down: the long edge, and
                                                   the two beside it */
    ivec2 first, last;                         /* samples that it may touch */
};

raster raster_of(vec3 a, vec3 b, vec3 c)
{
    raster r;
    r.a = a;
    r.b = b;
    r.c = c;
    r.area = bake_area(a, b, c);
    bool swap = a.y > b.y;
    vec2 upper = swap ? b.xy : a.xy, lower = swap ? a.xy : b.xy;
    r.top = c.y < upper.y ? c.xy : upper;
    r.bottom = c.y > lower.y ? c.xy : lower;
    r.middle = c.y < upper.y ? upper : c.y > lower.y ? lower : c.xy;
    const float least = 1e-12;
    r.long_slope = (r.bottom.x - r.top.x) / max(r.bottom.y - r.top.y, least);
    r.upper_slope = (r.middle.x - r.top.x) / max(r.middle.y - r.top.y, least);
    r.lower_slope = (r.bottom.x - r.middle.x) / max(r.bottom.y - r.middle.y, least);
    vec2 low = min(a.xy, min(b.xy, c.xy)), high = max(a.xy, max(b.xy, c.xy));
    ivec2 size = ivec2(push.width, push.height) * int(push.samples);
    r.first = max(ivec2(ceil(max(low, -1.0) - 0.5)), 0);
    r.last = min(ivec2(floor(min(high, 1e6) - 0.5)), size - 1);
    return r;
}

/* First and last sample of a row that lie inside; none where first > last. */
ivec2 row_span(raster r, int row)
{
    float y = float(row) + 0.5;
    float x = r.top.x + r.long_slope * (y - r.top.y);
    float other = y < r.middle.y ? r.top.x + r.upper_slope * (y - r.top.y)
                                 : r.middle.x + r.lower_slope * (y - r.middle.y);
    return ivec2(ceil(clamp(min(x, other), -1.0, 1e6) - 0.5),
                 floor(clamp(max(x, other), -1.0, 1e6) - 0.5));
}

/* Bits of the samples from `corner` on that lie inside: `rows` rows of `columns`, at most 32. */
uint inside_of(raster r, ivec2 corner, int columns, int rows)
{
    uint bits = 0u;
    int end = min(rows, r.last.y - corner.y + 1);
    for (int row = 0; row < end; row++) {
        ivec2 span = row_span(r, corner.y + row) - corner.x;
        span = ivec2(max(span.x, 0), min(span.y, min(columns - 1, r.last.x - corner.x)));
        if (span.x <= span.y)
            bits |= (~0u >> (31 - (span.y - span.x))) << (row * columns + span.x);
    }
    return bits;
}

/* Draws blocks of at most 32 samples: of the rows of blocks `from`, `from` + `step`, .. A loop over bits
 * takes as long as the thread with most of them, not as the widest rows of all. */
void draw_blocks(uint shot_index, uint triangle, raster r, int from, int step)
{
    float texels = 0.5 * abs(r.area) / float(push.samples * push.samples);
    bool alike = CUT_OUT == 0u && texels <= WD_BAKE_FLAT_TEXELS; /* a mean would take in holes */
    uint seen = WD_BAKE_SEEN(triangle, r.area < 0.0 ? 1u : 0u, alike ? 1u : 0u);
    precise vec3 ab = r.b - r.a, ac = r.c - r.a;
    precise vec2 slope = vec2(ab.z * ac.y - ac.z * ab.y, ac.z * ab.x - ab.z * ac.x) / r.area;
    float nearest = min(max(r.a.z, max(r.b.z, r.c.z)), 1.0);
    float farthest = max(min(r.a.z, min(r.b.z, r.c.z)), 1e-6);
    int stride = int(push.width * push.samples);
    int picture = int(shot_index) * stride * int(push.height * push.samples);
    int columns = clamp(r.last.x - r.first.x + 1, 1, 32);
    int rows = int(32.5 / float(columns)); /* as 32 / columns; but quotients may be a bit too small */
    float row_of_bit = 1.0 / float(columns);
    bake_look look;
    if (CUT_OUT != 0u)
        look = bake_look_of(bake_triangle(triangle), r.area);
    ivec2 corner = ivec2(r.first.x, r.first.y + from * rows);
    while (corner.y <= r.last.y) {
        uint bits = inside_of(r, corner, columns, rows);
        while (bits != 0u) {
            int bit = findLSB(bits);
            bits &= bits - 1u;
            int row = int((float(bit) + 0.5) * row_of_bit);
            ivec2 at = corner + ivec2(bit - row * columns, row);
            precise vec2 off = vec2(at) + 0.5 - r.a.xy;
            precise float depth = r.a.z + slope.x * off.x + slope.y * off.y;
            if (CUT_OUT != 0u) {
                vec2 shares = bake_shares(r.a, r.b, r.c, r.area, vec2(at) + 0.5);
                if (bake_look_at(look, shares).a < WD_LOOK_CUT)
                    continue;
            }
            draw(uint(picture + at.y * stride + at.x), max(min(depth, nearest), farthest), seen);
        }
        corner.x += columns;
        if (corner.x > r.last.x)
            corner = ivec2(r.first.x, corner.y + step * rows);
    }
}

/* Whether a triangle of that many samples is left to the list. Should the list be full, the first
 * pass draws on its own and the second pass, which cannot tell which, draws all. */
bool listed(uint triangle)
{
    if (IDENTITY != 0u)
        return list_count <= WD_BAKE_LIST;
    uint place = atomicAdd(list_count, 1u);
    if (place >= WD_BAKE_LIST)
        return false;
    list[place] = uvec2(triangle, push.shot_index);
    atomicMax(list_groups.x, place + 1u);
    return true;
}

raster project(wd_bake_shot shot, uint triangle)
{
    uvec3 corner = bake_triangle(triangle);
    return raster_of(bake_project(shot, bake_position(corner.x)),
                     bake_project(shot, bake_position(corner.y)),
                     bake_project(shot, bake_position(corner.z)));
}

void draw_small()
{
    uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    uint triangle = group * 64u + gl_LocalInvocationID.x;
    if (triangle >= push.triangle_count)
        return;
    triangle += push.first_triangle;
    raster r = project(push.shot, triangle);
    ivec2 across = r.last - r.first + 1;
    if (any(lessThan(across, ivec2(1))) || abs(r.area) < 1e-9)
        return;
    if (float(across.x) * float(across.y) > WD_BAKE_LARGE && listed(triangle))
        return;
    draw_blocks(push.shot_index, triangle, r, 0, 1);
}

void draw_listed()
{
    if (gl_WorkGroupID.x == 0u)
        return;
    uvec2 entry = list[gl_WorkGroupID.x];
    draw_blocks(entry.y, entry.x, project(shots[entry.y], entry.x), int(gl_LocalInvocationID.x),
                64);
}

void main()
{
    if (LARGE != 0u)
        draw_listed();
    else
        draw_small();
}
