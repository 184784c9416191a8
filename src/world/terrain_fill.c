/* terrain_fill.c: grids of heights with gaps, and smooth heights between samples. */
#include "world/terrain_parts.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

struct level {
    uint32_t width, height;
    float *values;
    uint8_t *known;
};

static uint64_t count_missing(const float *values, size_t count)
{
    uint64_t missing = 0;
    for (size_t i = 0; i < count; i++)
        missing += isnan(values[i]) != 0;
    return missing;
}

/* The mean of what is known of each 2 x 2 samples. */
static void pull(const struct level *fine, struct level *coarse)
{
    for (uint32_t j = 0; j < fine->height; j++) {
        for (uint32_t i = 0; i < fine->width; i++) {
            size_t from = (size_t)j * fine->width + i;
            if (!fine->known[from])
                continue;
            size_t to = (size_t)(j / 2) * coarse->width + i / 2;
            coarse->known[to]++;
            coarse->values[to] += fine->values[from];
        }
    }
    for (size_t i = 0; i < (size_t)coarse->width * coarse->height; i++)
        if (coarse->known[i])
            coarse->values[i] /= coarse->known[i];
}

/* Gaps of `fine` from `coarse`, bilinear between the centres of its samples. */
static void push(const struct level *coarse, struct level *fine)
{
    for (uint32_t j = 0; j < fine->height; j++) {
        uint32_t south = j / 2, beside_j = j & 1 ? south + 1 : south - (south > 0);
        if (beside_j >= coarse->height)
            beside_j = south;
        for (uint32_t i = 0; i < fine->width; i++) {
            size_t to = (size_t)j * fine->width + i;
            if (fine->known[to])
                continue;
            uint32_t west = i / 2, beside_i = i & 1 ? west + 1 : west - (west > 0);
            if (beside_i >= coarse->width)
                beside_i = west;
            const float *near_row = coarse->values + (size_t)south * coarse->width;
            const float *far_row = coarse->values + (size_t)beside_j * coarse->width;
            fine->values[to] = (9 * near_row[west] + 3 * (near_row[beside_i] + far_row[west]) +
                                far_row[beside_i]) * (1.0f / 16);
        }
    }
}

static float mean_of_neighbours(const struct level *level, uint32_t i, uint32_t j)
{
    const float *row = level->values + (size_t)j * level->width;
    float west = row[i ? i - 1 : i], east = row[i + 1 < level->width ? i + 1 : i];
    float south = level->values[(size_t)(j ? j - 1 : j) * level->width + i];
    float north = level->values[(size_t)(j + 1 < level->height ? j + 1 : j) * level->width + i];
    return (west + east + south + north) * 0.25f;
}

/* Gauss-Seidel sweeps of Laplace's equation over the gaps: its solutions have no pits or peaks. */
static void relax(struct level *level)
{
    enum { SWEEPS = 8 };
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        for (uint32_t row = 0; row < level->height; row++) {
            uint32_t j = sweep & 1 ? level->height - 1 - row : row;
            for (uint32_t i = 0; i < level->width; i++)
                if (!level->known[(size_t)j * level->width + i])
                    level->values[(size_t)j * level->width + i] = mean_of_neighbours(level, i, j);
        }
    }
}

static void fill_level(struct level *fine)
{
    size_t count = (size_t)fine->width * fine->height, known = 0;
    for (size_t i = 0; i < count; i++)
        known += fine->known[i] != 0;
    if (known == count)
        return;
    struct level coarse = {(fine->width + 1) / 2, (fine->height + 1) / 2, NULL, NULL};
    size_t coarse_count = (size_t)coarse.width * coarse.height;
    coarse.values = wd_alloc_array(coarse_count, sizeof(float));
    coarse.known = wd_alloc_array(coarse_count, 1);
    pull(fine, &coarse);
    fill_level(&coarse);
    push(&coarse, fine);
    relax(fine);
    free(coarse.values);
    free(coarse.known);
}

uint64_t wd_fill_missing(float *values, uint32_t width, uint32_t height)
{
    size_t count = (size_t)width * height;
    uint64_t missing = count_missing(values, count);
    if (missing == 0 || missing == count)
        return missing;
    struct level level = {width, height, values, wd_alloc_array(count, 1)};
    for (size_t i = 0; i < count; i++)
        level.known[i] = !isnan(values[i]);
    fill_level(&level);
    free(level.known);
    return missing;
}

static void catmull_rom(double t, double weights[4])
{
    weights[0] = t * (t * (2 - t) - 1) * 0.5;
    weights[1] = (t * t * (3 * t - 5) + 2) * 0.5;
    weights[2] = t * (t * (4 - 3 * t) + 1) * 0.5;
    weights[3] = t * t * (t - 1) * 0.5;
}

/* The cell, and the four samples about it: clamped at the edge. */
static double taps(double at, uint32_t samples, uint32_t index[4])
{
    double clamped = !(at > 0) ? 0 : fmin(at, samples - 1);
    int64_t cell = (int64_t)clamped;
    for (int k = 0; k < 4; k++) {
        int64_t tap = cell - 1 + k;
        index[k] = tap < 0 ? 0 : tap >= samples ? samples - 1 : (uint32_t)tap;
    }
    return clamped - (double)cell;
}

float wd_sample_smooth(const float *values, uint32_t width, uint32_t height, double u, double v)
{
    uint32_t column[4], row[4];
    double across[4], along[4];
    catmull_rom(taps(u, width, column), across);
    catmull_rom(taps(v, height, row), along);
    double sum = 0;
    float least = INFINITY, most = -INFINITY;
    for (int j = 0; j < 4; j++) {
        const float *line = values + (size_t)row[j] * width;
        double row_sum = 0;
        for (int i = 0; i < 4; i++) {
            float value = line[column[i]];
            row_sum += across[i] * value;
            least = value < least ? value : least;
            most = value > most ? value : most;
        }
        sum += along[j] * row_sum;
    }
    float smooth = (float)sum;
    return smooth < least ? least : smooth > most ? most : smooth;
}
