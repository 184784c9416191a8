/* made_raster.h: small rasters made in memory through GDAL, for tests. */
#ifndef WD_TESTS_MADE_RASTER_H
#define WD_TESTS_MADE_RASTER_H

#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal.h>
#include <math.h>
#include <ogr_srs_api.h>
#include <stdio.h>
#include <stdlib.h>

struct made_raster {
    const char *name;         /* "/vsimem/..." */
    int width, height;
    const double *affine;     /* 6, or NULL: none */
    int epsg;                 /* 0: none */
    GDALDataType type;        /* 0: Float32 */
    const double *nodata;     /* NULL: none */
    const char *unit;         /* NULL: none */
    const char *options[6];   /* of GTiff */
    const float *values;      /* NULL: none written */
};

/* Left open: close it after what else is to be written. */
static GDALDatasetH make_raster_open(const struct made_raster *made)
{
    GDALAllRegister();
    char **options = NULL;
    for (int i = 0; i < 6 && made->options[i]; i++)
        options = CSLAddString(options, made->options[i]);
    GDALDatasetH dataset = GDALCreate(GDALGetDriverByName("GTiff"), made->name, made->width,
                                      made->height, 1, made->type ? made->type : GDT_Float32,
                                      options);
    CSLDestroy(options);
    if (!dataset)
        abort();
    if (made->affine)
        GDALSetGeoTransform(dataset, (double *)made->affine);
    if (made->epsg) {
        OGRSpatialReferenceH crs = OSRNewSpatialReference(NULL);
        OSRImportFromEPSG(crs, made->epsg);
        GDALSetSpatialRef(dataset, crs);
        OSRDestroySpatialReference(crs);
    }
    GDALRasterBandH band = GDALGetRasterBand(dataset, 1);
    if (made->nodata)
        GDALSetRasterNoDataValue(band, *made->nodata);
    if (made->unit)
        GDALSetRasterUnitType(band, made->unit);
    if (made->values && GDALRasterIO(band, GF_Write, 0, 0, made->width, made->height,
                                     (void *)made->values, made->width, made->height, GDT_Float32,
                                     0, 0) != CE_None)
        abort();
    return dataset;
}

static void make_raster(const struct made_raster *made)
{
    GDALClose(make_raster_open(made));
}

/* Undoes what tests leave in memory: for a group's teardown. */
static int made_rasters_forget(void **state)
{
    (void)state;
    char **names = VSIReadDir("/vsimem/");
    for (int i = 0; names && names[i]; i++) {
        char path[256];
        snprintf(path, sizeof path, "/vsimem/%s", names[i]);
        VSIUnlink(path);
    }
    CSLDestroy(names);
    GDALDestroyDriverManager();
    return 0;
}

#endif
