#include "world/terrain_parts.h"

#include <math.h>

#include "base/dmath.h"
#include "base/jobs.h"
#include "shared/hash.h"

/* All lengths in shares of `width_m`, the broadest a valley looks like one. */
struct valley {
    double width_m, middle_m;
    double phase[2];
    double strength;
};

static const double bend_share[2] = {0.085, 0.035};
static const double bends_per_width[2] = {0.62, 1.55};
static const double floor_share = 0.07, side_share = 0.34;

/* Where the winding centre line crosses a row of samples. */
struct crossing {
    double x_m;
    double across; /* metres across the valley a metre of the row, over width_m */
};

static struct crossing line_crossing(const struct valley *valley, double y_m)
{
    double line = 0, slope = 0;
    for (int i = 0; i < 2; i++) {
        double turn = 2 * WD_PI * bends_per_width[i];
        double angle = turn * y_m / valley->width_m + valley->phase[i];
        line += bend_share[i] * wd_dsin(angle);
        slope += bend_share[i] * turn * wd_dcos(angle);
    }
    return (struct crossing){valley->middle_m + line * valley->width_m,
                             1 / (sqrt(1 + slope * slope) * valley->width_m)};
}

/* 0 on the floor .. 1 where the sides have risen to the heights; smooth to the second order. */
static double side_profile(double distance)
{
    double t = fmin(fmax((distance - floor_share) / side_share, 0), 1);
    return t * t * t * (t * (6 * t - 15) + 10);
}

/* `distance`: from the centre line; `along`: 0..1 up the valley. */
static double carve(double strength, double height, double distance, double along)
{
    /* Higher ground reaches further in: the foot of the sides winds about spurs and side valleys. */
    double side = side_profile(distance * (0.75 + 0.5 * height));
    double ground = 0.03 * height + 0.03 * along;
    double carved = ground + side * (0.45 + 0.55 * height - ground);
    return height + strength * (carved - height);
}

struct carving {
    struct wd_terrain *terrain;
    struct valley valley;
};

static void carve_row(void *user, size_t j)
{
    const struct carving *carving = user;
    struct wd_terrain *terrain = carving->terrain;
    struct crossing line = line_crossing(&carving->valley, j * terrain->cell_m);
    double along = (double)j / (terrain->height - 1);
    float *row = terrain->height_m + j * terrain->width;
    for (uint32_t i = 0; i < terrain->width; i++) {
        double distance = fabs(i * terrain->cell_m - line.x_m) * line.across;
        row[i] = (float)carve(carving->valley.strength, row[i], distance, along);
    }
}

void wd_terrain_carve_valley(struct wd_terrain *terrain, double strength, uint32_t seed)
{
    double x_m = wd_terrain_extent_x_m(terrain), y_m = wd_terrain_extent_y_m(terrain);
    struct carving carving = {terrain, {.width_m = fmin(x_m, 1.5 * y_m), .middle_m = x_m / 2,
                                        .strength = strength}};
    for (uint32_t i = 0; i < 2; i++)
        carving.valley.phase[i] = 2 * WD_PI * wd_hash_unit(wd_hash3(seed, 0x76616c6cu, i));
    wd_jobs_run(terrain->threads, terrain->height, carve_row, &carving);
}
