#include "world/terrain.h"

#include <math.h>
#include <stdlib.h>

#include "base/log.h"
#include "base/memory.h"
#include "world/terrain_parts.h"

static bool is_positive(double value)
{
    return isfinite(value) && value > 0;
}

/* The largest cell that divides both sides exactly, if there is one of at least 1/1024 of the
 * shorter side; else that one, and the ground reaches a little further than asked. */
static double flat_cell(const double size_m[2])
{
    double least = fmin(size_m[0], size_m[1]), most = fmax(size_m[0], size_m[1]);
    for (int n = 1; n < 1024; n++) {
        double cells = most * n / least;
        if (fabs(cells - nearbyint(cells)) < 1e-9 * cells)
            return least / n;
    }
    return least / 1024;
}

static bool make_flat(struct wd_terrain *terrain, const struct wd_scene_terrain *wanted,
                      uint64_t max_samples, const struct wd_log *log)
{
    double size_m[2] = {wanted->size_m[0], wanted->size_m[1]};
    if (wanted->window_count == 4) {
        for (int axis = 0; axis < 2; axis++) {
            size_m[axis] = wanted->window_m[2 + axis] - wanted->window_m[axis];
            terrain->origin_m[axis] = wanted->window_m[axis];
        }
    }
    if (!is_positive(size_m[0]) || !is_positive(size_m[1]))
        return wd_error(log, "terrain.size_m: is %g x %g; both must be above 0", size_m[0],
                        size_m[1]);
    terrain->cell_m = flat_cell(size_m);
    double columns = ceil(size_m[0] / terrain->cell_m * (1 - 1e-9));
    double rows = ceil(size_m[1] / terrain->cell_m * (1 - 1e-9));
    if ((columns + 1) * (rows + 1) > (double)max_samples)
        return wd_error(log, "terrain.size_m: %g x %g is too long and narrow", size_m[0], size_m[1]);
    terrain->width = (uint32_t)columns + 1;
    terrain->height = (uint32_t)rows + 1;
    terrain->height_m = wd_alloc_array((size_t)terrain->width * terrain->height, sizeof(float));
    return true;
}

static void add_base(struct wd_terrain *terrain, float base_m)
{
    size_t count = (size_t)terrain->width * terrain->height;
    terrain->min_m = INFINITY;
    terrain->max_m = -INFINITY;
    for (size_t i = 0; i < count; i++) {
        float height_m = terrain->height_m[i] += base_m;
        terrain->min_m = fminf(terrain->min_m, height_m);
        terrain->max_m = fmaxf(terrain->max_m, height_m);
    }
}

static bool make(struct wd_terrain *terrain, const struct wd_scene *scene, uint32_t seed,
                 uint64_t max_samples, const struct wd_progress *progress,
                 const struct wd_log *log)
{
    const struct wd_scene_terrain *wanted = &scene->terrain;
    if (wanted->kind != WD_TERRAIN_RASTER && wanted->target_crs &&
        !(terrain->crs = wd_crs_wkt_in_metres(wanted->target_crs, log)))
        return false;
    switch (wanted->kind) {
    case WD_TERRAIN_FLAT:
        return make_flat(terrain, wanted, max_samples, log);
    case WD_TERRAIN_DIAMOND_SQUARE:
        return wd_terrain_make_fractal(terrain, wanted, seed, max_samples, progress, log);
    case WD_TERRAIN_RASTER:
        return wd_terrain_read_raster(terrain, scene, max_samples, progress, log);
    }
    return wd_error(log, "terrain.kind: %d is not known", wanted->kind);
}

bool wd_terrain_init(struct wd_terrain *terrain, const struct wd_scene *scene, uint32_t seed,
                     uint64_t max_samples, unsigned threads, const struct wd_progress *progress,
                     const struct wd_log *log)
{
    *terrain = (struct wd_terrain){.threads = threads};
    if (max_samples == 0)
        max_samples = WD_TERRAIN_DEFAULT_MAX_SAMPLES;
    if (max_samples < 4)
        max_samples = 4;
    bool ok = isfinite(scene->terrain.base_m) ||
              wd_error(log, "terrain.base_m: is %g, a finite height is wanted",
                       scene->terrain.base_m);
    if (!ok || !make(terrain, scene, seed, max_samples, progress, log)) {
        wd_terrain_finish(terrain);
        return false;
    }
    add_base(terrain, (float)scene->terrain.base_m);
    wd_debug(log, "terrain: %u x %u samples, %g m apart, heights %g .. %g m", terrain->width,
             terrain->height, terrain->cell_m, terrain->min_m, terrain->max_m);
    return true;
}

void wd_terrain_finish(struct wd_terrain *terrain)
{
    free(terrain->height_m);
    free(terrain->hole);
    free(terrain->water_m);
    free(terrain->crs);
    *terrain = (struct wd_terrain){0};
}

double wd_terrain_extent_x_m(const struct wd_terrain *terrain)
{
    return (terrain->width - 1) * terrain->cell_m;
}

double wd_terrain_extent_y_m(const struct wd_terrain *terrain)
{
    return (terrain->height - 1) * terrain->cell_m;
}

struct place {
    uint32_t i, j; /* south-west sample of the cell */
    double u, v;   /* within the cell, 0..1 */
};

static uint32_t locate_axis(double at_m, double cell_m, uint32_t samples, double *within)
{
    double at = at_m / cell_m;
    uint32_t last = samples - 2;
    uint32_t cell = !(at > 0) ? 0 : at >= last ? last : (uint32_t)at;
    *within = !(at > 0) ? 0 : fmin(at - cell, 1);
    return cell;
}

static struct place locate(const struct wd_terrain *terrain, double x_m, double y_m)
{
    struct place place;
    place.i = locate_axis(x_m, terrain->cell_m, terrain->width, &place.u);
    place.j = locate_axis(y_m, terrain->cell_m, terrain->height, &place.v);
    return place;
}

float wd_terrain_height(const struct wd_terrain *terrain, double x_m, double y_m)
{
    struct place at = locate(terrain, x_m, y_m);
    const float *south = terrain->height_m + (size_t)at.j * terrain->width + at.i;
    const float *north = south + terrain->width;
    double sw = south[0], ne = north[1];
    if (at.u >= at.v)
        return (float)(sw + at.u * (south[1] - sw) + at.v * (ne - south[1]));
    return (float)(sw + at.v * (north[0] - sw) + at.u * (ne - north[0]));
}

float wd_terrain_foot_m(const struct wd_terrain *terrain)
{
    return terrain->min_m - 0.02f * (float)wd_terrain_extent_x_m(terrain);
}

bool wd_terrain_contains(const struct wd_terrain *terrain, double x_m, double y_m)
{
    if (!(x_m >= 0 && y_m >= 0 && x_m <= wd_terrain_extent_x_m(terrain) &&
          y_m <= wd_terrain_extent_y_m(terrain)))
        return false;
    if (!terrain->hole)
        return true;
    /* A triangle with a corner in a hole is not drawn. */
    struct place at = locate(terrain, x_m, y_m);
    const uint8_t *south = terrain->hole + (size_t)at.j * terrain->width + at.i;
    const uint8_t *north = south + terrain->width;
    return !south[0] && !north[1] && !(at.u >= at.v ? south[1] : north[0]);
}
