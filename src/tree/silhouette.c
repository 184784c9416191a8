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
                                         .covered = wd_alloc(WD_SILHOUETTE * WD_SILHOUETTE)};
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

static void cover_triangle(uint8_t *covered, const float a[2], const float b[2], const float c[2])
{
    float area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    int x0 = wd_silhouette_pixel(least(a[0], b[0], c[0]));
    int x1 = wd_silhouette_pixel(most(a[0], b[0], c[0]));
    int y0 = wd_silhouette_pixel(least(a[1], b[1], c[1]));
    int y1 = wd_silhouette_pixel(most(a[1], b[1], c[1]));
    if (x0 >= x1 || y0 >= y1 || !(fabsf(area) > 1e-9f))
        return;
    float turn = area > 0 ? 1 : -1;
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) {
            float px = (float)x + 0.5f, py = (float)y + 0.5f;
            float u = (b[0] - a[0]) * (py - a[1]) - (b[1] - a[1]) * (px - a[0]);
            float v = (c[0] - b[0]) * (py - b[1]) - (c[1] - b[1]) * (px - b[0]);
            float w = (a[0] - c[0]) * (py - c[1]) - (a[1] - c[1]) * (px - c[0]);
            covered[y * WD_SILHOUETTE + x] |= (u * turn >= 0) & (v * turn >= 0) & (w * turn >= 0);
        }
}

void wd_silhouette_cover(struct wd_silhouette *silhouette, const struct wd_tree_mesh *mesh,
                         uint32_t first, uint32_t end)
{
    float(*at)[2] = wd_alloc_array((size_t)mesh->vertex_count + 1, sizeof *at);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        wd_silhouette_project(silhouette, mesh->vertices[i].position_m, at[i]);
    for (uint32_t i = first; i + 2 < end; i += 3)
        cover_triangle(silhouette->covered, at[mesh->indices[i]], at[mesh->indices[i + 1]],
                       at[mesh->indices[i + 2]]);
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
