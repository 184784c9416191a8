/* terrain_raster.c: ground from a raster of heights.
 *
 * Heights are read on the source's own pixels (blocks of them, where it has more than may be
 * kept), gaps are filled there, and the terrain's samples are interpolated between: one smooth
 * resampling does reprojection, rotation and refinement alike, and no gap can bleed into it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/jobs.h"
#include "base/log.h"
#include "base/memory.h"
#include "world/raster_source.h"
#include "world/terrain_parts.h"

static const double smooth_cell_m = 8; /* coarser ground looks faceted at eye height */

struct dem {
    const struct wd_scene_terrain *wanted;
    uint64_t max_samples;
    const struct wd_log *log;
    struct wd_raster_source source;
    OGRSpatialReferenceH source_crs, frame; /* both NULL: plain metres */
    struct wd_pixel_map map;
    double first_m[2];       /* the south-west sample, in the frame */
    int step;                /* pixels a block, each way */
    struct wd_source_blocks blocks;
    float *block_m;          /* blocks.columns * blocks.rows heights, without gaps */
    uint8_t *block_missing;  /* NULL: nothing was missing */
    struct wd_mapping mapping;
};

static void dem_finish(struct dem *dem)
{
    wd_mapping_finish(&dem->mapping);
    free(dem->block_m);
    free(dem->block_missing);
    wd_pixel_map_finish(&dem->map);
    wd_crs_free(dem->frame);
    wd_crs_free(dem->source_crs);
    wd_source_finish(&dem->source);
}

static bool find_source_crs(struct dem *dem)
{
    const struct wd_scene_terrain *wanted = dem->wanted;
    const char *path = dem->source.path;
    if (wanted->unit && strcmp(wanted->unit, "metres") != 0)
        return wd_error(dem->log, "terrain.unit: is \"%s\"; only \"metres\" is known", wanted->unit);
    if (dem->source.crs) {
        dem->source_crs = wd_crs_copy(dem->source.crs);
        return !wanted->crs || wd_crs_agree(dem->source_crs, wanted->crs, "terrain.crs", dem->log);
    }
    if (wanted->crs) {
        dem->source_crs = wd_crs_parse(wanted->crs, "terrain.crs", dem->log);
        if (!dem->source_crs)
            return false;
        if (OSRIsProjected(dem->source_crs) || OSRIsGeographic(dem->source_crs))
            return true;
        return wd_error(dem->log, "terrain.crs: \"%s\" is neither projected nor in degrees",
                        wanted->crs);
    }
    if (!wanted->unit)
        return wd_error(dem->log,
                        "%s: the file has no coordinate system: give terrain.crs like "
                        "\"EPSG:4326\", or terrain.unit \"metres\" if its x and y are metres",
                        path);
    if (wanted->target_crs)
        return wd_error(dem->log,
                        "%s: the file has no coordinate system, so it cannot be reprojected to "
                        "terrain.target_crs: give terrain.crs too", path);
    return true;
}

/* A picture without a position becomes metres from its own south-west corner. */
static bool find_position(struct dem *dem)
{
    struct wd_raster_source *source = &dem->source;
    if (source->has_position)
        return true;
    if (dem->source_crs)
        return wd_error(dem->log,
                        "%s: %s a coordinate system, but the file does not say where it lies in it (no "
                        "geotransform): add a world file%s", source->path,
                        source->crs ? "has" : "terrain.crs gives",
                        source->crs ? "" : ", or give terrain.unit \"metres\" in place of terrain.crs");
    if (!dem->wanted->unit)
        return wd_error(dem->log,
                        "%s: the file does not say where it is (no geotransform): add a world "
                        "file, or give terrain.unit \"metres\" and terrain.cell_m", source->path);
    double cell_m = dem->wanted->cell_m > 0 ? dem->wanted->cell_m : 1;
    double affine[6] = {0, cell_m, 0, source->height * cell_m, 0, -cell_m};
    for (int i = 0; i < 6; i++)
        source->crs_of_pixel[i] = affine[i];
    source->has_affine = source->has_position = true;
    wd_info(dem->log, "%s: has no position: pixels are taken as %g m wide (terrain.cell_m)",
            source->path, cell_m);
    return true;
}

/* The raster's centre and breadth in degrees. */
static bool find_degrees(struct dem *dem, double centre_deg[2], double *breadth_deg)
{
    bool ok = false;
    OGRSpatialReferenceH degrees = wd_crs_parse("EPSG:4326", dem->source.path, dem->log);
    struct wd_pixel_map map = {0};
    struct wd_frame_bounds bounds;
    if (degrees && wd_pixel_map_init(&map, &dem->source, dem->source_crs, degrees, dem->log) &&
        wd_source_bounds(&dem->source, &map, &bounds, dem->log)) {
        for (int axis = 0; axis < 2; axis++)
            centre_deg[axis] = (bounds.min[axis] + bounds.max[axis]) / 2;
        *breadth_deg = bounds.max[0] - bounds.min[0];
        ok = fabs(centre_deg[1]) <= 90 && fabs(centre_deg[0]) <= 720;
        if (!ok)
            wd_error(dem->log, "%s: its centre (%g, %g) is no place in degrees", dem->source.path,
                     centre_deg[0], centre_deg[1]);
    }
    wd_pixel_map_finish(&map);
    wd_crs_free(degrees);
    return ok;
}

static bool find_frame(struct dem *dem)
{
    const char *target = dem->wanted->target_crs;
    if (target) {
        dem->frame = wd_crs_parse(target, "terrain.target_crs", dem->log);
        return dem->frame && (wd_crs_is_metric(dem->frame) ||
                              wd_error(dem->log, "terrain.target_crs: \"%s\" is not a projected "
                                                 "system in metres, as a UTM zone is", target));
    }
    if (!dem->source_crs)
        return true;
    if (wd_crs_is_metric(dem->source_crs)) {
        dem->frame = wd_crs_copy(dem->source_crs);
        return true;
    }
    double centre_deg[2], breadth_deg;
    if (!find_degrees(dem, centre_deg, &breadth_deg))
        return false;
    if (breadth_deg > 12 && fabs(centre_deg[1]) < 80)
        return wd_error(dem->log, "%s: is %.3g degrees wide, too much for one UTM zone: give "
                                  "terrain.target_crs (and terrain.window_m)",
                        dem->source.path, breadth_deg);
    dem->frame = wd_crs_utm_at(centre_deg[0], centre_deg[1]);
    if (!dem->frame)
        return wd_error(dem->log, "%s: no UTM zone for its centre; is PROJ's database installed?",
                        dem->source.path);
    wd_info(dem->log, "%s: reprojected to metres: %s", dem->source.path, OSRGetName(dem->frame));
    return true;
}

/* Indices of the first and last pixel wanted of `pixels` whose first centre is at `first_m`. */
static bool crop(struct dem *dem, int axis, double first_m, double pixel_m, int64_t pixels,
                 int64_t range[2])
{
    range[0] = 0;
    range[1] = pixels - 1;
    if (dem->wanted->window_count != 4)
        return true;
    const double *window_m = dem->wanted->window_m;
    double low = nearbyint((window_m[axis] - first_m) / pixel_m);
    double high = nearbyint((window_m[axis + 2] - first_m) / pixel_m);
    if (!(high > 0 && low < (double)pixels - 1 && high > low))
        return wd_error(dem->log,
                        "terrain.window_m: %s from %.10g to %.10g holds less than two pixels of "
                        "%s, which reaches from %.10g to %.10g",
                        axis ? "y" : "x", window_m[axis], window_m[axis + 2], dem->source.path,
                        first_m, first_m + ((double)pixels - 1) * pixel_m);
    range[0] = low > 0 ? (int64_t)low : 0;
    range[1] = high < (double)pixels - 1 ? (int64_t)high : pixels - 1;
    return true;
}

/* Samples of a cell's size on `extent_m`. */
static double samples_of(double extent_m, double cell_m)
{
    return floor(extent_m / cell_m + 1e-6) + 1;
}

static double grid_samples(const double extent_m[2], double cell_m)
{
    return samples_of(extent_m[0], cell_m) * samples_of(extent_m[1], cell_m);
}

/* The same of whole blocks of step x step pixels. */
static double block_samples(const double extent_m[2], double pixel_m, double step)
{
    double lost_m = (step - 1) * pixel_m;
    const double left_m[2] = {extent_m[0] - lost_m, extent_m[1] - lost_m};
    return grid_samples(left_m, pixel_m * step);
}

/* The raster's own spacing, coarser by whole pixels or finer by powers of two. */
static double choose_cell(struct dem *dem, double pixel_m, const double extent_m[2])
{
    double most = (double)dem->max_samples, cell_m = dem->wanted->cell_m;
    double own = grid_samples(extent_m, pixel_m);
    if (cell_m > 0) {
        if (grid_samples(extent_m, cell_m) <= most)
            return cell_m;
        double factor = fmax(1, sqrt(grid_samples(extent_m, cell_m) / most));
        while (grid_samples(extent_m, cell_m * factor) > most)
            factor *= 1.001;
        wd_warn(dem->log, "terrain.cell_m: %g m would be more than the %.0f samples allowed: %g m "
                          "taken", cell_m, most, cell_m * factor);
        return cell_m * factor;
    }
    if (own > most) {
        double step = fmax(2, floor(sqrt(own / most)));
        while (block_samples(extent_m, pixel_m, step) > most)
            step++;
        return pixel_m * step;
    }
    cell_m = pixel_m;
    while (cell_m > smooth_cell_m * (1 + 1e-9) && grid_samples(extent_m, cell_m / 2) <= most)
        cell_m /= 2;
    return cell_m;
}

/* Metres between the middles of its outer pixels are fewer than a cell takes. */
static bool too_small(const struct dem *dem, const double extent_m[2], double pixel_m, double cell_m)
{
    double most_m = (fmin(extent_m[0], extent_m[1]) + pixel_m) / 2;
    if (dem->wanted->cell_m > 0)
        return wd_error(dem->log, "terrain.cell_m: %g m is too much for %s, which is %g x %g m from middle "
                        "to middle of its outer pixels; at most %g m fit", dem->wanted->cell_m,
                        dem->source.path, extent_m[0], extent_m[1], most_m);
    return wd_error(dem->log, "%s: samples %g m apart do not fit into %g x %g m", dem->source.path,
                    cell_m, extent_m[0], extent_m[1]);
}

/* Sample (0, 0) is the centre of the south-west pixel, or of the south-west block of pixels. */
static bool choose_grid(struct dem *dem, struct wd_terrain *terrain)
{
    struct wd_frame_bounds bounds;
    if (!wd_source_bounds(&dem->source, &dem->map, &bounds, dem->log))
        return false;
    double extent_m[2], first_m[2];
    for (int axis = 0; axis < 2; axis++) {
        double pixel_m = bounds.pixel[axis];
        double length_m = bounds.max[axis] - bounds.min[axis];
        first_m[axis] = bounds.min[axis] + pixel_m / 2;
        int64_t range[2];
        if (!crop(dem, axis, first_m[axis], pixel_m, (int64_t)floor(length_m / pixel_m + 1e-6), range))
            return false;
        first_m[axis] += (double)range[0] * pixel_m;
        extent_m[axis] = (double)(range[1] - range[0]) * pixel_m;
    }
    double pixel_m = fmin(bounds.pixel[0], bounds.pixel[1]);
    double cell_m = choose_cell(dem, pixel_m, extent_m);
    dem->step = (int)fmax(1, floor(cell_m / pixel_m + 1e-6));
    double shift_m = (dem->step - 1) * pixel_m / 2;
    if (samples_of(fmin(extent_m[0], extent_m[1]) - 2 * shift_m, cell_m) < 2)
        return too_small(dem, extent_m, pixel_m, cell_m);
    for (int axis = 0; axis < 2; axis++) {
        extent_m[axis] -= 2 * shift_m;
        dem->first_m[axis] = terrain->origin_m[axis] = first_m[axis] + shift_m;
    }
    terrain->cell_m = cell_m;
    terrain->width = (uint32_t)samples_of(extent_m[0], cell_m);
    terrain->height = (uint32_t)samples_of(extent_m[1], cell_m);
    if (dem->step > 1)
        wd_info(dem->log, "%s: decimated: one sample for %d x %d pixels, %g m apart",
                dem->source.path, dem->step, dem->step, cell_m);
    return true;
}

static bool open_dem(struct dem *dem, const struct wd_scene *scene)
{
    const struct wd_scene_terrain *wanted = dem->wanted;
    struct wd_raster_source *source = &dem->source;
    if (!(isfinite(wanted->cell_m) && wanted->cell_m >= 0))
        return wd_error(dem->log, "terrain.cell_m: is %g, must be above 0", wanted->cell_m);
    if (!wd_source_open(source, scene->path, wanted->file, wanted->band, "terrain.file", dem->log))
        return false;
    if (source->width < 2 || source->height < 2)
        return wd_error(dem->log, "%s: is %d x %d pixels; at least 2 x 2 are wanted", source->path,
                        source->width, source->height);
    return find_source_crs(dem) && find_position(dem) && find_frame(dem) &&
           wd_pixel_map_init(&dem->map, source, dem->source_crs, dem->frame, dem->log);
}

/* Reads the blocks and fills their gaps. */
static bool read_blocks(struct dem *dem, const struct wd_progress *progress)
{
    const struct wd_source_blocks *blocks = &dem->blocks;
    size_t count = (size_t)blocks->columns * blocks->rows;
    dem->block_m = wd_alloc_array(count, sizeof(float));
    struct wd_missing_rule rule = {.extra = dem->wanted->nodata, .heights = true,
                                   .vertical_scale = dem->wanted->vertical_scale};
    if (!wd_source_read(&dem->source, blocks, WD_REDUCE_MEAN, &rule, dem->block_m, progress,
                        dem->log))
        return false;
    uint64_t missing = 0;
    for (size_t i = 0; i < count; i++)
        missing += isnan(dem->block_m[i]) != 0;
    if (missing == count)
        return wd_error(dem->log, "%s: has no data here: all %zu pixels are missing",
                        dem->source.path, count);
    if (missing == 0)
        return true;
    dem->block_missing = wd_alloc_array(count, 1);
    for (size_t i = 0; i < count; i++)
        dem->block_missing[i] = isnan(dem->block_m[i]) != 0;
    wd_fill_missing(dem->block_m, (uint32_t)blocks->columns, (uint32_t)blocks->rows);
    return true;
}

struct resampling {
    const struct dem *dem;
    struct wd_terrain *terrain;
    double slack;         /* blocks that a sample may lie beyond the outermost centres */
    uint8_t *missing;     /* per sample: 1 no data; 2 outside the source */
};

/* Exactly on a pixel's centre where only rounding says otherwise. */
static double snapped(double at)
{
    double near = nearbyint(at);
    return fabs(at - near) < 1e-6 ? near : at;
}

static uint8_t resample_one(const struct resampling *work, uint32_t i, uint32_t j, float *height_m)
{
    const struct dem *dem = work->dem;
    const struct wd_source_blocks *blocks = &dem->blocks;
    double u, v;
    wd_mapping_at(&dem->mapping, i, j, &u, &v);
    u = snapped((u - blocks->x) / blocks->step - 0.5);
    v = snapped((v - blocks->y) / blocks->step - 0.5);
    double right = blocks->columns - 1 + work->slack, bottom = blocks->rows - 1 + work->slack;
    if (!(u >= -work->slack && v >= -work->slack && u <= right && v <= bottom)) {
        *height_m = NAN;
        return 2;
    }
    *height_m = wd_sample_smooth(dem->block_m, (uint32_t)blocks->columns, (uint32_t)blocks->rows,
                                 u, v);
    if (!dem->block_missing)
        return 0;
    int column = (int)fmin(fmax(nearbyint(u), 0), blocks->columns - 1);
    int row = (int)fmin(fmax(nearbyint(v), 0), blocks->rows - 1);
    return dem->block_missing[(size_t)row * blocks->columns + column];
}

static void resample_row(void *user, size_t j)
{
    const struct resampling *work = user;
    size_t at = j * work->terrain->width;
    for (uint32_t i = 0; i < work->terrain->width; i++, at++)
        work->missing[at] = resample_one(work, i, (uint32_t)j, &work->terrain->height_m[at]);
}

static void resample(const struct dem *dem, struct wd_terrain *terrain)
{
    size_t count = (size_t)terrain->width * terrain->height;
    struct resampling work = {dem, terrain, dem->step > 1 ? 1.0 : 0.51, wd_alloc_array(count, 1)};
    terrain->height_m = wd_alloc_array(count, sizeof(float));
    wd_jobs_run(terrain->threads, terrain->height, resample_row, &work);
    bool outside = false;
    for (size_t i = 0; i < count; i++) {
        terrain->filled_samples += work.missing[i] != 0;
        outside = outside || work.missing[i] == 2;
        work.missing[i] = work.missing[i] != 0;
    }
    if (outside)
        wd_fill_missing(terrain->height_m, terrain->width, terrain->height);
    if (terrain->filled_samples > 0 && dem->wanted->nodata_rule == WD_NODATA_CUT)
        terrain->hole = work.missing;
    else
        free(work.missing);
}

static bool read_dem(struct dem *dem, struct wd_terrain *terrain,
                     const struct wd_progress *progress)
{
    double step_m[2] = {terrain->cell_m, terrain->cell_m};
    wd_mapping_init(&dem->mapping, &dem->map, terrain->width, terrain->height, dem->first_m,
                    step_m);
    if (!wd_source_blocks_over(&dem->source, &dem->mapping, dem->step, &dem->blocks))
        return wd_error(dem->log, "%s: does not reach into terrain.window_m", dem->source.path);
    if (!read_blocks(dem, progress))
        return false;
    resample(dem, terrain);
    double scale = dem->wanted->vertical_scale;
    size_t count = (size_t)terrain->width * terrain->height;
    if (scale != 0 && scale != 1)
        for (size_t i = 0; i < count; i++)
            terrain->height_m[i] *= (float)scale;
    if (terrain->filled_samples > 0)
        wd_info(dem->log, "%s: %llu of %zu samples have no data: %s", dem->source.path,
                (unsigned long long)terrain->filled_samples, count,
                terrain->hole ? "cut out" : "filled from their surroundings");
    if (dem->frame)
        terrain->crs = wd_crs_wkt(dem->frame);
    return true;
}

bool wd_terrain_read_raster(struct wd_terrain *terrain, const struct wd_scene *scene,
                            uint64_t max_samples, const struct wd_progress *progress,
                            const struct wd_log *log)
{
    struct dem dem = {.wanted = &scene->terrain, .max_samples = max_samples, .log = log};
    double scale = scene->terrain.vertical_scale;
    bool ok = isfinite(scale) ||
              wd_error(log, "terrain.vertical_scale: is %g, a finite number is wanted", scale);
    ok = ok && open_dem(&dem, scene) && choose_grid(&dem, terrain) &&
         read_dem(&dem, terrain, progress);
    dem_finish(&dem);
    return ok;
}
