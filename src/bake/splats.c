#include "bake/splats.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/color.h"
#include "base/memory.h"
#include "tree/points.h"

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

/* Albedo (as square roots) and openness. */
static uint32_t pack_look(const struct wd_tree_point *point)
{
    uint32_t openness = point->albedo >> 25;
    uint32_t packed = openness << 24 | (point->kind & WD_POINT_LEAF ? 0 : WD_SPLAT_WOOD);
    for (int k = 0; k < 3; k++) {
        float albedo = wd_srgb_decode((uint8_t)(point->albedo >> (8 * k)));
        packed |= (uint32_t)wd_unorm_encode(sqrtf(albedo)) << (8 * k);
    }
    return packed;
}

static struct wd_splat pack_splat(const struct wd_tree_point *point,
                                  const struct wd_splat_model *model)
{
    uint32_t axes[3];
    float normal[3];
    for (int k = 0; k < 3; k++)
        axes[k] = unorm16(point->position_m[k], model->min_m[k], model->extent_m[k]);
    uint32_t wood = point->kind & WD_POINT_LEAF ? 0 : WD_SPLAT_Z_WOOD;
    wd_unpack_normal(point->normal, normal);
    return (struct wd_splat){axes[0] | axes[1] << 16,
                             (axes[2] & ~WD_SPLAT_Z_WOOD) | wood | pack_normal8(normal) << 16};
}

static int by_height(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return x < y ? 1 : x > y ? -1 : 0;
}

/* Strata of equal count, keeping the order within each. */
static void divide(struct wd_splats *splats, const struct wd_tree_point *places)
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
        splats->splats[at] = pack_splat(&places[i], &splats->model);
        splats->looks[at] = pack_look(&places[i]);
    }
    free(heights);
}

void wd_splats_init(struct wd_splats *splats, const struct wd_tree_model *model,
                    const uint8_t *looks, uint32_t size)
{
    const struct wd_tree_mesh *mesh = &model->full;
    const struct wd_point_look look = {looks, size};
    struct wd_tree_points points;
    *splats = (struct wd_splats){
        .splats = wd_alloc_array(WD_SPLATS, sizeof *splats->splats),
        .looks = wd_alloc_array(WD_SPLATS, sizeof *splats->looks),
    };
    for (int k = 0; k < 3; k++) {
        splats->model.min_m[k] = mesh->min_m[k];
        splats->model.extent_m[k] = fmaxf(mesh->max_m[k] - mesh->min_m[k], 1e-3f);
    }
    if (wd_tree_points_build(&points, mesh, &look, WD_SPLATS)) {
        splats->model.area_m2 = points.leaf_area_m2 + points.wood_area_m2;
        splats->model.wood = points.wood;
        splats->model.leaf = points.leaf;
        divide(splats, points.points);
    }
    wd_tree_points_finish(&points);
}

void wd_splats_finish(struct wd_splats *splats)
{
    free(splats->splats);
    free(splats->looks);
    *splats = (struct wd_splats){0};
}
