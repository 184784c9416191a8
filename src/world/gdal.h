/* gdal.h: GDAL, which is loaded when the first raster or coordinate system is met: it brings a hundred libraries, whose linking
 * would be most of the start of a program that needs none of them. Its headers are included here alone. */
#ifndef WD_WORLD_GDAL_H
#define WD_WORLD_GDAL_H

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal.h>
#include <gdal_alg.h>
#include <ogr_srs_api.h>
#include <stdbool.h>

#include "base/log.h"

/* Must come before all else of GDAL; then its functions go by their own names. False, logged as about `subject`: there is
 * no GDAL here. Thread-safe. */
bool wd_gdal_load(const char *subject, const struct wd_log *log);

#define WD_GDAL_FUNCTIONS(X) \
    X(CPLGetErrorHandlerUserData) X(CPLPopErrorHandler) X(CPLPushErrorHandler) X(CPLPushErrorHandlerEx) \
    X(CPLQuietErrorHandler) X(CSLDestroy) X(CSLSetNameValue) X(GDALAllRegister) X(GDALClose) \
    X(GDALCreateGenImgProjTransformer2) X(GDALDataTypeIsComplex) X(GDALDestroyGenImgProjTransformer) \
    X(GDALGenImgProjTransform) X(GDALGetBlockSize) X(GDALGetDataCoverageStatus) X(GDALGetDatasetDriver) \
    X(GDALGetDriverCount) X(GDALGetDriverShortName) X(GDALGetGCPCount) X(GDALGetGCPSpatialRef) X(GDALGetGeoTransform) \
    X(GDALGetMaskBand) X(GDALGetMaskFlags) X(GDALGetRasterBand) X(GDALGetRasterCount) X(GDALGetRasterDataType) \
    X(GDALGetRasterNoDataValue) X(GDALGetRasterOffset) X(GDALGetRasterScale) X(GDALGetRasterUnitType) \
    X(GDALGetRasterXSize) X(GDALGetRasterYSize) X(GDALGetSpatialRef) X(GDALInvGeoTransform) X(GDALOpenEx) \
    X(GDALRasterIO) X(GDALSuggestedWarpOutput2) X(OCTDestroyCoordinateTransformation) \
    X(OCTNewCoordinateTransformation) X(OCTTransformEx) X(OSRClone) X(OSRDemoteTo2D) X(OSRDestroySpatialReference) \
    X(OSRExportToWkt) X(OSRGetAttrValue) X(OSRGetLinearUnits) X(OSRGetName) X(OSRImportFromEPSG) X(OSRIsGeographic) \
    X(OSRIsProjected) X(OSRIsSame) X(OSRNewSpatialReference) X(OSRSetAxisMappingStrategy) X(OSRSetFromUserInput) \
    X(VSIFCloseL) X(VSIFOpenL) X(VSIFReadL) X(VSIFree)

#define WD_GDAL_POINTER(name) __typeof__(name) *name;
extern struct wd_gdal_functions {
    WD_GDAL_FUNCTIONS(WD_GDAL_POINTER)
} wd_gdal;
#undef WD_GDAL_POINTER

#ifndef WD_GDAL_NAMES_ALONE
#define CPLGetErrorHandlerUserData wd_gdal.CPLGetErrorHandlerUserData
#define CPLPopErrorHandler wd_gdal.CPLPopErrorHandler
#define CPLPushErrorHandler wd_gdal.CPLPushErrorHandler
#define CPLPushErrorHandlerEx wd_gdal.CPLPushErrorHandlerEx
#define CPLQuietErrorHandler wd_gdal.CPLQuietErrorHandler
#define CSLDestroy wd_gdal.CSLDestroy
#define CSLSetNameValue wd_gdal.CSLSetNameValue
#define GDALAllRegister wd_gdal.GDALAllRegister
#define GDALClose wd_gdal.GDALClose
#define GDALCreateGenImgProjTransformer2 wd_gdal.GDALCreateGenImgProjTransformer2
#define GDALDataTypeIsComplex wd_gdal.GDALDataTypeIsComplex
#define GDALDestroyGenImgProjTransformer wd_gdal.GDALDestroyGenImgProjTransformer
#define GDALGenImgProjTransform wd_gdal.GDALGenImgProjTransform
#define GDALGetBlockSize wd_gdal.GDALGetBlockSize
#define GDALGetDataCoverageStatus wd_gdal.GDALGetDataCoverageStatus
#define GDALGetDatasetDriver wd_gdal.GDALGetDatasetDriver
#define GDALGetDriverCount wd_gdal.GDALGetDriverCount
#define GDALGetDriverShortName wd_gdal.GDALGetDriverShortName
#define GDALGetGCPCount wd_gdal.GDALGetGCPCount
#define GDALGetGCPSpatialRef wd_gdal.GDALGetGCPSpatialRef
#define GDALGetGeoTransform wd_gdal.GDALGetGeoTransform
#define GDALGetMaskBand wd_gdal.GDALGetMaskBand
#define GDALGetMaskFlags wd_gdal.GDALGetMaskFlags
#define GDALGetRasterBand wd_gdal.GDALGetRasterBand
#define GDALGetRasterCount wd_gdal.GDALGetRasterCount
#define GDALGetRasterDataType wd_gdal.GDALGetRasterDataType
#define GDALGetRasterNoDataValue wd_gdal.GDALGetRasterNoDataValue
#define GDALGetRasterOffset wd_gdal.GDALGetRasterOffset
#define GDALGetRasterScale wd_gdal.GDALGetRasterScale
#define GDALGetRasterUnitType wd_gdal.GDALGetRasterUnitType
#define GDALGetRasterXSize wd_gdal.GDALGetRasterXSize
#define GDALGetRasterYSize wd_gdal.GDALGetRasterYSize
#define GDALGetSpatialRef wd_gdal.GDALGetSpatialRef
#define GDALInvGeoTransform wd_gdal.GDALInvGeoTransform
#define GDALOpenEx wd_gdal.GDALOpenEx
#define GDALRasterIO wd_gdal.GDALRasterIO
#define GDALSuggestedWarpOutput2 wd_gdal.GDALSuggestedWarpOutput2
#define OCTDestroyCoordinateTransformation wd_gdal.OCTDestroyCoordinateTransformation
#define OCTNewCoordinateTransformation wd_gdal.OCTNewCoordinateTransformation
#define OCTTransformEx wd_gdal.OCTTransformEx
#define OSRClone wd_gdal.OSRClone
#define OSRDemoteTo2D wd_gdal.OSRDemoteTo2D
#define OSRDestroySpatialReference wd_gdal.OSRDestroySpatialReference
#define OSRExportToWkt wd_gdal.OSRExportToWkt
#define OSRGetAttrValue wd_gdal.OSRGetAttrValue
#define OSRGetLinearUnits wd_gdal.OSRGetLinearUnits
#define OSRGetName wd_gdal.OSRGetName
#define OSRImportFromEPSG wd_gdal.OSRImportFromEPSG
#define OSRIsGeographic wd_gdal.OSRIsGeographic
#define OSRIsProjected wd_gdal.OSRIsProjected
#define OSRIsSame wd_gdal.OSRIsSame
#define OSRNewSpatialReference wd_gdal.OSRNewSpatialReference
#define OSRSetAxisMappingStrategy wd_gdal.OSRSetAxisMappingStrategy
#define OSRSetFromUserInput wd_gdal.OSRSetFromUserInput
#define VSIFCloseL wd_gdal.VSIFCloseL
#define VSIFOpenL wd_gdal.VSIFOpenL
#define VSIFReadL wd_gdal.VSIFReadL
#define VSIFree wd_gdal.VSIFree
#endif

#endif
