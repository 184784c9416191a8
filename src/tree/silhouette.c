#include "tree/silhouette.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

void wd_silhouette_init(struct wd_silhouette *silhouette, const struct wd_tree_mesh *frame,
                        struct wd_vec3 toward)
{
    struct wd_vec3 middle = WD_V3(0.5f * (frame->min_m[0] + frame->max_m[0]),
                                  0.5f * (frame->min_m[1] + frame->max_m[1]),
                                  0.5f * (frame->min_m[2] + frame->max_m[2]));
    float x = frame->max_m[0] - frame->min_m[0], y = frame->max_m[1] - frame->min_m[1];
    float tall = frame->max_m[2] - frame->min_m[2];
    float half = 0.5f * fmaxf(fmaxf(sqrtf(x * x + y * y), tall), 2e-3f);
    struct wd_vec3 right = wd_v3_side(toward);
    *silhouette = (struct wd_silhouette){.right = right, .up = wd_v3_cross(right, toward),
                                         .toward = toward,
                                         .scale = 0.5f * (WD_SILHOUETTE - 2) / half,
                                         .covered = wd_alloc(WD_SILHOUETTE * WD_SILHOUETTE + 3)};
    silhouette->low[0] = wd_v3_dot(middle, right) - half - 1 / silhouette->scale;
    silhouette->low[1] = wd_v3_dot(middle, silhouette->up) - half - 1 / silhouette->scale;
}

void wd_silhouette_finish(struct wd_silhouette *silhouette)
{
    free(silhouette->covered);
    *silhouette = (struct wd_silhouette){0};
}

void wd_silhouette_project(const struct wd_silhouette *silhouette, const float p[3], float at[2])
{
    struct wd_vec3 v = WD_V3(p[0], p[1], p[2]);
    at[0] = (wd_v3_dot(v, silhouette->right) - silhouette->low[0]) * silhouette->scale;
    at[1] = (wd_v3_dot(v, silhouette->up) - silhouette->low[1]) * silhouette->scale;
}

typedef float four_floats __attribute__((vector_size(16)));
typedef int32_t four_ints __attribute__((vector_size(16)));

static four_floats choose(four_ints where, four_floats a, four_floats b)
{
    return (four_floats)((where & (four_ints)a) | (~where & (four_ints)b));
}

static four_floats least(four_floats a, four_floats b)
{
    return choose(a < b, a, b);
}

static four_floats most(four_floats a, four_floats b)
{
    return choose(a > b, a, b);
}

/* Points p with cross(way, p - from) * turn >= 0 lie inside. */
struct edge {
    float from[2], way[2], turn;
};

static struct edge edge_of(const float from[2], const float to[2], float turn)
{
    return (struct edge){{from[0], from[1]}, {to[0] - from[0], to[1] - from[1]}, turn};
}

static four_ints is_inside(const struct edge *edge, four_floats x, float y)
{
    float across = edge->way[0] * (y - edge->from[1]);
    return (across - edge->way[1] * (x - edge->from[0])) * edge->turn >= 0;
}

/* Four pixels at a time, those inside of a row. */
static four_ints inside_row(const struct edge edges[3], four_ints at, float y, int x1)
{
    four_floats middles = __builtin_convertvector(at, four_floats) + 0.5f;
    return is_inside(&edges[0], middles, y) & is_inside(&edges[1], middles, y) &
           is_inside(&edges[2], middles, y) & (at < x1);
}

/* What lies beyond x1 is left as it is. */
static void cover_row(uint8_t *row, const struct edge edges[3], float y, int x0, int x1)
{
    for (int x = x0; x < x1; x += 4) {
        four_ints at = {x, x + 1, x + 2, x + 3}, inside = inside_row(edges, at, y, x1);
        uint64_t pairs[2];
        uint32_t covered;
        memcpy(pairs, &inside, sizeof pairs);
        memcpy(&covered, row + x, sizeof covered);
        covered |= (uint32_t)((pairs[0] & 1) | (pairs[0] >> 24 & 0x100) | (pairs[1] & 1) << 16 |
                              (pairs[1] >> 8 & 0x1000000));
        memcpy(row + x, &covered, sizeof covered);
    }
}

/* Distance over the picture: at pixel 0, more a pixel right, and at most: what slivers have beyond
 * that is error. */
static void bring_row(float *row, const struct edge edges[3], float y, int x0, int x1,
                      const float distance[3])
{
    for (int x = x0; x < x1; x += 4) {
        four_ints at = {x, x + 1, x + 2, x + 3}, inside = inside_row(edges, at, y, x1);
        four_floats own = distance[0] + distance[1] * __builtin_convertvector(at, four_floats);
        four_floats front;
        memcpy(&front, row + x, sizeof front);
        front = choose(inside & (own > front) & (own <= distance[2]), own, front);
        memcpy(row + x, &front, sizeof front);
    }
}

/* A triangle that reaches over the middles of pixels [x0, x1) x [y0, y1). */
struct box {
    const float *corners[3];
    int x0, x1, y0, y1;
};

/* First pixels whose middle is at x or beyond, within the picture; 0 for NaN. */
static inline four_ints pixels(four_floats x)
{
    const four_floats none = {0}, all = none + WD_SILHOUETTE;
    four_floats from = least(choose(x > none, x, none), all) - 0.5f;
    four_ints pixel = __builtin_convertvector(from, four_ints);
    return pixel - (__builtin_convertvector(pixel, four_floats) < from);
}

static inline struct box box_of(const float a[4], const float b[4], const float c[4])
{
    four_floats corners[3];
    memcpy(&corners[0], a, sizeof *corners);
    memcpy(&corners[1], b, sizeof *corners);
    memcpy(&corners[2], c, sizeof *corners);
    four_ints low = pixels(least(least(corners[0], corners[1]), corners[2]));
    four_ints high = pixels(most(most(corners[0], corners[1]), corners[2]));
    return (struct box){{a, b, c}, low[0], high[0], low[1], high[1]};
}

/* Covers the box's triangle, or brings `front` before it. */
static void draw_box(uint8_t *covered, float *front, const struct box *box)
{
    const float *a = box->corners[0], *b = box->corners[1], *c = box->corners[2];
    float bx = b[0] - a[0], by = b[1] - a[1], cx = c[0] - a[0], cy = c[1] - a[1];
    float area = bx * cy - cx * by;
    if (!(fabsf(area) > 1e-9f))
        return;
    float turn = area > 0 ? 1 : -1, over = 1 / area;
    const struct edge edges[3] = {edge_of(a, b, turn), edge_of(b, c, turn), edge_of(c, a, turn)};
    float bz = b[2] - a[2], cz = c[2] - a[2];
    float farthest = wd_maxf(wd_maxf(a[2], b[2]), c[2]);
    float right = (bz * cy - cz * by) * over, down = (cz * bx - bz * cx) * over;
    for (int y = box->y0; y < box->y1; y++) {
        float middle = (float)y + 0.5f;
        const float distance[3] = {a[2] + down * (middle - a[1]) + right * (0.5f - a[0]), right,
                                   farthest};
        if (covered)
            cover_row(covered + y * WD_SILHOUETTE, edges, middle, box->x0, box->x1);
        else
            bring_row(front + y * WD_SILHOUETTE, edges, middle, box->x0, box->x1, distance);
    }
}

/* Most triangles are small, and many lie between the middles of pixels: these are sorted out a
 * batch at a time, without a branch to be guessed. */
static void draw_triangles(uint8_t *covered, float *front, float (*at)[4], const uint32_t *indices,
                           uint32_t count)
{
    enum { BATCH = 256 };
    struct box boxes[BATCH];
    for (uint32_t i = 0; i + 2 < count;) {
        int kept = 0;
        for (int n = 0; n < BATCH && i + 2 < count; n++, i += 3) {
            boxes[kept] = box_of(at[indices[i]], at[indices[i + 1]], at[indices[i + 2]]);
            kept += (boxes[kept].x0 < boxes[kept].x1) & (boxes[kept].y0 < boxes[kept].y1);
        }
        for (int n = 0; n < kept; n++)
            draw_box(covered, front, &boxes[n]);
    }
}

/* Places of the vertices from `low` on. */
static void place_vertices(float (*at)[4], const struct wd_silhouette *silhouette,
                           const struct wd_tree_mesh *mesh, uint32_t low, uint32_t count)
{
    struct wd_vec3 right = wd_v3_scale(silhouette->right, silhouette->scale);
    struct wd_vec3 up = wd_v3_scale(silhouette->up, silhouette->scale);
    float x0 = silhouette->low[0] * silhouette->scale, y0 = silhouette->low[1] * silhouette->scale;
    for (uint32_t i = 0; i < count; i++) {
        struct wd_vec3 p = wd_v3_of(mesh->vertices[low + i].position_m);
        at[i][0] = wd_v3_dot(p, right) - x0;
        at[i][1] = wd_v3_dot(p, up) - y0;
        at[i][2] = wd_v3_dot(p, silhouette->toward);
    }
}

void wd_silhouette_cover(struct wd_silhouette *silhouette, const struct wd_tree_mesh *mesh,
                         uint32_t first, uint32_t end)
{
    uint32_t high = 0, low = UINT32_MAX;
    for (uint32_t i = first; i < end; i++) {
        low = mesh->indices[i] < low ? mesh->indices[i] : low;
        high = mesh->indices[i] > high ? mesh->indices[i] : high;
    }
    if (low > high)
        return;
    float(*at)[4] = wd_alloc_array((size_t)high + 1, sizeof *at);
    place_vertices(at + low, silhouette, mesh, low, high + 1 - low);
    draw_triangles(silhouette->covered, NULL, at, mesh->indices + first, end - first);
    free(at);
}

void wd_silhouette_front(const struct wd_silhouette *silhouette, const struct wd_tree_mesh *mesh,
                         float (*at)[4], float *front)
{
    place_vertices(at, silhouette, mesh, 0, mesh->vertex_count);
    for (size_t i = 0; i < WD_SILHOUETTE * WD_SILHOUETTE; i++)
        front[i] = -INFINITY;
    draw_triangles(NULL, front, at, mesh->indices, mesh->index_count);
}

void wd_silhouette_clear(struct wd_silhouette *silhouette)
{
    memset(silhouette->covered, 0, WD_SILHOUETTE * WD_SILHOUETTE);
}

size_t wd_silhouette_count(const struct wd_silhouette *silhouette)
{
    size_t count = 0;
    for (size_t i = 0; i < WD_SILHOUETTE * WD_SILHOUETTE; i++)
        count += silhouette->covered[i];
    return count;
}
