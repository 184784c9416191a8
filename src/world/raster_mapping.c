/* raster_mapping.c: from places in a frame to pixels of a source. */
#include "world/raster_source.h"

#include <math.h>
#include <stdlib.h>

#include "base/log.h"
#include "base/memory.h"

static bool is_north_up(const struct wd_raster_source *source)
{
    return source->has_affine && source->crs_of_pixel[2] == 0 && source->crs_of_pixel[4] == 0;
}

static bool make_transformer(struct wd_pixel_map *map, struct wd_raster_source *source,
                             OGRSpatialReferenceH source_crs, OGRSpatialReferenceH frame,
                             const struct wd_log *log)
{
    struct wd_gdal_scope scope;
    wd_gdal_enter(&scope, source->path, log);
    char *from = source_crs ? wd_crs_wkt(source_crs) : NULL;
    char *to = frame ? wd_crs_wkt(frame) : NULL;
    char **options = NULL;
    if (from)
        options = CSLSetNameValue(options, "SRC_SRS", from);
    if (from && to)
        options = CSLSetNameValue(options, "DST_SRS", to);
    map->transformer = GDALCreateGenImgProjTransformer2(source->dataset, NULL, options);
    if (!map->transformer)
        wd_error(log, "%s: cannot be reprojected%s", source->path, wd_gdal_reason(&scope));
    CSLDestroy(options);
    free(from);
    free(to);
    wd_gdal_leave(&scope);
    return map->transformer != NULL;
}

bool wd_pixel_map_init(struct wd_pixel_map *map, struct wd_raster_source *source,
                       OGRSpatialReferenceH source_crs, OGRSpatialReferenceH frame,
                       const struct wd_log *log)
{
    *map = (struct wd_pixel_map){0};
    bool same = !frame || !source_crs || OSRIsSame(source_crs, frame);
    if (same && is_north_up(source))
        return GDALInvGeoTransform(source->crs_of_pixel, map->pixel_of_frame) ||
               wd_error(log, "%s: its pixels have no area", source->path);
    return make_transformer(map, source, source_crs, frame, log);
}

void wd_pixel_map_finish(struct wd_pixel_map *map)
{
    if (map->transformer)
        GDALDestroyGenImgProjTransformer(map->transformer);
    *map = (struct wd_pixel_map){0};
}

static void apply_transformer(void *transformer, int count, double *x, double *y)
{
    double *z = wd_alloc_array((size_t)count, sizeof *z);
    int *done = wd_alloc_array((size_t)count, sizeof *done);
    /* Points without an answer are told by NaN: their messages are of no use to anybody. */
    CPLPushErrorHandler(CPLQuietErrorHandler);
    GDALGenImgProjTransform(transformer, TRUE, count, x, y, z, done);
    CPLPopErrorHandler();
    for (int i = 0; i < count; i++)
        if (!done[i] || !isfinite(x[i]) || !isfinite(y[i]))
            x[i] = y[i] = NAN;
    free(z);
    free(done);
}

void wd_pixel_map_apply(const struct wd_pixel_map *map, int count, double *x, double *y)
{
    if (map->transformer) {
        apply_transformer(map->transformer, count, x, y);
        return;
    }
    const double *t = map->pixel_of_frame;
    for (int i = 0; i < count; i++) {
        double px = t[0] + x[i] * t[1] + y[i] * t[2];
        y[i] = t[3] + x[i] * t[4] + y[i] * t[5];
        x[i] = px;
    }
}

/* A file may say any place and size of its pixels; counts of pixels over what this lets through fit into int. */
static bool check_bounds(const struct wd_raster_source *source, const struct wd_frame_bounds *bounds,
                         const struct wd_log *log)
{
    const double farthest = 1e10, least_pixel = 1e-10, most_pixels = 1e9;
    double pixel = fmin(bounds->pixel[0], bounds->pixel[1]);
    for (int axis = 0; axis < 2; axis++) {
        double low = bounds->min[axis], high = bounds->max[axis];
        if (!(low > -farthest && high < farthest && bounds->pixel[axis] > 0 && pixel > least_pixel &&
              (high - low) / pixel < most_pixels))
            return wd_error(log, "%s: its georeference says pixels of %g x %g from (%g, %g) to (%g, %g), which is no "
                            "place on Earth", source->path, bounds->pixel[0], bounds->pixel[1], bounds->min[0],
                            bounds->min[1], bounds->max[0], bounds->max[1]);
    }
    return true;
}

bool wd_source_bounds(const struct wd_raster_source *source, const struct wd_pixel_map *map,
                      struct wd_frame_bounds *bounds, const struct wd_log *log)
{
    const double *t = source->crs_of_pixel;
    if (!map->transformer) {
        double size[2] = {source->width * t[1], source->height * t[5]};
        double corner[2] = {t[0], t[3]};
        for (int axis = 0; axis < 2; axis++) {
            bounds->min[axis] = fmin(corner[axis], corner[axis] + size[axis]);
            bounds->max[axis] = fmax(corner[axis], corner[axis] + size[axis]);
            bounds->pixel[axis] = fabs(t[axis ? 5 : 1]);
        }
        return check_bounds(source, bounds, log);
    }
    struct wd_gdal_scope scope;
    wd_gdal_enter(&scope, source->path, log);
    double affine[6], extent[4];
    int columns, rows;
    bool ok = GDALSuggestedWarpOutput2(source->dataset, GDALGenImgProjTransform, map->transformer,
                                       affine, &columns, &rows, extent, 0) == CE_None;
    if (!ok)
        wd_error(log, "%s: its outline cannot be reprojected%s", source->path,
                 wd_gdal_reason(&scope));
    else
        *bounds = (struct wd_frame_bounds){{extent[0], extent[1]}, {extent[2], extent[3]},
                                           {fabs(affine[1]), fabs(affine[5])}};
    wd_gdal_leave(&scope);
    return ok && check_bounds(source, bounds, log);
}

static uint32_t node_at(uint32_t kept, uint32_t samples)
{
    uint64_t at = (uint64_t)kept * WD_MAPPING_STEP;
    return at < samples ? (uint32_t)at : samples - 1;
}

static void widen(struct wd_mapping *mapping, double px, double py)
{
    if (isnan(px))
        return;
    mapping->min[0] = fmin(mapping->min[0], px);
    mapping->min[1] = fmin(mapping->min[1], py);
    mapping->max[0] = fmax(mapping->max[0], px);
    mapping->max[1] = fmax(mapping->max[1], py);
}

void wd_mapping_init(struct wd_mapping *mapping, const struct wd_pixel_map *map, uint32_t width,
                     uint32_t height, const double first[2], const double step[2])
{
    *mapping = (struct wd_mapping){
        .columns = (width - 1 + WD_MAPPING_STEP - 1) / WD_MAPPING_STEP + 1,
        .rows = (height - 1 + WD_MAPPING_STEP - 1) / WD_MAPPING_STEP + 1,
        .width = width, .height = height,
        .min = {INFINITY, INFINITY}, .max = {-INFINITY, -INFINITY}};
    size_t count = (size_t)mapping->columns * mapping->rows;
    mapping->px = wd_alloc_array(count, sizeof(double));
    mapping->py = wd_alloc_array(count, sizeof(double));
    for (uint32_t row = 0; row < mapping->rows; row++) {
        double *px = mapping->px + (size_t)row * mapping->columns;
        double *py = mapping->py + (size_t)row * mapping->columns;
        for (uint32_t column = 0; column < mapping->columns; column++) {
            px[column] = first[0] + node_at(column, width) * step[0];
            py[column] = first[1] + node_at(row, height) * step[1];
        }
        wd_pixel_map_apply(map, (int)mapping->columns, px, py);
        for (uint32_t column = 0; column < mapping->columns; column++)
            widen(mapping, px[column], py[column]);
    }
}

void wd_mapping_finish(struct wd_mapping *mapping)
{
    free(mapping->px);
    free(mapping->py);
    *mapping = (struct wd_mapping){0};
}

/* The kept node before, and the share of the way to the next. */
static double share(uint32_t at, uint32_t samples, uint32_t *before, uint32_t *after)
{
    *before = at / WD_MAPPING_STEP;
    uint32_t start = *before * WD_MAPPING_STEP, end = node_at(*before + 1, samples);
    *after = end > start ? *before + 1 : *before;
    return end > start ? (double)(at - start) / (end - start) : 0;
}

void wd_mapping_at(const struct wd_mapping *mapping, uint32_t i, uint32_t j, double *px, double *py)
{
    uint32_t west, east, south, north;
    double u = share(i, mapping->width, &west, &east), v = share(j, mapping->height, &south, &north);
    size_t sw = (size_t)south * mapping->columns + west, se = sw - west + east;
    size_t nw = (size_t)north * mapping->columns + west, ne = nw - west + east;
    const double *x = mapping->px, *y = mapping->py;
    double low = x[sw] + u * (x[se] - x[sw]), high = x[nw] + u * (x[ne] - x[nw]);
    *px = low + v * (high - low);
    low = y[sw] + u * (y[se] - y[sw]);
    high = y[nw] + u * (y[ne] - y[nw]);
    *py = low + v * (high - low);
}

static bool blocks_axis(double min, double max, int pixels, int step, int *first, int *count)
{
    double start = floor(min - step * 0.5 + 1e-6), end = max + step * 0.5 - 1e-6;
    if (!(end > 0 && min < pixels))
        return false;
    start -= 2.0 * step;
    if (start < 0)
        start += ceil(-start / step) * step;
    end = fmin(ceil((end - start) / step) + 2, floor((pixels - start) / step));
    if (end < 1)
        return false;
    *first = (int)start;
    *count = (int)end;
    return true;
}

bool wd_source_blocks_over(const struct wd_raster_source *source, const struct wd_mapping *mapping,
                           int step, struct wd_source_blocks *blocks)
{
    *blocks = (struct wd_source_blocks){.step = step};
    return mapping->min[0] <= mapping->max[0] &&
           blocks_axis(mapping->min[0], mapping->max[0], source->width, step, &blocks->x,
                       &blocks->columns) &&
           blocks_axis(mapping->min[1], mapping->max[1], source->height, step, &blocks->y,
                       &blocks->rows);
}
