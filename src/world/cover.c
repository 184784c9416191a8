#include "world/cover.h"

#include <math.h>
#include <stdlib.h>

#include "base/jobs.h"
#include "base/memory.h"

enum { SIDE = 4 }; /* sample points along a cell's side */
static const double WOODS_M = 14.0;
static const double most_cells = 4.0 * 1024.0 * 1024.0;

/* Bit 4 * row + column of a cell is set where that sample point lies under a crown. */
struct samples {
    uint16_t *masks;
    uint32_t width, height; /* in cells */
    double step_m;          /* between sample points */
};

static void mark_row(struct samples *samples, long row, long first, long last)
{
    long columns = (long)samples->width * SIDE;
    if (row < 0 || row >= (long)samples->height * SIDE)
        return;
    first = first < 0 ? 0 : first;
    last = last >= columns ? columns - 1 : last;
    uint16_t *masks = samples->masks + (size_t)(row / SIDE) * samples->width;
    for (long column = first; column <= last; column++)
        masks[column / SIDE] |= (uint16_t)(1u << (row % SIDE * SIDE + column % SIDE));
}

static void mark_disc(struct samples *samples, const struct wd_tree *tree)
{
    double x = tree->x_mm * 0.001 / samples->step_m - 0.5;
    double y = tree->y_mm * 0.001 / samples->step_m - 0.5;
    double radius = WD_TREE_CROWN_CM(*tree) * 0.005 / samples->step_m;
    for (long row = (long)ceil(y - radius); (double)row <= y + radius; row++) {
        double up = (double)row - y, half = sqrt(fmax(radius * radius - up * up, 0.0));
        mark_row(samples, row, (long)ceil(x - half), (long)floor(x + half));
    }
}

static void add_sward(float *layers, const struct wd_world *world, const struct wd_tree *tree)
{
    double cell_m = world->cover_cell_m, radius_m = WD_TREE_CROWN_CM(*tree) * 0.005;
    long column = (long)(tree->x_mm * 0.001 / cell_m), row = (long)(tree->y_mm * 0.001 / cell_m);
    if (column < 0 || row < 0 || column >= (long)world->cover_width ||
        row >= (long)world->cover_height)
        return;
    layers[(size_t)row * world->cover_width + (size_t)column] +=
        (float)(3.14159265 * radius_m * radius_m / (cell_m * cell_m));
}

/* Of the plants that are no canopy. */
static void sward_init(struct wd_world *world)
{
    size_t count = (size_t)world->cover_width * world->cover_height, herbs = 0;
    float *layers = wd_alloc_array(count, sizeof *layers);
    for (size_t i = 0; i < world->tree_count; i++) {
        if (WD_TREE_HEIGHT_CM(world->trees[i]) >= WD_CANOPY_CM)
            continue;
        add_sward(layers, world, &world->trees[i]);
        herbs++;
    }
    if (herbs)
        world->sward = wd_alloc(count);
    for (size_t i = 0; herbs && i < count; i++)
        world->sward[i] = (uint8_t)fminf(WD_SWARD_LAYER * layers[i] + 0.5f, 255.0f);
    free(layers);
}

/* --- layers on demand ---------------------------------------------------------------------- */

/* Crown area over ground area; Poisson's share of the ground is left open. */
static void add_expected(void *user, size_t row)
{
    struct wd_world *world = user;
    double cell_m = world->cover_cell_m;
    for (uint32_t column = 0; column < world->cover_width; column++) {
        const double min_m[2] = {column * cell_m, row * cell_m};
        const double max_m[2] = {min_m[0] + cell_m, min_m[1] + cell_m};
        double area = 0.0;
        for (uint32_t i = 0; i < world->demand.count; i++) {
            const struct wd_demand_layer *layer = &world->demand.layers[i];
            if (layer->max_height_m * 100.0f < (float)WD_CANOPY_CM)
                continue;
            double spacing_m = layer->placement.input.layer.cell_mm * 0.001;
            area += wd_demand_density(&layer->placement, min_m, max_m, 1) * layer->crown_area_m2 /
                    (spacing_m * spacing_m);
        }
        uint8_t *cover = &world->cover[row * world->cover_width + column];
        *cover = (uint8_t)(255.0 - (255.0 - *cover) * exp(-area));
    }
}

void wd_cover_init(struct wd_world *world, unsigned threads)
{
    double x_m = wd_terrain_extent_x_m(&world->terrain);
    double y_m = wd_terrain_extent_y_m(&world->terrain);
    double cell_m = 4.0;
    while ((floor(x_m / cell_m) + 1.0) * (floor(y_m / cell_m) + 1.0) > most_cells)
        cell_m *= 1.0905077326652577; /* 2^(1/8) */
    struct samples samples = {
        .width = (uint32_t)floor(x_m / cell_m) + 1,
        .height = (uint32_t)floor(y_m / cell_m) + 1,
        .step_m = cell_m / SIDE,
    };
    size_t count = (size_t)samples.width * samples.height;
    samples.masks = wd_alloc_array(count, sizeof *samples.masks);
    for (size_t i = 0; i < world->tree_count; i++)
        if (WD_TREE_HEIGHT_CM(world->trees[i]) >= WD_CANOPY_CM)
            mark_disc(&samples, &world->trees[i]);
    world->cover = wd_alloc(count);
    for (size_t i = 0; i < count; i++)
        world->cover[i] = (uint8_t)(__builtin_popcount(samples.masks[i]) * 255 / (SIDE * SIDE));
    free(samples.masks);
    world->cover_width = samples.width;
    world->cover_height = samples.height;
    world->cover_cell_m = cell_m;
    sward_init(world);
    if (world->demand.count)
        wd_jobs_run(threads, samples.height, add_expected, world);
}

/* --- reading it --------------------------------------------------------------------------- */

uint32_t wd_grid_place(double at, uint32_t count, float *share)
{
    double last = count - 1.0, x = at < 0 ? 0 : at > last ? last : at;
    uint32_t cell = (uint32_t)x;
    if (cell + 1 >= count)
        cell = count >= 2 ? count - 2 : 0;
    *share = count >= 2 ? (float)(x - cell) : 0;
    return cell;
}

float wd_cover_grid_at(const struct wd_world *world, const uint8_t *grid, double x_m, double y_m)
{
    float u, v;
    uint32_t width = world->cover_width, height = world->cover_height;
    uint32_t i = wd_grid_place(x_m / world->cover_cell_m - 0.5, width, &u);
    uint32_t j = wd_grid_place(y_m / world->cover_cell_m - 0.5, height, &v);
    const uint8_t *south = grid + (size_t)j * width + i;
    const uint8_t *north = height > 1 ? south + width : south;
    int right = width > 1;
    float low = (float)south[0] + u * (float)(south[right] - south[0]);
    float high = (float)north[0] + u * (float)(north[right] - north[0]);
    return low + v * (high - low);
}

float wd_cover_at(const struct wd_world *world, double x_m, double y_m)
{
    bool has = world->cover && world->cover_width && world->cover_height;
    return has ? wd_cover_grid_at(world, world->cover, x_m, y_m) / 255.0f : 0.0f;
}

float wd_woods_at(const struct wd_world *world, double x_m, double y_m)
{
    const double d = WOODS_M;
    return 0.25f * (wd_cover_at(world, x_m + d, y_m) + wd_cover_at(world, x_m - d, y_m) +
                    wd_cover_at(world, x_m, y_m + d) + wd_cover_at(world, x_m, y_m - d));
}
