/* raster_read.c: values of a source, by blocks of pixels, window by window. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/log.h"
#include "base/memory.h"
#include "world/raster_source.h"

/* How raw values become values. */
struct decoding {
    float declared, extra;  /* NaN: none */
    double scale, offset;
    double metres;          /* of a value, to tell whether it can be a height */
    bool heights, masked;
    uint64_t undeclared;    /* pixels of heights no Earth has, taken as missing */
    float example;          /* one of them */
};

struct reading {
    struct wd_raster_source *source;
    const struct wd_source_blocks *blocks;
    enum wd_reduction reduction;
    int subset;             /* pixels read a block, each way */
    int tile_columns, tile_rows; /* blocks read at once */
    struct decoding decoding;
    float *raw;
    uint8_t *mask;          /* NULL: the file has none besides its no-data value */
    float *values;
};

static double metres_of_unit(const char *unit)
{
    static const char *const feet[] = {"ft", "feet", "foot", "foot_international"};
    for (size_t i = 0; unit && i < sizeof feet / sizeof feet[0]; i++)
        if (strcasecmp(unit, feet[i]) == 0)
            return 0.3048;
    if (unit && (strcasecmp(unit, "us survey foot") == 0 || strcasecmp(unit, "us-ft") == 0 ||
                 strcasecmp(unit, "ftus") == 0))
        return 1200.0 / 3937;
    return 1;
}

static struct decoding decoding_of(GDALRasterBandH band, const struct wd_missing_rule *rule)
{
    int has = 0;
    double declared = GDALGetRasterNoDataValue(band, &has);
    int flags = GDALGetMaskFlags(band);
    struct decoding decoding = {
        .declared = has ? (float)declared : NAN,
        .extra = (float)rule->extra,
        .scale = GDALGetRasterScale(band, NULL),
        .offset = GDALGetRasterOffset(band, NULL),
        /* exaggerated heights may be any, those of a smaller unit only once they are metres */
        .metres = rule->vertical_scale > 0 ? fmin(rule->vertical_scale, 1) : 1,
        .heights = rule->heights,
        .masked = (flags & (GMF_PER_DATASET | GMF_ALPHA)) != 0,
    };
    double metres = rule->heights ? metres_of_unit(GDALGetRasterUnitType(band)) : 1;
    decoding.scale *= metres;
    decoding.offset *= metres;
    return decoding;
}

static float decode(struct decoding *decoding, float raw)
{
    if (!isfinite(raw) || raw == decoding->declared || raw == decoding->extra)
        return NAN;
    float value = (float)(raw * decoding->scale + decoding->offset);
    double height_m = value * decoding->metres;
    bool absurd = raw == -9999 || raw == -32767 || raw == -32768 || height_m < -500 || height_m > 9000;
    if (decoding->heights && absurd) {
        decoding->undeclared++;
        decoding->example = raw;
        return NAN;
    }
    return value;
}

static void decode_tile(struct reading *reading, size_t count)
{
    for (size_t i = 0; i < count; i++)
        reading->raw[i] = reading->mask && !reading->mask[i] ? NAN
                                                             : decode(&reading->decoding,
                                                                      reading->raw[i]);
}

/* The subset x subset decoded values of one block. */
static float reduce(const struct reading *reading, const float *block, size_t stride)
{
    double sum = 0;
    int known = 0;
    float most = NAN;
    for (int j = 0; j < reading->subset; j++) {
        for (int i = 0; i < reading->subset; i++) {
            float value = block[j * stride + i];
            if (isnan(value))
                continue;
            known++;
            sum += value;
            most = fmaxf(most, value);
        }
    }
    return known == 0 || reading->reduction != WD_REDUCE_MEAN ? most : (float)(sum / known);
}

static void reduce_tile(struct reading *reading, int column, int row, int columns, int rows)
{
    size_t stride = (size_t)columns * reading->subset;
    for (int j = 0; j < rows; j++) {
        float *to = reading->values + (size_t)(row + j) * reading->blocks->columns + column;
        const float *from = reading->raw + j * stride * reading->subset;
        for (int i = 0; i < columns; i++)
            to[i] = reduce(reading, from + (size_t)i * reading->subset, stride);
    }
}

static bool read_band(struct reading *reading, GDALRasterBandH band, GDALDataType type, void *to,
                      int column, int row, int columns, int rows)
{
    const struct wd_source_blocks *blocks = reading->blocks;
    int x = blocks->x + column * blocks->step, y = blocks->y + row * blocks->step;
    return GDALRasterIO(band, GF_Read, x, y, columns * blocks->step, rows * blocks->step, to,
                        columns * reading->subset, rows * reading->subset, type, 0,
                        0) == CE_None;
}

/* Blocks of a sparse file that were never written need not be looked at one by one. */
static bool is_empty(const struct reading *reading, int column, int row, int columns, int rows)
{
    const struct wd_source_blocks *blocks = reading->blocks;
    if (isnan(reading->decoding.declared))
        return false;
    return GDALGetDataCoverageStatus(reading->source->band, blocks->x + column * blocks->step,
                                     blocks->y + row * blocks->step, columns * blocks->step,
                                     rows * blocks->step, GDAL_DATA_COVERAGE_STATUS_DATA,
                                     NULL) == GDAL_DATA_COVERAGE_STATUS_EMPTY;
}

static bool read_tile(struct reading *reading, int column, int row)
{
    const struct wd_source_blocks *blocks = reading->blocks;
    int columns = blocks->columns - column, rows = blocks->rows - row;
    columns = columns < reading->tile_columns ? columns : reading->tile_columns;
    rows = rows < reading->tile_rows ? rows : reading->tile_rows;
    size_t count = (size_t)columns * rows * reading->subset * reading->subset;
    if (is_empty(reading, column, row, columns, rows)) {
        for (size_t i = 0; i < count; i++)
            reading->raw[i] = NAN;
    } else {
        GDALRasterBandH band = reading->source->band;
        if (!read_band(reading, band, GDT_Float32, reading->raw, column, row, columns, rows))
            return false;
        if (reading->mask && !read_band(reading, GDALGetMaskBand(band), GDT_Byte, reading->mask,
                                        column, row, columns, rows))
            return false;
        decode_tile(reading, count);
    }
    reduce_tile(reading, column, row, columns, rows);
    return true;
}

/* As square as the file's own blocks allow: strips across the whole width are read whole. */
static void choose_tiles(struct reading *reading)
{
    enum { TILE_SAMPLES = 1 << 20 };
    int block_width = 0, block_height = 0;
    GDALGetBlockSize(reading->source->band, &block_width, &block_height);
    int side = 1024 / reading->subset;
    bool strips = block_width >= reading->source->width;
    reading->tile_columns = strips ? reading->blocks->columns : side;
    if (reading->tile_columns > reading->blocks->columns)
        reading->tile_columns = reading->blocks->columns;
    int rows = TILE_SAMPLES / (reading->tile_columns * reading->subset * reading->subset);
    reading->tile_rows = rows < 1 ? 1 : rows > side ? side : rows;
    if (reading->tile_rows > reading->blocks->rows)
        reading->tile_rows = reading->blocks->rows;
}

static bool read_tiles(struct reading *reading, const struct wd_progress *progress,
                       struct wd_gdal_scope *scope)
{
    const struct wd_source_blocks *blocks = reading->blocks;
    for (int row = 0; row < blocks->rows; row += reading->tile_rows) {
        for (int column = 0; column < blocks->columns; column += reading->tile_columns) {
            if (!wd_progress_report(progress, "raster rows", (uint64_t)row, (uint64_t)blocks->rows))
                return false;
            if (!read_tile(reading, column, row))
                return wd_error(scope->log, "%s: cannot be read%s", reading->source->path,
                                wd_gdal_reason(scope));
        }
    }
    return true;
}

bool wd_source_read(struct wd_raster_source *source, const struct wd_source_blocks *blocks,
                    enum wd_reduction reduction, const struct wd_missing_rule *rule, float *values,
                    const struct wd_progress *progress, const struct wd_log *log)
{
    struct reading reading = {.source = source, .blocks = blocks, .reduction = reduction,
                              .values = values};
    struct wd_gdal_scope scope;
    wd_gdal_enter(&scope, source->path, log);
    reading.decoding = decoding_of(source->band, rule);
    reading.subset = reduction == WD_REDUCE_CENTRE ? 1 : blocks->step > 4 ? 2 : blocks->step;
    if (reduction == WD_REDUCE_MAX && blocks->step > 4)
        reading.subset = 4;
    choose_tiles(&reading);
    size_t count = (size_t)reading.tile_columns * reading.tile_rows * reading.subset *
                   reading.subset;
    reading.raw = wd_alloc_array(count, sizeof(float));
    if (reading.decoding.masked)
        reading.mask = wd_alloc_array(count, 1);
    bool ok = read_tiles(&reading, progress, &scope);
    if (ok && reading.decoding.undeclared > 0)
        wd_warn(log, "%s: %llu pixels cannot be heights (such as %g); taken as no data",
                source->path, (unsigned long long)reading.decoding.undeclared,
                reading.decoding.example);
    free(reading.raw);
    free(reading.mask);
    wd_gdal_leave(&scope);
    return ok;
}
