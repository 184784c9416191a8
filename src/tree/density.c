#include "tree/density.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

#define EXTINCTION 0.5
enum { MAX_SIDE = 160 };

static size_t cell_count(const struct wd_tree_density *density)
{
    return (size_t)density->size[0] * (size_t)density->size[1] * (size_t)density->size[2];
}

static size_t cell_index(const struct wd_tree_density *density, int x, int y, int z)
{
    return (size_t)x + (size_t)density->size[0] *
                           ((size_t)y + (size_t)density->size[1] * (size_t)z);
}

void wd_tree_density_init(struct wd_tree_density *density, struct wd_vec3 low_m,
                          struct wd_vec3 high_m, float cell_m)
{
    float extent[3] = {high_m.x - low_m.x, high_m.y - low_m.y, high_m.z - low_m.z};
    for (int axis = 0; axis < 3; axis++)
        cell_m = fmaxf(cell_m, extent[axis] / (MAX_SIDE - 4));
    *density = (struct wd_tree_density){.cell_m = cell_m};
    density->origin_m = wd_v3_sub(low_m, WD_V3(cell_m, cell_m, cell_m));
    for (int axis = 0; axis < 3; axis++)
        density->size[axis] = (int)(extent[axis] / cell_m) + 3;
    density->area = wd_alloc_array(cell_count(density), sizeof *density->area);
    density->sky = wd_alloc_array(cell_count(density), sizeof *density->sky);
}

void wd_tree_density_finish(struct wd_tree_density *density)
{
    free(density->area);
    free(density->sky);
    *density = (struct wd_tree_density){0};
}

void wd_tree_density_clear(struct wd_tree_density *density)
{
    memset(density->area, 0, cell_count(density) * sizeof *density->area);
}

/* The cell whose middle lies below p on each axis and the shares toward the next ones. */
static bool locate(const struct wd_tree_density *density, struct wd_vec3 p, int cell[3],
                   float share[3])
{
    float at[3] = {(p.x - density->origin_m.x) / density->cell_m - 0.5f,
                   (p.y - density->origin_m.y) / density->cell_m - 0.5f,
                   (p.z - density->origin_m.z) / density->cell_m - 0.5f};
    for (int axis = 0; axis < 3; axis++) {
        if (!(at[axis] >= 0 && at[axis] < (float)(density->size[axis] - 1)))
            return false;
        cell[axis] = (int)at[axis];
        share[axis] = at[axis] - (float)cell[axis];
    }
    return true;
}

static float corner_weight(const float share[3], int corner)
{
    float weight = 1;
    for (int axis = 0; axis < 3; axis++)
        weight *= corner >> axis & 1 ? share[axis] : 1 - share[axis];
    return weight;
}

static size_t corner_index(const struct wd_tree_density *density, const int cell[3], int corner)
{
    return cell_index(density, cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1),
                      cell[2] + (corner >> 2 & 1));
}

void wd_tree_density_add(struct wd_tree_density *density, struct wd_vec3 p, float area_m2)
{
    int cell[3];
    float share[3], volume = density->cell_m * density->cell_m * density->cell_m;
    if (!locate(density, p, cell, share))
        return;
    for (int corner = 0; corner < 8; corner++)
        density->area[corner_index(density, cell, corner)] +=
            corner_weight(share, corner) * area_m2 / volume;
}

static float sample(const struct wd_tree_density *density, const float *values, struct wd_vec3 p,
                    float outside)
{
    int cell[3];
    float share[3], sum = 0;
    if (!locate(density, p, cell, share))
        return outside;
    for (int corner = 0; corner < 8; corner++)
        sum += corner_weight(share, corner) * values[corner_index(density, cell, corner)];
    return sum;
}

float wd_tree_density_at(const struct wd_tree_density *density, struct wd_vec3 p)
{
    return sample(density, density->area, p, 0);
}

float wd_tree_density_sky(const struct wd_tree_density *density, struct wd_vec3 p)
{
    return sample(density, density->sky, p, 1);
}

static void blur_axis(struct wd_tree_density *density, int axis, float *old)
{
    size_t stride[3] = {1, (size_t)density->size[0],
                        (size_t)density->size[0] * (size_t)density->size[1]};
    size_t count = cell_count(density), step = stride[axis];
    memcpy(old, density->area, count * sizeof *old);
    for (size_t i = 0; i < count; i++) {
        size_t at = i / step % (size_t)density->size[axis];
        float before = at > 0 ? old[i - step] : 0;
        float after = at + 1 < (size_t)density->size[axis] ? old[i + step] : 0;
        density->area[i] = 0.25f * before + 0.5f * old[i] + 0.25f * after;
    }
}

void wd_tree_density_blur(struct wd_tree_density *density)
{
    float *old = wd_alloc_array(cell_count(density), sizeof *old);
    for (int axis = 0; axis < 3; axis++)
        blur_axis(density, axis, old);
    free(old);
}

/* What half a cell lets through along a way of `length_m`. */
static void fill_transmission(const struct wd_tree_density *density, float length_m, float *half)
{
    size_t count = cell_count(density);
    for (size_t i = 0; i < count; i++) {
        double depth = 0.5 * EXTINCTION * (double)(density->area[i] * length_m);
        half[i] = depth > 0 ? (float)wd_dexp(-depth) : 1;
    }
}

/* Light that reaches a cell along one direction is what leaves the cell before it, times what that
 * cell lets through; half of the cell's own leaves shade its middle. */
static void sweep(struct wd_tree_density *density, float *light, const float *half,
                  const int toward[3], float weight)
{
    const int *size = density->size;
    for (int z = size[2] - 1; z >= 0; z--)
        for (int y = 0; y < size[1]; y++)
            for (int x = 0; x < size[0]; x++) {
                int nx = x + toward[0], ny = y + toward[1], nz = z + toward[2];
                size_t i = cell_index(density, x, y, z);
                float in = 1;
                if (nx >= 0 && ny >= 0 && nx < size[0] && ny < size[1] && nz < size[2])
                    in = light[cell_index(density, nx, ny, nz)];
                density->sky[i] += weight * in * half[i];
                light[i] = in * half[i] * half[i];
            }
}

/* Directions of one steepness: up; 45 degrees; 19 degrees over the horizon. */
struct cone {
    float length, weight; /* way through a cell in its sides; share of the light, each */
    int count, toward[4][3];
};

void wd_tree_density_light(struct wd_tree_density *density)
{
    static const struct cone cones[3] = {
        {1, 0.28f, 1, {{0, 0, 1}}},
        {1.4142136f, 0.11f, 4, {{1, 0, 1}, {-1, 0, 1}, {0, 1, 1}, {0, -1, 1}}},
        {3, 0.07f, 4, {{2, 2, 1}, {-2, 2, 1}, {2, -2, 1}, {-2, -2, 1}}},
    };
    float *light = wd_alloc_array(cell_count(density), sizeof *light);
    float *half = wd_alloc_array(cell_count(density), sizeof *half);
    memset(density->sky, 0, cell_count(density) * sizeof *density->sky);
    for (int c = 0; c < 3; c++) {
        fill_transmission(density, cones[c].length * density->cell_m, half);
        for (int way = 0; way < cones[c].count; way++)
            sweep(density, light, half, cones[c].toward[way], cones[c].weight);
    }
    free(light);
    free(half);
}

struct wd_vec3 wd_tree_density_outward(const struct wd_tree_density *density, struct wd_vec3 p)
{
    float d = density->cell_m, slope[3];
    struct wd_vec3 steps[3] = {WD_V3(d, 0, 0), WD_V3(0, d, 0), WD_V3(0, 0, d)};
    for (int axis = 0; axis < 3; axis++)
        slope[axis] = wd_tree_density_at(density, wd_v3_sub(p, steps[axis])) -
                      wd_tree_density_at(density, wd_v3_add(p, steps[axis]));
    return wd_v3_unit_or(WD_V3(slope[0], slope[1], slope[2]), WD_V3(0, 0, 0));
}
