#include "world/sky_map.h"

#include <math.h>
#include <stdlib.h>

#include "base/dmath.h"
#include "base/memory.h"
#include "shared/sky_map.h"
#include "world/sky_map_sun.h"

static const float PI = (float)WD_PI;
enum { CHOICE_WIDTH = 512, CELL_SIDE = 16 };
static const float BELOW = 0.1f; /* what is under the horizon is seldom met: its share of choices */

/* --- looking up ---------------------------------------------------------------------------- */

/* A picture of `channels` floats a texel by longitude and latitude. */
struct picture {
    const float *values;
    uint32_t width, height, channels;
};

static float texel(const struct picture *from, int32_t column, int32_t row, uint32_t channel)
{
    int32_t width = (int32_t)from->width, height = (int32_t)from->height;
    int32_t i = (column % width + width) % width, j = row < 0 ? 0 : row >= height ? height - 1 : row;
    return from->values[((size_t)j * from->width + (size_t)i) * from->channels + channel];
}

struct wd_vec3 wd_sky_map_toward(const struct wd_sky_map *map, struct wd_vec3 direction)
{
    const struct picture picture = {map->rgb, map->width, map->height, 3};
    struct wd_vec3 place = wd_sky_map_place(direction, map->turn);
    float x = place.x * (float)map->width - 0.5f, y = place.y * (float)map->height - 0.5f;
    int32_t i = (int32_t)floorf(x), j = (int32_t)floorf(y);
    float u = x - (float)i, v = y - (float)j, rgb[3];
    for (uint32_t k = 0; k < 3; k++)
        rgb[k] = wd_mixf(wd_mixf(texel(&picture, i, j, k), texel(&picture, i + 1, j, k), u),
                         wd_mixf(texel(&picture, i, j + 1, k), texel(&picture, i + 1, j + 1, k), u),
                         v);
    return wd_v3_of(rgb);
}

struct wd_vec3 wd_sky_map_mean(const void *user, struct wd_vec3 direction)
{
    const struct wd_sky_map *map = user;
    float turn = atan2f(direction.y, direction.x) / (2 * PI);
    uint32_t bearing = (uint32_t)((turn - floorf(turn)) * WD_SKYLIGHT_BEARINGS);
    float ring = wd_clampf(direction.z, 0, 1) * WD_SKYLIGHT_RINGS;
    return wd_v3_of(map->means[ring < WD_SKYLIGHT_RINGS ? (int)ring : WD_SKYLIGHT_RINGS - 1]
                              [bearing % WD_SKYLIGHT_BEARINGS]);
}

/* --- making -------------------------------------------------------------------------------- */

/* Halves in place; rows of a pair count by their size on the sphere. */
static void halve(struct wd_sky_map *map)
{
    uint32_t width = map->width / 2, height = map->height / 2;
    for (uint32_t j = 0; j < height; j++) {
        float upper = wd_sky_map_texel_sr(map->width, map->height, 2 * j);
        float lower = wd_sky_map_texel_sr(map->width, map->height, 2 * j + 1);
        float share[2] = {0.5f * upper / (upper + lower), 0.5f * lower / (upper + lower)};
        for (uint32_t i = 0; i < width; i++) {
            for (uint32_t k = 0; k < 3; k++) {
                float sum = 0;
                for (uint32_t of = 0; of < 4; of++)
                    sum += share[of / 2] * map->rgb[3 * ((size_t)(2 * j + of / 2) * map->width +
                                                         2 * i + of % 2) + k];
                map->rgb[3 * ((size_t)j * width + i) + k] = sum;
            }
        }
    }
    map->width = width;
    map->height = height;
}

static void fill_means(struct wd_sky_map *map, const struct wd_sky_map *small)
{
    for (int part = 0; part < WD_SKYLIGHT_RINGS * WD_SKYLIGHT_BEARINGS; part++) {
        int ring = part / WD_SKYLIGHT_BEARINGS, bearing = part % WD_SKYLIGHT_BEARINGS;
        struct wd_vec3 sum = {0, 0, 0};
        for (int at = 0; at < CELL_SIDE * CELL_SIDE; at++) {
            float up = ((float)(at / CELL_SIDE) + 0.5f) / CELL_SIDE;
            float round = ((float)(at % CELL_SIDE) + 0.5f) / CELL_SIDE;
            struct wd_vec3 d = wd_skylight_direction((float)ring + up, (float)bearing + round);
            sum = wd_v3_add(sum, wd_sky_map_toward(small, d));
        }
        sum = wd_v3_scale(sum, 1.0f / (CELL_SIDE * CELL_SIDE));
        const float mean[3] = {sum.x, sum.y, sum.z};
        for (int k = 0; k < 3; k++)
            map->means[ring][bearing][k] = mean[k];
    }
    for (int k = 0; k < 3; k++) {
        map->horizon[k] = 0;
        for (int bearing = 0; bearing < WD_SKYLIGHT_BEARINGS; bearing++)
            map->horizon[k] += map->means[0][bearing][k] / WD_SKYLIGHT_BEARINGS;
    }
}

/* Chances by what texels send, brightness times size; and their running sums. */
static void fill_choices(struct wd_sky_map *map, const struct wd_sky_map *small)
{
    uint32_t width = map->columns = small->width, height = map->rows = small->height;
    size_t count = (size_t)width * height;
    map->shares = wd_alloc_array(count, sizeof(float));
    map->row_ends = wd_alloc_array(height, sizeof(float));
    map->column_ends = wd_alloc_array(count, sizeof(float));
    double total = 0;
    for (size_t at = 0; at < count; at++) {
        const float *rgb = &small->rgb[3 * at];
        uint32_t row = (uint32_t)(at / width);
        float sr = wd_sky_map_texel_sr(width, height, row) * (row < height / 2 ? 1 : BELOW);
        map->shares[at] = (rgb[0] + rgb[1] + rgb[2]) * sr;
        total += (double)map->shares[at];
    }
    double above = 0;
    for (uint32_t j = 0; j < height; j++) {
        double sum = 0;
        for (uint32_t i = 0; i < width; i++) {
            size_t at = (size_t)j * width + i;
            map->shares[at] = total > 0 ? (float)((double)map->shares[at] / total)
                                        : 1 / (float)count;
            sum += (double)map->shares[at];
            map->column_ends[at] = (float)sum;
        }
        above += sum;
        map->row_ends[j] = (float)above;
    }
}

void wd_sky_map_init(struct wd_sky_map *map, float *rgb, uint32_t width, uint32_t height,
                     const struct wd_scene *scene)
{
    *map = (struct wd_sky_map){.width = width, .height = height, .rgb = rgb,
                               .turn = (float)(scene->sky.turn_deg / 360.0),
                               .sun = scene->sky.sun};
    size_t count = (size_t)width * height * 3;
    for (size_t i = 0; i < count; i++)
        rgb[i] *= (float)scene->sky.strength;
    if (map->sun == WD_SKY_SUN_FILE)
        wd_sky_map_take_sun(map);
    while (map->width > WD_SKY_MAP_MAX_WIDTH && map->height % 2 == 0)
        halve(map);
    struct wd_sky_map small = *map;
    small.rgb = wd_alloc_array((size_t)map->width * map->height, 3 * sizeof(float));
    for (size_t i = 0; i < (size_t)map->width * map->height * 3; i++)
        small.rgb[i] = map->rgb[i];
    while (small.width > CHOICE_WIDTH && small.height % 2 == 0)
        halve(&small);
    fill_means(map, &small);
    fill_choices(map, &small);
    free(small.rgb);
}

void wd_sky_map_finish(struct wd_sky_map *map)
{
    free(map->rgb);
    free(map->shares);
    free(map->row_ends);
    free(map->column_ends);
    *map = (struct wd_sky_map){0};
}

/* --- choosing directions ------------------------------------------------------------------- */

/* First of `count` running sums above `value`. */
static uint32_t first_above(const float *ends, uint32_t count, float value)
{
    uint32_t low = 0, high = count - 1;
    while (low < high) {
        uint32_t middle = (low + high) / 2;
        if (ends[middle] > value)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

struct wd_vec3 wd_sky_map_sample(const struct wd_sky_map *map, const float part[2],
                                 const float within[2])
{
    uint32_t j = first_above(map->row_ends, map->rows, part[0] * map->row_ends[map->rows - 1]);
    const float *ends = &map->column_ends[(size_t)j * map->columns];
    uint32_t i = first_above(ends, map->columns, part[1] * ends[map->columns - 1]);
    float top = cosf((float)j / (float)map->rows * PI);
    float bottom = cosf((float)(j + 1) / (float)map->rows * PI);
    float rise = wd_mixf(top, bottom, within[0]), across = sqrtf(fmaxf(1 - rise * rise, 0));
    float bearing = (((float)i + within[1]) / (float)map->columns - 0.5f + map->turn) * 2 * PI;
    return WD_V3(across * sinf(bearing), across * cosf(bearing), rise);
}

float wd_sky_map_density(const struct wd_sky_map *map, struct wd_vec3 direction)
{
    struct wd_vec3 place = wd_sky_map_place(direction, map->turn);
    float x = (place.x - floorf(place.x)) * (float)map->columns;
    float y = place.y * (float)map->rows;
    uint32_t i = x < (float)map->columns ? (uint32_t)x : map->columns - 1;
    uint32_t j = y < (float)map->rows ? (uint32_t)y : map->rows - 1;
    return map->shares[(size_t)j * map->columns + i] /
           wd_sky_map_texel_sr(map->columns, map->rows, j);
}
