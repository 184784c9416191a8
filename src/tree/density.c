#include "tree/density.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

#define EXTINCTION 0.5f
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
        cell_m = wd_maxf(cell_m, extent[axis] / (MAX_SIDE - 4));
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

/* Along one axis: `lines` runs of `inner` neighbours in memory, `count` steps of `inner` each. */
static void blur_axis(float *area, const float *old, size_t lines, size_t count, size_t inner)
{
    for (size_t line = 0; line < lines; line++)
        for (size_t at = 0; at < count; at++) {
            size_t first = (line * count + at) * inner;
            const float *here = old + first;
            const float *before = at > 0 ? here - inner : NULL;
            const float *after = at + 1 < count ? here + inner : NULL;
            for (size_t i = 0; i < inner; i++)
                area[first + i] = 0.5f * here[i] + 0.25f * (before ? before[i] : 0) +
                                  0.25f * (after ? after[i] : 0);
        }
}

void wd_tree_density_blur(struct wd_tree_density *density)
{
    size_t x = (size_t)density->size[0], y = (size_t)density->size[1];
    size_t z = (size_t)density->size[2], count = x * y * z;
    float *old = wd_alloc_array(count, sizeof *old);
    const size_t shapes[3][3] = {{y * z, x, 1}, {z, y, x}, {1, z, x * y}};
    for (int axis = 0; axis < 3; axis++) {
        memcpy(old, density->area, count * sizeof *old);
        blur_axis(density->area, old, shapes[axis][0], shapes[axis][1], shapes[axis][2]);
    }
    free(old);
}

/* exp(-x) for x >= 0, to 3e-7 of its value: a power of two and a polynomial of what is left, without
 * a branch, so that several cells are done at a time. */
static inline float exp_minus(float x)
{
    float turns = -1.44269504f * (x < 80 ? x : 80);
    int32_t power = (int32_t)(turns - 0.5f);
    float rest = 0.693147181f * (turns - (float)power);
    float sum = 1 + rest * (1.0f / 6);
    sum = 1 + rest * 0.2f * sum;
    sum = 1 + rest * 0.25f * sum;
    sum = 1 + rest * (1.0f / 3) * sum;
    sum = 1 + rest * 0.5f * sum;
    sum = 1 + rest * sum;
    uint32_t bits = (uint32_t)(power + 127) << 23;
    float scale;
    memcpy(&scale, &bits, sizeof scale);
    return sum * scale;
}

/* Directions of one steepness: up; 45 degrees; 19 degrees over the horizon. All go up one layer. */
struct cone {
    float length, weight; /* way through a cell in its sides; share of the light, each */
    int count, toward[4][2];
};

enum { CONES = 3, WAYS = 4, BORDER = 2 };

static const struct cone cones[CONES] = {
    {1, 0.28f, 1, {{0, 0}}},
    {1.4142136f, 0.11f, 4, {{1, 0}, {-1, 0}, {0, 1}, {0, -1}}},
    {3, 0.07f, 4, {{2, 2}, {-2, 2}, {2, -2}, {-2, -2}}},
};

/* What leaves the cells of two layers, in turn this one and the one above, a picture for each
 * direction with a border of full light around it. */
struct layers {
    float *pictures; /* [layer & 1][cone][way][row][cell] */
    float *half;     /* what half a cell lets through, of one row */
    size_t stride, size;
};

static void layers_init(struct layers *layers, const struct wd_tree_density *density)
{
    size_t stride = (size_t)density->size[0] + 2 * BORDER;
    size_t size = stride * ((size_t)density->size[1] + 2 * BORDER), all = 2 * CONES * WAYS * size;
    *layers = (struct layers){.pictures = wd_alloc_array(all, sizeof *layers->pictures),
                              .half = wd_alloc_array(stride, sizeof *layers->half),
                              .stride = stride,
                              .size = size};
    for (size_t i = 0; i < all; i++)
        layers->pictures[i] = 1;
}

/* The cell x = 0 of a row. */
static float *layer_row(const struct layers *layers, int z, int cone, int way, int y)
{
    size_t picture = (size_t)(((z & 1) * CONES + cone) * WAYS + way);
    return layers->pictures + picture * layers->size + (size_t)(y + BORDER) * layers->stride +
           BORDER;
}

/* Along a way of `length_m`, of a row that has leaves in [first, end). */
static void fill_half(float *restrict half, const float *restrict area, int size, int first,
                      int end, float length_m)
{
    for (int x = 0; x < size; x++)
        half[x] = 1;
    for (int x = first; x < end; x++)
        half[x] = exp_minus(0.5f * EXTINCTION * length_m * area[x]);
}

/* Light that reaches a cell along one direction is what leaves the cell before it, times what that
 * cell lets through; half of the cell's own leaves shade its middle. */
static void light_row(float *restrict sky, float *restrict here, const float *restrict above,
                      const float *restrict half, int size, float weight)
{
    for (int x = 0; x < size; x++) {
        float light = above[x] * half[x];
        sky[x] += weight * light;
        here[x] = light * half[x];
    }
}

static void light_rows(const struct layers *layers, const struct wd_tree_density *density, int y,
                       int z)
{
    size_t row = cell_index(density, 0, y, z);
    const float *area = density->area + row;
    int size = density->size[0], first = 0, end = size;
    while (first < end && area[first] <= 0)
        first++;
    while (end > first && area[end - 1] <= 0)
        end--;
    for (int c = 0; c < CONES; c++) {
        if (c == 0 || first < end)
            fill_half(layers->half, area, size, first, end, cones[c].length * density->cell_m);
        for (int way = 0; way < cones[c].count; way++) {
            const int *toward = cones[c].toward[way];
            light_row(density->sky + row, layer_row(layers, z, c, way, y),
                      layer_row(layers, z + 1, c, way, y + toward[1]) + toward[0], layers->half,
                      size, cones[c].weight);
        }
    }
}

void wd_tree_density_light(struct wd_tree_density *density)
{
    struct layers layers;
    layers_init(&layers, density);
    memset(density->sky, 0, cell_count(density) * sizeof *density->sky);
    for (int z = density->size[2] - 1; z >= 0; z--)
        for (int y = 0; y < density->size[1]; y++)
            light_rows(&layers, density, y, z);
    free(layers.pictures);
    free(layers.half);
}

struct wd_vec3 wd_tree_density_outward(const struct wd_tree_density *density, struct wd_vec3 p)
{
    int cell[3];
    float share[3], slope[3] = {0};
    if (!locate(density, p, cell, share))
        return WD_V3(0, 0, 0);
    for (int corner = 0; corner < 8; corner++) {
        float value = density->area[corner_index(density, cell, corner)], side[3], weight[3];
        for (int axis = 0; axis < 3; axis++) {
            bool far = corner >> axis & 1;
            weight[axis] = far ? share[axis] : 1 - share[axis];
            side[axis] = far ? -value : value;
        }
        slope[0] += side[0] * weight[1] * weight[2];
        slope[1] += side[1] * weight[0] * weight[2];
        slope[2] += side[2] * weight[0] * weight[1];
    }
    return wd_v3_unit_or(WD_V3(slope[0], slope[1], slope[2]), WD_V3(0, 0, 0));
}
