#include "world/river.h"

#include <math.h>
#include <stdlib.h>

#include "base/log.h"
#include "base/memory.h"
#include "shared/river.h"
#include "world/shoreline.h"

/* Least samples a reach is long; how far the surface goes on under the shore; passes that even it out. */
enum { REACH = 4, MARGIN = 3, SMOOTHINGS = 12 };
static const uint32_t NOWHERE = UINT32_MAX;
static const float BELOW_SHORE_M = 0.25f;
/* A sample beside the shore is no farther from it than so many cells. Both sides of it rise as steeply as gravel lies,
 * on wide cells less: over one by twice what any bank stands over the water, so that few banks are too low for it. */
static const double SHORE_CELLS = 1.5;
static const float BED_SLOPE = 0.35f, SHORE_RISE_M = 0.5f;

struct rivers {
    struct wd_terrain *terrain;
    struct wd_shoreline shoreline;
    size_t count;
    uint8_t *wet;
    uint32_t *gone;   /* samples, then reaches, from the water's lowest place; NOWHERE: not known yet */
    uint32_t *queue;
    uint32_t *reach;  /* index of the reach a sample is in */
    uint32_t reaches;
    float *level_m;   /* of reaches, then of samples */
    float *shore_m;   /* metres to dry ground */
};

/* The sample's k-th neighbour, k < 8 (the first four share a side), or the sample itself at the edge. */
static size_t beside(const struct wd_terrain *terrain, size_t at, int k)
{
    static const int east[8] = {1, -1, 0, 0, 1, -1, 1, -1}, north[8] = {0, 0, 1, -1, 1, 1, -1, -1};
    uint32_t i = (uint32_t)(at % terrain->width), j = (uint32_t)(at / terrain->width);
    if ((east[k] < 0 && i == 0) || (east[k] > 0 && i + 1 == terrain->width) ||
        (north[k] < 0 && j == 0) || (north[k] > 0 && j + 1 == terrain->height))
        return at;
    return (size_t)((ptrdiff_t)at + north[k] * (ptrdiff_t)terrain->width + east[k]);
}

/* --- the map ------------------------------------------------------------------------------- */

static bool read_map(struct rivers *rivers, const struct wd_scene *scene, const struct wd_log *log)
{
    const struct wd_scene_map *map = &scene->water.map;
    const struct wd_terrain *terrain = rivers->terrain;
    size_t wet = 0;
    if (!wd_shoreline_init(&rivers->shoreline, scene, terrain, log))
        return false;
    for (size_t i = 0; i < rivers->count; i++) {
        double x_m = (double)(i % terrain->width) * terrain->cell_m;
        double y_m = (double)(i / terrain->width) * terrain->cell_m;
        rivers->wet[i] = wd_shoreline_share(&rivers->shoreline, x_m, y_m) >= 0.5f;
        wet += rivers->wet[i];
    }
    if (wet == 0)
        return wd_error(log, "%s: shows no water on the terrain: none of its samples, %g m apart, has "
                        "one of the classes or half of the value range, but values of %g to %g", map->file,
                        terrain->cell_m, (double)rivers->shoreline.lowest, (double)rivers->shoreline.highest);
    if (wet == rivers->count)
        return wd_error(log, "%s: shows water everywhere; some of the terrain must stay dry",
                        map->file);
    return true;
}

/* Metres to dry ground, about: steps to the side and across (Borgefors 1986, both ways once). */
static void measure_shore(struct rivers *rivers)
{
    const struct wd_terrain *terrain = rivers->terrain;
    float cell_m = (float)terrain->cell_m;
    for (size_t i = 0; i < rivers->count; i++)
        rivers->shore_m[i] = rivers->wet[i] ? INFINITY : 0;
    for (int way = 0; way < 2; way++) {
        for (size_t n = 0; n < rivers->count; n++) {
            size_t at = way ? rivers->count - 1 - n : n;
            for (int k = 0; k < 8; k++) {
                float by_m = rivers->shore_m[beside(terrain, at, k)] +
                             cell_m * (k < 4 ? 1 : 1.41421356f);
                rivers->shore_m[at] = fminf(rivers->shore_m[at], by_m);
            }
        }
    }
}

/* --- reaches ------------------------------------------------------------------------------- */

/* Everything wet that hangs together with `start`, into queue[from..]; its end is returned. With
 * `gone` NOWHERE-ed before. */
static size_t spread(struct rivers *rivers, size_t start, size_t from)
{
    size_t end = from;
    rivers->gone[start] = 0;
    rivers->queue[end++] = (uint32_t)start;
    for (size_t n = from; n < end; n++) {
        size_t at = rivers->queue[n];
        for (int k = 0; k < 8; k++) {
            size_t to = beside(rivers->terrain, at, k);
            if (!rivers->wet[to] || rivers->gone[to] != NOWHERE)
                continue;
            rivers->gone[to] = rivers->gone[at] + 1;
            rivers->queue[end++] = (uint32_t)to;
        }
    }
    return end;
}

/* Samples a reach of this water is long: as much as it is broad, so that a pond is one. */
static uint32_t reach_length(const struct rivers *rivers, size_t from, size_t end)
{
    float broadest_m = 0;
    for (size_t n = from; n < end; n++)
        broadest_m = fmaxf(broadest_m, rivers->shore_m[rivers->queue[n]]);
    uint32_t samples = (uint32_t)fminf(2.5f * broadest_m / (float)rivers->terrain->cell_m, 1e6f);
    return samples > REACH ? samples : REACH;
}

/* Leaves in `gone` how many reaches it is to the lowest place of each water, and in `queue` all of its
 * samples by that. */
static void find_ways(struct rivers *rivers)
{
    size_t end = 0;
    for (size_t i = 0; i < rivers->count; i++)
        rivers->gone[i] = NOWHERE;
    for (size_t i = 0; i < rivers->count; i++) {
        if (!rivers->wet[i] || rivers->gone[i] != NOWHERE)
            continue;
        size_t from = end, lowest = i;
        end = spread(rivers, i, from);
        for (size_t n = from; n < end; n++) {
            size_t at = rivers->queue[n];
            if (rivers->terrain->height_m[at] < rivers->terrain->height_m[lowest])
                lowest = at;
        }
        for (size_t n = from; n < end; n++)
            rivers->gone[rivers->queue[n]] = NOWHERE;
        spread(rivers, lowest, from);
        uint32_t length = reach_length(rivers, from, end);
        for (size_t n = from; n < end; n++)
            rivers->gone[rivers->queue[n]] /= length;
    }
}

/* The lowest ground within MARGIN samples of dry shore, that a surface must not stand above. */
static float lowest_shore_m(const struct rivers *rivers, size_t at)
{
    const struct wd_terrain *terrain = rivers->terrain;
    long i0 = (long)(at % terrain->width), j0 = (long)(at / terrain->width);
    float least_m = INFINITY;
    if (rivers->shore_m[at] > 1.5f * (float)terrain->cell_m)
        return INFINITY;
    for (long j = j0 - MARGIN; j <= j0 + MARGIN; j++)
        for (long i = i0 - MARGIN; i <= i0 + MARGIN; i++)
            if (i >= 0 && j >= 0 && i < (long)terrain->width && j < (long)terrain->height)
                least_m = fminf(least_m, terrain->height_m[(size_t)j * terrain->width + (size_t)i]);
    return least_m;
}

/* Joins what lies about as far from the water's lowest place and hangs together; `stack` has room for
 * all samples. */
static void fill_reach(struct rivers *rivers, uint32_t start, uint32_t *stack)
{
    size_t left = 0;
    uint32_t band = rivers->gone[start], reach = rivers->reaches++;
    float level_m = INFINITY;
    stack[left++] = start;
    rivers->reach[start] = reach;
    while (left) {
        uint32_t at = stack[--left];
        level_m = fminf(level_m, lowest_shore_m(rivers, at));
        for (int k = 0; k < 8; k++) {
            size_t to = beside(rivers->terrain, at, k);
            if (!rivers->wet[to] || rivers->reach[to] != NOWHERE || rivers->gone[to] != band)
                continue;
            rivers->reach[to] = reach;
            stack[left++] = (uint32_t)to;
        }
    }
    rivers->level_m[reach] = level_m;
}

/* From the highest reaches down: none stands above one that flows into it. */
static void level_reaches(struct rivers *rivers)
{
    uint32_t *stack = wd_alloc_array(rivers->count, sizeof *stack);
    size_t end = 0;
    for (size_t i = 0; i < rivers->count; i++) {
        rivers->reach[i] = NOWHERE;
        end += rivers->wet[i];
    }
    for (size_t n = 0; n < end; n++)
        if (rivers->reach[rivers->queue[n]] == NOWHERE)
            fill_reach(rivers, rivers->queue[n], stack);
    free(stack);
    for (size_t n = end; n-- > 0;) {
        uint32_t at = rivers->queue[n];
        float own_m = rivers->level_m[rivers->reach[at]];
        for (int k = 0; k < 8; k++) {
            size_t to = beside(rivers->terrain, at, k);
            if (rivers->wet[to] && rivers->gone[to] < rivers->gone[at]) {
                float *down = &rivers->level_m[rivers->reach[to]];
                *down = fminf(*down, own_m);
            }
        }
    }
}

/* --- the surface --------------------------------------------------------------------------- */

static bool has_water(float level_m)
{
    return level_m > 0.5f * WD_NO_WATER_M;
}

/* The mean over neighbours that have water; `grown` then takes those that have none themselves. */
static void even_out(struct rivers *rivers, float *to, bool grown)
{
    const float *from = rivers->terrain->water_m;
    for (size_t i = 0; i < rivers->count; i++) {
        float sum = 0, count = 0;
        to[i] = from[i];
        if (has_water(from[i]) == grown)
            continue;
        for (int k = 0; k < 8; k++) {
            float level_m = from[beside(rivers->terrain, i, k)];
            sum += has_water(level_m) ? level_m : 0;
            count += has_water(level_m) ? 1 : 0;
        }
        if (count > 0)
            to[i] = grown ? sum / count : 0.5f * (from[i] + sum / count);
    }
}

static void make_surface(struct rivers *rivers)
{
    float *water_m = wd_alloc_array(rivers->count, sizeof *water_m);
    float *other_m = wd_alloc_array(rivers->count, sizeof *other_m);
    for (size_t i = 0; i < rivers->count; i++)
        water_m[i] = rivers->wet[i] ? rivers->level_m[rivers->reach[i]] - BELOW_SHORE_M
                                    : WD_NO_WATER_M;
    rivers->terrain->water_m = water_m;
    for (int pass = 0; pass < SMOOTHINGS + MARGIN; pass++) {
        even_out(rivers, other_m, pass >= SMOOTHINGS);
        float *swap = rivers->terrain->water_m;
        rivers->terrain->water_m = other_m;
        other_m = swap;
    }
    free(other_m);
}

/* Whether the shore runs between the sample and one beside it. */
static bool at_shore(const struct rivers *rivers, size_t at)
{
    bool apart = false;
    for (int k = 0; k < 8 && !apart; k++)
        apart = rivers->wet[beside(rivers->terrain, at, k)] != rivers->wet[at];
    return apart;
}

/* The surface meets the ground where the map's shore runs: on both sides of it heights go by the way there, alike steep.
 * By samples that are wet or dry, whose banks are of any height, shores followed the terrain's cells. */
static void meet_shore(struct rivers *rivers, size_t at, float depth_m)
{
    struct wd_terrain *terrain = rivers->terrain;
    double cell_m = terrain->cell_m;
    double x_m = (double)(at % terrain->width) * cell_m, y_m = (double)(at / terrain->width) * cell_m;
    float way_m = wd_shoreline_way_m(&rivers->shoreline, x_m, y_m, SHORE_CELLS * cell_m);
    float rise_m = fminf(BED_SLOPE, SHORE_RISE_M / (float)cell_m) * way_m;
    float height_m = terrain->water_m[at] + (rivers->wet[at] ? -fminf(rise_m, depth_m) : rise_m);
    terrain->height_m[at] = fminf(terrain->height_m[at], height_m);
}

/* A bed that falls away from the shore down to the wanted depth. */
static void dig(struct rivers *rivers, float depth_m)
{
    struct wd_terrain *terrain = rivers->terrain;
    for (size_t i = 0; i < rivers->count; i++) {
        if (at_shore(rivers, i)) {
            meet_shore(rivers, i, depth_m);
        } else if (rivers->wet[i]) {
            float deep_m = fminf(depth_m, 0.1f + BED_SLOPE * rivers->shore_m[i]);
            terrain->height_m[i] = fminf(terrain->height_m[i], terrain->water_m[i] - deep_m);
        }
        terrain->min_m = fminf(terrain->min_m, terrain->height_m[i]);
    }
}

bool wd_rivers_init(struct wd_terrain *terrain, const struct wd_scene *scene,
                    const struct wd_log *log)
{
    if (!scene->water.map.file)
        return true;
    size_t count = (size_t)terrain->width * terrain->height;
    struct rivers rivers = {.terrain = terrain, .count = count};
    rivers.wet = wd_alloc(count);
    rivers.shore_m = wd_alloc_array(count, sizeof(float));
    rivers.level_m = wd_alloc_array(count, sizeof(float));
    rivers.gone = wd_alloc_array(count, sizeof(uint32_t));
    rivers.queue = wd_alloc_array(count, sizeof(uint32_t));
    rivers.reach = wd_alloc_array(count, sizeof(uint32_t));
    bool ok = read_map(&rivers, scene, log);
    if (ok) {
        measure_shore(&rivers);
        find_ways(&rivers);
        level_reaches(&rivers);
        make_surface(&rivers);
        dig(&rivers, (float)scene->water.depth_m);
    }
    wd_shoreline_finish(&rivers.shoreline);
    free(rivers.wet);
    free(rivers.shore_m);
    free(rivers.level_m);
    free(rivers.gone);
    free(rivers.queue);
    free(rivers.reach);
    return ok;
}

float wd_river_level(const struct wd_terrain *terrain, double x_m, double y_m)
{
    double x = fmin(fmax(x_m / terrain->cell_m, 0), terrain->width - 1.001);
    double y = fmin(fmax(y_m / terrain->cell_m, 0), terrain->height - 1.001);
    size_t at = (size_t)y * terrain->width + (size_t)x;
    if (!terrain->water_m)
        return WD_NO_WATER_M;
    const float *south = terrain->water_m + at, *north = south + terrain->width;
    return wd_river_between(south[0], south[1], north[0], north[1], (float)(x - floor(x)),
                            (float)(y - floor(y)));
}

bool wd_river_covers(const struct wd_terrain *terrain, double x_m, double y_m)
{
    return terrain->water_m &&
           wd_river_level(terrain, x_m, y_m) > wd_terrain_height(terrain, x_m, y_m);
}
