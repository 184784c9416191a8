/* raster_crs.h: coordinate systems and the messages of GDAL. */
#ifndef WD_WORLD_RASTER_CRS_H
#define WD_WORLD_RASTER_CRS_H

#include "weald/types.h"
#include "world/gdal.h"

/* While entered, GDAL's warnings go to `log` and its last failure is kept for our own message;
 * nothing reaches standard error. Scopes nest; leave in the reverse order. */
struct wd_gdal_scope {
    const struct wd_log *log;
    const char *subject;   /* what the messages are about */
    char failure[512];     /* GDAL's last failure, or "" */
    char warning[512];     /* the last warning told: repetitions are left out */
};
void wd_gdal_enter(struct wd_gdal_scope *scope, const char *subject, const struct wd_log *log);
void wd_gdal_leave(struct wd_gdal_scope *scope);
/* ": <GDAL's last failure>" or "". */
const char *wd_gdal_reason(struct wd_gdal_scope *scope);

/* A coordinate system with x before y (longitude before latitude), or NULL with an error that
 * begins with `subject`. wd_crs_free accepts NULL. */
OGRSpatialReferenceH wd_crs_parse(const char *crs, const char *subject, const struct wd_log *log);
/* A file has `own`, the scene says `given`, which must be one, too, and is warned of where it is another; `subject`
 * names the key or the file. False, logged, where `given` is none. */
bool wd_crs_agree(OGRSpatialReferenceH own, const char *given, const char *subject, const struct wd_log *log);
OGRSpatialReferenceH wd_crs_copy(OGRSpatialReferenceH crs);
void wd_crs_free(OGRSpatialReferenceH crs);
/* Projected, in metres that are metres on the ground. */
bool wd_crs_is_metric(OGRSpatialReferenceH crs);
char *wd_crs_wkt(OGRSpatialReferenceH crs); /* free() it */
/* The UTM zone (polar stereographic near the poles) around a longitude and latitude on WGS 84. */
OGRSpatialReferenceH wd_crs_utm_at(double longitude_deg, double latitude_deg);

#endif
