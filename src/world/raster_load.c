/* raster_load.c: a raster over the terrain's extent, in the terrain's local frame. */
#include "world/raster.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/jobs.h"
#include "base/log.h"
#include "base/memory.h"
#include "world/raster_source.h"

struct load {
    const struct wd_scene_map *wanted;
    const struct wd_terrain *terrain;
    enum wd_resampling resampling;
    const struct wd_log *log;
    struct wd_raster_source source;
    OGRSpatialReferenceH source_crs, frame; /* both NULL: the same plain metres */
    struct wd_pixel_map map;
    struct wd_mapping mapping;              /* of the raster's cell centres */
    struct wd_source_blocks blocks;
    float *values;                          /* of the blocks */
    double reach[2];                        /* half a cell, in blocks */
    struct wd_raster *raster;
};

static void load_finish(struct load *load)
{
    free(load->values);
    wd_mapping_finish(&load->mapping);
    wd_pixel_map_finish(&load->map);
    wd_crs_free(load->source_crs);
    wd_crs_free(load->frame);
    wd_source_finish(&load->source);
}

/* The picture's lower left corner on the terrain's south-west corner, and so on. */
static void stretch(struct load *load)
{
    struct wd_raster_source *source = &load->source;
    double x_m = wd_terrain_extent_x_m(load->terrain), y_m = wd_terrain_extent_y_m(load->terrain);
    double affine[6] = {load->terrain->origin_m[0], x_m / source->width, 0,
                        load->terrain->origin_m[1] + y_m, 0, -y_m / source->height};
    memcpy(source->crs_of_pixel, affine, sizeof affine);
    source->has_affine = source->has_position = true;
}

static bool find_crs(struct load *load)
{
    const struct wd_raster_source *source = &load->source;
    const char *assumed = load->wanted->crs;
    if (source->crs) {
        load->source_crs = wd_crs_copy(source->crs);
        if (assumed && !wd_crs_agree(source->crs, assumed, source->path, load->log))
            return false;
    } else if (assumed && !(load->source_crs = wd_crs_parse(assumed, source->path, load->log))) {
        return false;
    }
    if (!load->terrain->crs && load->source_crs)
        return wd_error(load->log,
                        "%s: has a coordinate system, the terrain has none, so its place is not "
                        "known: give crs \"local\" to stretch it over the terrain", source->path);
    if (!load->terrain->crs)
        return true;
    if (!load->source_crs)
        return wd_error(load->log,
                        "%s: the file has no coordinate system: give crs like \"EPSG:4326\", or "
                        "\"local\" to stretch it over the terrain", source->path);
    load->frame = wd_crs_parse(load->terrain->crs, "terrain", load->log);
    return load->frame != NULL;
}

static bool find_place(struct load *load)
{
    struct wd_raster_source *source = &load->source;
    if (load->wanted->crs && strcmp(load->wanted->crs, "local") == 0)
        stretch(load);
    else if (!find_crs(load))
        return false;
    if (!source->has_position)
        return wd_error(load->log,
                        "%s: the file does not say where it is (no geotransform): give crs "
                        "\"local\" to stretch it over the terrain", source->path);
    return wd_pixel_map_init(&load->map, source, load->source_crs, load->frame, load->log);
}

static bool choose_grid(struct load *load, uint64_t max_samples)
{
    struct wd_raster *raster = load->raster;
    struct wd_frame_bounds bounds;
    if (!wd_source_bounds(&load->source, &load->map, &bounds, load->log))
        return false;
    double extent_m[2] = {wd_terrain_extent_x_m(load->terrain),
                          wd_terrain_extent_y_m(load->terrain)};
    double cells[2];
    for (int axis = 0; axis < 2; axis++) {
        double start_m = load->terrain->origin_m[axis];
        if (bounds.max[axis] <= start_m || bounds.min[axis] >= start_m + extent_m[axis])
            return wd_error(load->log,
                            "%s: does not overlap the terrain: %s from %.10g to %.10g, the terrain "
                            "from %.10g to %.10g", load->source.path, axis ? "y" : "x",
                            bounds.min[axis], bounds.max[axis], start_m, start_m + extent_m[axis]);
        cells[axis] = fmax(1, ceil(extent_m[axis] / bounds.pixel[axis] - 1e-6));
    }
    double excess = sqrt(cells[0] * cells[1] / (double)max_samples);
    for (int axis = 0; axis < 2 && excess > 1; axis++)
        cells[axis] = fmin(fmax(1, floor(cells[axis] / excess)), (double)max_samples);
    if (cells[0] * cells[1] > (double)max_samples)
        cells[cells[0] < cells[1]] = floor((double)max_samples / fmin(cells[0], cells[1]));
    raster->width = (uint32_t)cells[0];
    raster->height = (uint32_t)cells[1];
    raster->cell_x_m = extent_m[0] / cells[0];
    raster->cell_y_m = extent_m[1] / cells[1];
    load->blocks.step = (int)fmax(1, floor(fmin(raster->cell_x_m / bounds.pixel[0],
                                                raster->cell_y_m / bounds.pixel[1]) + 1e-6));
    load->reach[0] = raster->cell_x_m / bounds.pixel[0] / load->blocks.step / 2;
    load->reach[1] = raster->cell_y_m / bounds.pixel[1] / load->blocks.step / 2;
    if (excess > 1)
        wd_info(load->log, "%s: decimated to %u x %u cells", load->source.path, raster->width,
                raster->height);
    return true;
}

static bool read_blocks(struct load *load)
{
    static const enum wd_reduction reductions[] = {WD_REDUCE_CENTRE, WD_REDUCE_MEAN,
                                                   WD_REDUCE_MAX};
    const struct wd_raster *raster = load->raster;
    const double *origin_m = load->terrain->origin_m;
    double first_m[2] = {origin_m[0] + raster->cell_x_m / 2, origin_m[1] + raster->cell_y_m / 2};
    double step_m[2] = {raster->cell_x_m, raster->cell_y_m};
    wd_mapping_init(&load->mapping, &load->map, raster->width, raster->height, first_m, step_m);
    if (!wd_source_blocks_over(&load->source, &load->mapping, load->blocks.step, &load->blocks))
        return wd_error(load->log, "%s: does not overlap the terrain", load->source.path);
    load->values = wd_alloc_array((size_t)load->blocks.columns * load->blocks.rows, sizeof(float));
    struct wd_missing_rule rule = {.extra = NAN, .heights = load->resampling == WD_RESAMPLE_MAX};
    return wd_source_read(&load->source, &load->blocks, reductions[load->resampling], &rule,
                          load->values, NULL, load->log);
}

static float block_at(const struct load *load, double column, double row)
{
    int i = (int)fmin(fmax(column, 0), load->blocks.columns - 1);
    int j = (int)fmin(fmax(row, 0), load->blocks.rows - 1);
    return load->values[(size_t)j * load->blocks.columns + i];
}

static float nearest(const struct load *load, double u, double v)
{
    return block_at(load, floor(u + 0.5), floor(v + 0.5));
}

/* Bilinear over what is known; no data where the nearest block has none. */
static float linear(const struct load *load, double u, double v)
{
    if (isnan(nearest(load, u, v)))
        return NAN;
    double column = floor(u), row = floor(v), sum = 0, weights = 0;
    for (int corner = 0; corner < 4; corner++) {
        int right = corner & 1, below = corner >> 1;
        float value = block_at(load, column + right, row + below);
        double weight = (right ? u - column : 1 - u + column) * (below ? v - row : 1 - v + row);
        if (isnan(value))
            continue;
        sum += weight * value;
        weights += weight;
    }
    return (float)(sum / weights);
}

/* The greatest of the blocks whose centres lie in the cell: each block counts in one cell only, so
 * that a treetop stays one top. */
static float greatest(const struct load *load, double u, double v)
{
    float most = NAN;
    double first_column = ceil(u - load->reach[0]), first_row = ceil(v - load->reach[1]);
    if (!(first_column < u + load->reach[0] && first_row < v + load->reach[1]))
        return nearest(load, u, v);
    for (double row = first_row; row < v + load->reach[1]; row++)
        for (double column = first_column; column < u + load->reach[0]; column++)
            if (row >= 0 && column >= 0 && row < load->blocks.rows &&
                column < load->blocks.columns)
                most = fmaxf(most, block_at(load, column, row));
    return most;
}

static double snapped(double at)
{
    double near = nearbyint(2 * at) / 2; /* centres and borders of blocks */
    return fabs(at - near) < 1e-6 ? near : at;
}

static float resample_one(const struct load *load, uint32_t i, uint32_t j)
{
    double px, py;
    wd_mapping_at(&load->mapping, i, j, &px, &py);
    const struct wd_raster_source *source = &load->source;
    if (!(px >= 0 && py >= 0 && px <= source->width && py <= source->height))
        return NAN;
    double u = snapped((px - load->blocks.x) / load->blocks.step - 0.5);
    double v = snapped((py - load->blocks.y) / load->blocks.step - 0.5);
    switch (load->resampling) {
    case WD_RESAMPLE_LINEAR:
        return linear(load, u, v);
    case WD_RESAMPLE_MAX:
        return greatest(load, u, v);
    case WD_RESAMPLE_NEAREST:
        break;
    }
    return nearest(load, u, v);
}

static void resample_row(void *user, size_t j)
{
    const struct load *load = user;
    float *row = load->raster->values + j * load->raster->width;
    for (uint32_t i = 0; i < load->raster->width; i++)
        row[i] = resample_one(load, i, (uint32_t)j);
}

static void resample(struct load *load)
{
    struct wd_raster *raster = load->raster;
    size_t count = (size_t)raster->width * raster->height, known = 0;
    raster->values = wd_alloc_array(count, sizeof(float));
    wd_jobs_run(load->terrain->threads, raster->height, resample_row, load);
    for (size_t i = 0; i < count; i++)
        known += !isnan(raster->values[i]);
    if (known == 0)
        wd_warn(load->log, "%s: has no data anywhere on the terrain", load->source.path);
}

bool wd_raster_load(struct wd_raster *raster, const struct wd_scene *scene,
                    const struct wd_scene_map *map, const struct wd_terrain *terrain,
                    enum wd_resampling resampling, uint64_t max_samples, const struct wd_log *log)
{
    *raster = (struct wd_raster){0};
    struct load load = {.wanted = map, .terrain = terrain, .resampling = resampling, .log = log,
                        .raster = raster};
    if (max_samples == 0)
        max_samples = UINT64_C(1) << 25;
    bool ok = wd_source_open(&load.source, scene->path, map->file, map->band, "map.file", log) &&
              find_place(&load) && choose_grid(&load, max_samples) && read_blocks(&load);
    if (ok)
        resample(&load);
    else
        *raster = (struct wd_raster){0};
    load_finish(&load);
    return ok;
}
