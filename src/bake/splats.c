#include "bake/splats.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/color.h"
#include "base/memory.h"
#include "shared/hash.h"

/* A sampled place: indices of its triangle's corners and their shares. */
struct place {
    float position_m[3];
    struct wd_splat splat;
    uint32_t look;
};

static void triangle_corners(const struct wd_tree_mesh *mesh, uint32_t triangle,
                             const struct wd_tree_vertex *corners[3])
{
    for (int i = 0; i < 3; i++)
        corners[i] = &mesh->vertices[mesh->indices[3 * triangle + (uint32_t)i]];
}

static double triangle_area(const struct wd_tree_mesh *mesh, uint32_t triangle)
{
    const struct wd_tree_vertex *corners[3];
    triangle_corners(mesh, triangle, corners);
    double a[3], b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = (double)(corners[1]->position_m[k] - corners[0]->position_m[k]);
        b[k] = (double)(corners[2]->position_m[k] - corners[0]->position_m[k]);
    }
    double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2];
    double z = a[0] * b[1] - a[1] * b[0];
    return 0.5 * sqrt(x * x + y * y + z * z);
}

/* sums[i]: area of the triangles before i. */
static double *sum_areas(const struct wd_tree_mesh *mesh)
{
    uint32_t count = mesh->index_count / 3;
    double *sums = wd_alloc_array((size_t)count + 1, sizeof *sums);
    for (uint32_t i = 0; i < count; i++)
        sums[i + 1] = sums[i] + triangle_area(mesh, i);
    return sums;
}

static uint32_t find_triangle(const double *sums, uint32_t count, double area)
{
    uint32_t low = 0, high = count - 1;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (sums[middle + 1] > area)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

static double radical_inverse(uint32_t index)
{
    double result = 0.0, share = 0.5;
    for (; index; index >>= 1, share *= 0.5)
        result += (index & 1) ? share : 0.0;
    return result;
}

static uint32_t texel(const uint8_t *image, uint32_t size, float u, float v)
{
    uint32_t x = (uint32_t)((u - floorf(u)) * (float)size) % size;
    uint32_t y = (uint32_t)((v - floorf(v)) * (float)size) % size;
    uint32_t color;
    memcpy(&color, image + 4 * ((size_t)y * size + x), 4);
    return color;
}

static float half_to_float(uint32_t half)
{
    int exponent = (int)(half >> 10 & 31);
    float mantissa = (float)(half & 1023);
    float value = exponent ? ldexpf(1024.0f + mantissa, exponent - 25) : ldexpf(mantissa, -24);
    return half & 0x8000u ? -value : value;
}

/* Albedo (as square roots) and openness. */
static uint32_t look_at(const struct wd_tree_vertex *corners[3], const float shares[3],
                        const uint8_t *looks, uint32_t size)
{
    bool leaf = corners[0]->kind & WD_VERTEX_LEAF;
    float uv[2] = {0}, tint[4] = {0};
    for (int i = 0; i < 3; i++) {
        uv[0] += shares[i] * half_to_float(corners[i]->uv & 0xffffu);
        uv[1] += shares[i] * half_to_float(corners[i]->uv >> 16);
        for (int k = 0; k < 4; k++)
            tint[k] += shares[i] * (float)(corners[i]->tint >> (8 * k) & 255u) * (1.0f / 255.0f);
    }
    uint32_t color = texel(looks + (leaf ? (size_t)4 * size * size : 0), size, uv[0], uv[1]);
    uint32_t packed = (uint32_t)(tint[3] * 127.0f + 0.5f) << 24 | (leaf ? 0 : WD_SPLAT_WOOD);
    for (int k = 0; k < 3; k++) {
        float albedo = wd_srgb_decode((uint8_t)(color >> (8 * k))) * tint[k];
        packed |= (uint32_t)wd_unorm_encode(sqrtf(albedo)) << (8 * k);
    }
    return packed;
}

static uint32_t pack_normal8(const float normal[3])
{
    float sum = fabsf(normal[0]) + fabsf(normal[1]) + fabsf(normal[2]) + 1e-12f;
    float x = normal[0] / sum, y = normal[1] / sum;
    if (normal[2] < 0.0f) {
        float folded = (1.0f - fabsf(y)) * (x >= 0.0f ? 1.0f : -1.0f);
        y = (1.0f - fabsf(x)) * (y >= 0.0f ? 1.0f : -1.0f);
        x = folded;
    }
    uint32_t a = (uint32_t)(int32_t)lrintf(x * 127.0f) & 255u;
    uint32_t b = (uint32_t)(int32_t)lrintf(y * 127.0f) & 255u;
    return a | b << 8;
}

static uint32_t unorm16(float value, float min, float extent)
{
    float share = (value - min) / extent;
    return (uint32_t)(fminf(fmaxf(share, 0.0f), 1.0f) * 65535.0f + 0.5f);
}

static void sample(struct place *place, const struct wd_splats *splats,
                   const struct wd_tree_mesh *mesh, uint32_t triangle, uint32_t index,
                   const uint8_t *looks, uint32_t size)
{
    const struct wd_tree_vertex *corners[3];
    triangle_corners(mesh, triangle, corners);
    /* evenly over the triangle (Osada et al. 2002) */
    float root = sqrtf(wd_hash_unit(wd_hash2(index, 1))), along = wd_hash_unit(wd_hash2(index, 2));
    const float shares[3] = {1.0f - root, root * (1.0f - along), root * along};
    float normal[3] = {0};
    memset(place->position_m, 0, sizeof place->position_m);
    for (int i = 0; i < 3; i++) {
        float corner[3];
        wd_unpack_normal(corners[i]->normal, corner);
        for (int k = 0; k < 3; k++) {
            place->position_m[k] += shares[i] * corners[i]->position_m[k];
            normal[k] += shares[i] * corner[k];
        }
    }
    uint32_t axes[3];
    for (int k = 0; k < 3; k++)
        axes[k] = unorm16(place->position_m[k], splats->model.min_m[k], splats->model.extent_m[k]);
    place->splat.xy = axes[0] | axes[1] << 16;
    place->splat.z_normal = axes[2] | pack_normal8(normal) << 16;
    place->look = look_at(corners, shares, looks, size);
}

static int by_height(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return x < y ? 1 : x > y ? -1 : 0;
}

/* Strata of equal count, keeping the order within each. */
static void divide(struct wd_splats *splats, const struct place *places)
{
    float *heights = wd_alloc_array(WD_SPLATS, sizeof *heights);
    uint32_t used[WD_SPLAT_STRATA] = {0};
    for (uint32_t i = 0; i < WD_SPLATS; i++)
        heights[i] = places[i].position_m[2];
    qsort(heights, WD_SPLATS, sizeof *heights, by_height);
    for (uint32_t s = 0; s < WD_SPLAT_STRATA; s++)
        splats->model.strata_top_m[s] = heights[s * WD_STRATUM_SPLATS];
    for (uint32_t i = 0; i < WD_SPLATS; i++) {
        uint32_t s = WD_SPLAT_STRATA - 1;
        while (s > 0 && (places[i].position_m[2] > splats->model.strata_top_m[s] ||
                         used[s] == WD_STRATUM_SPLATS))
            s--;
        while (used[s] == WD_STRATUM_SPLATS)
            s++;
        uint32_t at = s * WD_STRATUM_SPLATS + used[s]++;
        splats->splats[at] = places[i].splat;
        splats->looks[at] = places[i].look;
    }
    free(heights);
}

void wd_splats_init(struct wd_splats *splats, const struct wd_tree_model *model,
                    const uint8_t *looks, uint32_t size)
{
    const struct wd_tree_mesh *mesh = &model->full;
    uint32_t triangles = mesh->index_count / 3;
    *splats = (struct wd_splats){
        .splats = wd_alloc_array(WD_SPLATS, sizeof *splats->splats),
        .looks = wd_alloc_array(WD_SPLATS, sizeof *splats->looks),
    };
    double *sums = sum_areas(mesh);
    struct place *places = wd_alloc_array(WD_SPLATS, sizeof *places);
    splats->model.area_m2 = (float)sums[triangles];
    for (int k = 0; k < 3; k++) {
        splats->model.min_m[k] = mesh->min_m[k];
        splats->model.extent_m[k] = fmaxf(mesh->max_m[k] - mesh->min_m[k], 1e-3f);
    }
    for (uint32_t i = 0; i < WD_SPLATS; i++) {
        double area = (radical_inverse(i) + 0.5 / WD_SPLATS) * sums[triangles];
        sample(&places[i], splats, mesh, find_triangle(sums, triangles, area), i, looks, size);
    }
    divide(splats, places);
    free(places);
    free(sums);
}

void wd_splats_finish(struct wd_splats *splats)
{
    free(splats->splats);
    free(splats->looks);
    *splats = (struct wd_splats){0};
}
