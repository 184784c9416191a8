#include "world/raster_source.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/file.h"
#include "base/log.h"
#include "base/memory.h"

/* Plain files are looked at first: GDAL says little about them. */
static bool check_file(const char *path, const char *key, const struct wd_log *log)
{
    struct stat info;
    if (strncmp(path, "/vsi", 4) == 0 || strchr(path, ':'))
        return true;
    if (stat(path, &info) != 0)
        return wd_error(log, "%s: %s: cannot be opened: %s", key, path, strerror(errno));
    if (S_ISREG(info.st_mode) && info.st_size == 0)
        return wd_error(log, "%s: %s: is empty", key, path);
    return true;
}

/* What GDAL reads no raster in may be what it reads points in. */
static const char *advice_for(const char *path)
{
    CPLPushErrorHandler(CPLQuietErrorHandler);
    GDALDatasetH vectors = GDALOpenEx(path, GDAL_OF_VECTOR | GDAL_OF_READONLY, NULL, NULL, NULL);
    CPLPopErrorHandler();
    if (!vectors)
        return "";
    GDALClose(vectors);
    return "; it holds vectors or a table: export trees as CSV, for a scene's inventories";
}

static bool open_band(struct wd_raster_source *source, int64_t band, const char *key,
                      struct wd_gdal_scope *scope)
{
    const struct wd_log *log = scope->log;
    source->dataset = GDALOpenEx(source->path, GDAL_OF_RASTER | GDAL_OF_READONLY, NULL, NULL, NULL);
    if (!source->dataset)
        return wd_error(log, "%s: %s: is not a raster that GDAL can read%s%s", key, source->path,
                        wd_gdal_reason(scope), advice_for(source->path));
    int bands = GDALGetRasterCount(source->dataset);
    if (bands == 0)
        return wd_error(log, "%s: %s: holds no raster itself; name one of its subdatasets", key,
                        source->path);
    if (band == 0)
        band = 1;
    if (band < 1 || band > bands)
        return wd_error(log, "%s: %s: band %lld is asked for, the file has 1 .. %d", key,
                        source->path, (long long)band, bands);
    source->band = GDALGetRasterBand(source->dataset, (int)band);
    source->width = GDALGetRasterXSize(source->dataset);
    source->height = GDALGetRasterYSize(source->dataset);
    if (GDALDataTypeIsComplex(GDALGetRasterDataType(source->band)))
        return wd_error(log, "%s: %s: has complex numbers, real ones are wanted", key, source->path);
    return true;
}

static void find_position(struct wd_raster_source *source)
{
    double *t = source->crs_of_pixel;
    source->has_affine = GDALGetGeoTransform(source->dataset, t) == CE_None &&
                         t[1] * t[5] - t[2] * t[4] != 0 && isfinite(t[0] + t[3]);
    source->has_position = source->has_affine || GDALGetGCPCount(source->dataset) > 2;
    OGRSpatialReferenceH crs = GDALGetSpatialRef(source->dataset);
    if (!crs && !source->has_affine)
        crs = GDALGetGCPSpatialRef(source->dataset);
    /* A local engineering system is none: it has no place on Earth. */
    if (crs && (OSRIsProjected(crs) || OSRIsGeographic(crs)))
        source->crs = wd_crs_copy(crs);
}

bool wd_source_open(struct wd_raster_source *source, const char *base, const char *name,
                    int64_t band, const char *key, const struct wd_log *log)
{
    *source = (struct wd_raster_source){0};
    if (!name || !name[0])
        return wd_error(log, "%s: names no file", key);
    if (!wd_gdal_load(key, log))
        return false;
    source->path = wd_path_beside(base, name);
    struct wd_gdal_scope scope;
    wd_gdal_enter(&scope, source->path, log);
    bool ok = check_file(source->path, key, log) && open_band(source, band, key, &scope) &&
              wd_source_check_text(source, log);
    if (ok)
        find_position(source);
    wd_gdal_leave(&scope);
    if (!ok)
        wd_source_finish(source);
    return ok;
}

void wd_source_finish(struct wd_raster_source *source)
{
    wd_crs_free(source->crs);
    if (source->dataset)
        GDALClose(source->dataset);
    free(source->path);
    *source = (struct wd_raster_source){0};
}
