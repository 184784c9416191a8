/* terrain_fractal.c: diamond-square (row R1) on an endless lattice, any size cut out of it.
 *
 * A pass halves the lattice: the mean of four corners gives the centre of a square, the mean of
 * two corners and two centres the middle of its side, and each new point is offset by a uniform
 * number in (-x, x); then x falls by 2^-y. These two means are also the face and edge rules of
 * bicubic B-spline subdivision (Catmull & Clark 1978). Moving the old points by that scheme's
 * vertex rule as well, (F + 2 R + V) / 4, makes the surface below each pass's offsets smooth, and
 * the well-known creases of diamond-square along the lattice are gone.
 *
 * Offsets are hashed from pass and lattice point: no order of work, no edge, any size. */
#include "world/terrain_parts.h"

#include <math.h>
#include <stdlib.h>

#include "base/dmath.h"
#include "base/jobs.h"
#include "base/log.h"
#include "base/memory.h"
#include "shared/hash.h"

enum { MARGIN = 2 }; /* lattice points kept around the wanted ones, for the rules' neighbours */

/* Lattice points -MARGIN .. cells + MARGIN, every 2^k-th sample of the terrain. */
struct lattice {
    int cells_x, cells_y;
    float *values;
};

static int lattice_stride(const struct lattice *lattice)
{
    return lattice->cells_x + 1 + 2 * MARGIN;
}

static float *lattice_at(const struct lattice *lattice, int i, int j)
{
    return lattice->values + (size_t)(j + MARGIN) * lattice_stride(lattice) + i + MARGIN;
}

static struct lattice lattice_new(const struct wd_terrain *terrain, int step)
{
    struct lattice lattice = {
        .cells_x = (int)((terrain->width - 1 + step - 1) / step),
        .cells_y = (int)((terrain->height - 1 + step - 1) / step),
    };
    size_t rows = (size_t)lattice.cells_y + 1 + 2 * MARGIN;
    lattice.values = wd_alloc_array(rows * lattice_stride(&lattice), sizeof(float));
    return lattice;
}

struct pass {
    struct lattice coarse, fine;
    uint32_t seed, number;
    float offset_m; /* x */
};

/* Uniform in (-x, x), for a point of the fine lattice. */
static float pass_offset(const struct pass *pass, int i, int j)
{
    uint32_t hash = wd_hash4(pass->seed, pass->number, (uint32_t)i, (uint32_t)j);
    return (2 * wd_hash_unit(hash) - 1) * pass->offset_m;
}

/* The diamond step; i and j are odd points of the fine lattice. */
static float pass_centre(const struct pass *pass, int i, int j)
{
    const float *south = lattice_at(&pass->coarse, (i - 1) / 2, (j - 1) / 2);
    const float *north = south + lattice_stride(&pass->coarse);
    return (south[0] + south[1] + north[0] + north[1]) * 0.25f + pass_offset(pass, i, j);
}

/* The square step, for a point between two corners west and east (or south and north). */
static float pass_side(const struct pass *pass, int i, int j)
{
    bool level = i & 1;
    const float *corner = lattice_at(&pass->coarse, level ? (i - 1) / 2 : i / 2,
                                     level ? j / 2 : (j - 1) / 2);
    float corners = corner[0] + corner[level ? 1 : lattice_stride(&pass->coarse)];
    float centres = level ? pass_centre(pass, i, j - 1) + pass_centre(pass, i, j + 1)
                          : pass_centre(pass, i - 1, j) + pass_centre(pass, i + 1, j);
    return (corners + centres) * 0.25f + pass_offset(pass, i, j);
}

/* The vertex rule on the corners alone: weights 36, 6, 1 of 64. */
static float pass_corner(const struct pass *pass, int i, int j)
{
    const float *here = lattice_at(&pass->coarse, i / 2, j / 2);
    const float *south = here - lattice_stride(&pass->coarse);
    const float *north = here + lattice_stride(&pass->coarse);
    float sides = here[-1] + here[1] + south[0] + north[0];
    float corners = south[-1] + south[1] + north[-1] + north[1];
    return (36 * here[0] + 6 * sides + corners) * (1.0f / 64);
}

static void pass_row(void *user, size_t index)
{
    const struct pass *pass = user;
    int j = (int)index - MARGIN;
    float *row = lattice_at(&pass->fine, 0, j);
    for (int i = -MARGIN; i <= pass->fine.cells_x + MARGIN; i++) {
        if (!(i & 1) && !(j & 1))
            row[i] = pass_corner(pass, i, j);
        else if ((i & 1) && (j & 1))
            row[i] = pass_centre(pass, i, j);
        else
            row[i] = pass_side(pass, i, j);
    }
}

static void seed_corners(struct lattice *lattice, uint32_t seed, float offset_m)
{
    struct pass pass = {.seed = seed, .offset_m = offset_m};
    for (int j = -MARGIN; j <= lattice->cells_y + MARGIN; j++)
        for (int i = -MARGIN; i <= lattice->cells_x + MARGIN; i++)
            *lattice_at(lattice, i, j) = pass_offset(&pass, i, j);
}

/* Ends with a lattice of one point a sample. */
static struct lattice subdivide(const struct wd_terrain *terrain, double offset_m, double roughness,
                                uint32_t seed)
{
    uint32_t least = (terrain->width < terrain->height ? terrain->width : terrain->height) - 1;
    int step = 1;
    while ((uint32_t)step < least)
        step *= 2;
    struct lattice coarse = lattice_new(terrain, step);
    double fall = wd_dpow(2, -roughness);
    seed_corners(&coarse, seed, (float)offset_m);
    for (uint32_t number = 1; step > 1; number++) {
        step /= 2;
        offset_m *= fall;
        struct pass pass = {coarse, lattice_new(terrain, step), seed, number, (float)offset_m};
        wd_jobs_run(terrain->threads, (size_t)pass.fine.cells_y + 1 + 2 * MARGIN, pass_row, &pass);
        free(coarse.values);
        coarse = pass.fine;
    }
    return coarse;
}

struct smoothing {
    const float *from;
    float *to;
    uint32_t width, height;
    uint32_t reach; /* samples between the kernel's taps */
};

/* The cubic B-spline's (1, 4, 1) / 6 both ways. */
static void smooth_row(void *user, size_t j)
{
    const struct smoothing *pass = user;
    size_t width = pass->width, last = pass->height - 1;
    const float *south = pass->from + (j > pass->reach ? j - pass->reach : 0) * width;
    const float *here = pass->from + j * width;
    const float *north = pass->from + (j + pass->reach < last ? j + pass->reach : last) * width;
    float *to = pass->to + j * width;
    for (size_t i = 0; i < width; i++) {
        size_t west = i > pass->reach ? i - pass->reach : 0;
        size_t east = i + pass->reach < width ? i + pass->reach : width - 1;
        to[i] = (16 * here[i] + 4 * (here[west] + here[east] + south[i] + north[i]) +
                 south[west] + south[east] + north[west] + north[east]) * (1.0f / 36);
    }
}

/* Soil creep: real slopes are smooth up to some tens of metres where they are not rock. The kernel
 * widens twofold a pass up to a reach of 32 m from roughness 0.9 on, none up to 0.7. */
static void creep(struct wd_terrain *terrain, double roughness)
{
    double reach_m = 32 * fmin(fmax((roughness - 0.7) / 0.2, 0), 1);
    float *spare = wd_alloc_array((size_t)terrain->width * terrain->height, sizeof(float));
    for (uint32_t reach = 1; reach * terrain->cell_m <= reach_m; reach *= 2) {
        struct smoothing pass = {terrain->height_m, spare, terrain->width, terrain->height, reach};
        wd_jobs_run(terrain->threads, terrain->height, smooth_row, &pass);
        spare = terrain->height_m;
        terrain->height_m = pass.to;
    }
    free(spare);
}

/* Moves and scales the heights so that they run from 0 to `relief_m`. Returns the old relief. */
static float normalise(struct wd_terrain *terrain, float relief_m)
{
    size_t count = (size_t)terrain->width * terrain->height;
    float *height_m = terrain->height_m, min_m = height_m[0], max_m = height_m[0];
    for (size_t i = 0; i < count; i++) {
        min_m = fminf(min_m, height_m[i]);
        max_m = fmaxf(max_m, height_m[i]);
    }
    float span = max_m - min_m, scale = span > 0 ? relief_m / span : 0;
    for (size_t i = 0; i < count; i++)
        height_m[i] = fminf((height_m[i] - min_m) * scale, relief_m);
    return span;
}

static bool check(const struct wd_scene_terrain *wanted, const struct wd_log *log)
{
    for (int axis = 0; axis < 2; axis++)
        if (!(isfinite(wanted->size_m[axis]) && wanted->size_m[axis] > 0))
            return wd_error(log, "terrain.size_m: is %g x %g; both must be above 0",
                            wanted->size_m[0], wanted->size_m[1]);
    if (!(isfinite(wanted->cell_m) && wanted->cell_m >= 0))
        return wd_error(log, "terrain.cell_m: is %g, must be above 0", wanted->cell_m);
    if (!(isfinite(wanted->relief_m) && wanted->relief_m >= 0))
        return wd_error(log, "terrain.relief_m: is %g, must not be below 0", wanted->relief_m);
    if (!(wanted->roughness >= 0 && wanted->roughness <= 4))
        return wd_error(log, "terrain.roughness: is %g, must be 0 (rough) .. 4 (smooth)",
                        wanted->roughness);
    if (!(wanted->valley >= 0 && wanted->valley <= 1))
        return wd_error(log, "terrain.valley: is %g, must be 0 .. 1", wanted->valley);
    return true;
}

/* East-west the extent is as asked for; north-south it is within half a cell. */
static bool choose_grid(struct wd_terrain *terrain, const struct wd_scene_terrain *wanted,
                        uint64_t max_samples, const struct wd_log *log)
{
    double x_m = wanted->size_m[0], y_m = wanted->size_m[1], columns, rows;
    double area_root_m = sqrt(x_m) * sqrt(y_m);
    double wanted_m = wanted->cell_m > 0 ? wanted->cell_m : area_root_m / 1024;
    double cell_m = fmax(wanted_m, area_root_m / sqrt((double)max_samples));
    for (;; cell_m *= 1.01) {
        columns = fmax(1, nearbyint(x_m / cell_m));
        rows = fmax(1, nearbyint(y_m * columns / x_m));
        if ((columns + 1) * (rows + 1) <= (double)max_samples)
            break;
    }
    terrain->width = (uint32_t)columns + 1;
    terrain->height = (uint32_t)rows + 1;
    terrain->cell_m = x_m / columns;
    if (fmin(x_m, y_m) < terrain->cell_m / 2)
        return wd_error(log, "terrain.size_m: %g x %g is narrower than half a cell of %g m", x_m,
                        y_m, terrain->cell_m);
    if (cell_m > wanted_m)
        wd_warn(log, "terrain.cell_m: %g m would be more than the %llu samples allowed: %g m taken",
                wanted_m, (unsigned long long)max_samples, terrain->cell_m);
    return true;
}

bool wd_terrain_make_fractal(struct wd_terrain *terrain, const struct wd_scene_terrain *wanted,
                             uint32_t seed, uint64_t max_samples,
                             const struct wd_progress *progress, const struct wd_log *log)
{
    if (!check(wanted, log) || !choose_grid(terrain, wanted, max_samples, log))
        return false;
    if (!wd_progress_report(progress, "terrain", 0, 1))
        return false;
    /* About 1 in 25: hills of 320 m on 8 km. */
    double offset_m = 0.04 * sqrt(wanted->size_m[0]) * sqrt(wanted->size_m[1]);
    struct lattice lattice = subdivide(terrain, offset_m, wanted->roughness, seed);
    size_t width = terrain->width;
    terrain->height_m = wd_alloc_array(width * terrain->height, sizeof(float));
    for (uint32_t j = 0; j < terrain->height; j++)
        for (uint32_t i = 0; i < width; i++)
            terrain->height_m[j * width + i] = *lattice_at(&lattice, (int)i, (int)j);
    free(lattice.values);
    creep(terrain, wanted->roughness);
    float relief_m = normalise(terrain, 1);
    if (wanted->valley > 0)
        wd_terrain_carve_valley(terrain, wanted->valley, seed);
    normalise(terrain, wanted->relief_m > 0 ? (float)wanted->relief_m : relief_m);
    return wd_progress_report(progress, "terrain", 1, 1);
}
