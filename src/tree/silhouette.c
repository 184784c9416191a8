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

static float least(float a, float b, float c)
{
    float ab = a < b ? a : b;
    return ab < c ? ab : c;
}

static float most(float a, float b, float c)
{
    float ab = a > b ? a : b;
    return ab > c ? ab : c;
}

typedef float four_floats __attribute__((vector_size(16)));
typedef int32_t four_ints __attribute__((vector_size(16)));
typedef uint8_t four_bytes __attribute__((vector_size(4)));

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

/* Four pixels at a time; what lies beyond x1 is left as it is. */
static void cover_row(uint8_t *row, const struct edge edges[3], float y, int x0, int x1)
{
    for (int x = x0; x < x1; x += 4) {
        four_ints at = {x, x + 1, x + 2, x + 3};
        four_floats middles = __builtin_convertvector(at, four_floats) + 0.5f;
        four_ints inside = is_inside(&edges[0], middles, y) & is_inside(&edges[1], middles, y) &
                           is_inside(&edges[2], middles, y) & (at < x1);
        four_bytes covered;
        memcpy(&covered, row + x, sizeof covered);
        covered |= __builtin_convertvector(inside, four_bytes) & 1;
        memcpy(row + x, &covered, sizeof covered);
    }
}

/* A triangle that reaches over the middles of pixels [x0, x1) x [y0, y1). */
struct box {
    const float *corners[3];
    int x0, x1, y0, y1;
};

static struct box box_of(const float a[2], const float b[2], const float c[2])
{
    return (struct box){
        .corners = {a, b, c},
        .x0 = wd_silhouette_pixel(least(a[0], b[0], c[0])),
        .x1 = wd_silhouette_pixel(most(a[0], b[0], c[0])),
        .y0 = wd_silhouette_pixel(least(a[1], b[1], c[1])),
        .y1 = wd_silhouette_pixel(most(a[1], b[1], c[1])),
    };
}

static void cover_box(uint8_t *covered, const struct box *box)
{
    const float *a = box->corners[0], *b = box->corners[1], *c = box->corners[2];
    float area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    if (!(fabsf(area) > 1e-9f))
        return;
    float turn = area > 0 ? 1 : -1;
    const struct edge edges[3] = {edge_of(a, b, turn), edge_of(b, c, turn), edge_of(c, a, turn)};
    for (int y = box->y0; y < box->y1; y++)
        cover_row(covered + y * WD_SILHOUETTE, edges, (float)y + 0.5f, box->x0, box->x1);
}

/* Most triangles are small, and many lie between the middles of pixels: these are sorted out a
 * batch at a time, without a branch to be guessed. */
static void cover_triangles(uint8_t *covered, float (*at)[2], const uint32_t *indices,
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
            cover_box(covered, &boxes[n]);
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
    float(*at)[2] = wd_alloc_array((size_t)high + 1, sizeof *at);
    for (uint32_t i = low; i <= high; i++)
        wd_silhouette_project(silhouette, mesh->vertices[i].position_m, at[i]);
    cover_triangles(silhouette->covered, at, mesh->indices + first, end - first);
    free(at);
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
