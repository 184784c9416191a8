#include "world/raster_crs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/log.h"
#include "base/memory.h"
#include "world/raster.h"
#include "world/terrain_parts.h"

static void CPL_STDCALL on_message(CPLErr class, CPLErrorNum number, const char *message)
{
    (void)number;
    struct wd_gdal_scope *scope = CPLGetErrorHandlerUserData();
    char *kept = class == CE_Warning ? scope->warning : scope->failure;
    size_t size = sizeof scope->warning;
    if (class == CE_None || class == CE_Debug || strncmp(kept, message, size - 1) == 0)
        return;
    strncpy(kept, message, size - 1);
    for (char *at = kept; *at; at++)
        if (*at == '\n' || *at == '\r')
            *at = ' ';
    if (class == CE_Warning)
        wd_warn(scope->log, "%s: %s", scope->subject, kept);
}

void wd_gdal_enter(struct wd_gdal_scope *scope, const char *subject, const struct wd_log *log)
{
    *scope = (struct wd_gdal_scope){.log = log, .subject = subject};
    CPLPushErrorHandlerEx(on_message, scope);
}

void wd_gdal_leave(struct wd_gdal_scope *scope)
{
    (void)scope;
    CPLPopErrorHandler();
}

const char *wd_gdal_reason(struct wd_gdal_scope *scope)
{
    size_t length = strlen(scope->failure);
    if (length == 0)
        return "";
    if (strncmp(scope->failure, ": ", 2) != 0) {
        if (length > sizeof scope->failure - 3)
            length = sizeof scope->failure - 3;
        memmove(scope->failure + 2, scope->failure, length);
        memcpy(scope->failure, ": ", 2);
        scope->failure[length + 2] = '\0';
    }
    return scope->failure;
}

OGRSpatialReferenceH wd_crs_parse(const char *crs, const char *subject, const struct wd_log *log)
{
    if (!wd_gdal_load(subject, log))
        return NULL;
    struct wd_gdal_scope scope;
    wd_gdal_enter(&scope, subject, log);
    OGRSpatialReferenceH parsed = OSRNewSpatialReference(NULL);
    /* Nothing is fetched from elsewhere. */
    bool ok = !strstr(crs, "://") && OSRSetFromUserInput(parsed, crs) == OGRERR_NONE;
    if (!ok) {
        wd_error(log, "%s: \"%s\" is not a coordinate system; wanted is e.g. \"EPSG:32632\", or WKT%s",
                 subject, crs, wd_gdal_reason(&scope));
        OSRDestroySpatialReference(parsed);
        parsed = NULL;
    } else {
        OSRSetAxisMappingStrategy(parsed, OAMS_TRADITIONAL_GIS_ORDER);
    }
    wd_gdal_leave(&scope);
    return parsed;
}

/* Heights' own datum, which compound systems name, changes no place. */
static bool is_same_place(OGRSpatialReferenceH a, OGRSpatialReferenceH b)
{
    OGRSpatialReferenceH flat[2] = {wd_crs_copy(a), wd_crs_copy(b)};
    for (int i = 0; i < 2; i++)
        OSRDemoteTo2D(flat[i], NULL);
    bool same = OSRIsSame(flat[0], flat[1]);
    wd_crs_free(flat[0]);
    wd_crs_free(flat[1]);
    return same;
}

bool wd_crs_agree(OGRSpatialReferenceH own, const char *given, const char *subject, const struct wd_log *log)
{
    OGRSpatialReferenceH parsed = wd_crs_parse(given, subject, log);
    if (!parsed)
        return false;
    if (!is_same_place(own, parsed))
        wd_warn(log, "%s: \"%.60s\" has no effect: the file has a coordinate system of its own, which counts: %s",
                subject, given, OSRGetName(own));
    wd_crs_free(parsed);
    return true;
}

OGRSpatialReferenceH wd_crs_copy(OGRSpatialReferenceH crs)
{
    OGRSpatialReferenceH copy = crs ? OSRClone(crs) : NULL;
    if (copy)
        OSRSetAxisMappingStrategy(copy, OAMS_TRADITIONAL_GIS_ORDER);
    return copy;
}

void wd_crs_free(OGRSpatialReferenceH crs)
{
    if (crs)
        OSRDestroySpatialReference(crs);
}

/* A metre of Mercator's, and so of web maps, is one at the equator alone: at 50 degrees it is 64 cm. */
static bool is_mercator(OGRSpatialReferenceH crs)
{
    const char *projection = OSRGetAttrValue(crs, "PROJECTION", 0);
    return projection && strncmp(projection, "Mercator", strlen("Mercator")) == 0;
}

bool wd_crs_is_metric(OGRSpatialReferenceH crs)
{
    return OSRIsProjected(crs) && fabs(OSRGetLinearUnits(crs, NULL) - 1) < 1e-9 && !is_mercator(crs);
}

char *wd_crs_wkt(OGRSpatialReferenceH crs)
{
    char *text = NULL, *copy = NULL;
    if (OSRExportToWkt(crs, &text) == OGRERR_NONE && text)
        copy = wd_strdup(text);
    CPLFree(text);
    return copy;
}

OGRSpatialReferenceH wd_crs_utm_at(double longitude_deg, double latitude_deg)
{
    bool north = latitude_deg >= 0;
    longitude_deg -= 360 * floor((longitude_deg + 180) / 360);
    int zone = (int)floor((longitude_deg + 180) / 6) + 1;
    int code = (north ? 32600 : 32700) + (zone > 60 ? 60 : zone);
    if (latitude_deg > 84 || latitude_deg < -80)
        code = north ? 32661 : 32761;
    OGRSpatialReferenceH utm = OSRNewSpatialReference(NULL);
    if (OSRImportFromEPSG(utm, code) != OGRERR_NONE) {
        OSRDestroySpatialReference(utm);
        return NULL;
    }
    OSRSetAxisMappingStrategy(utm, OAMS_TRADITIONAL_GIS_ORDER);
    return utm;
}

char *wd_crs_wkt_in_metres(const char *crs, const struct wd_log *log)
{
    OGRSpatialReferenceH parsed = wd_crs_parse(crs, "terrain.target_crs", log);
    char *wkt = NULL;
    if (parsed && !wd_crs_is_metric(parsed))
        wd_error(log, "terrain.target_crs: \"%s\" is not a projected system in metres, as a UTM zone is", crs);
    else if (parsed)
        wkt = wd_crs_wkt(parsed);
    wd_crs_free(parsed);
    return wkt;
}

bool wd_crs_counts_metres(const char *crs, const char *subject, bool *metres, const struct wd_log *log)
{
    OGRSpatialReferenceH parsed = wd_crs_parse(crs, subject, log);
    *metres = parsed && OSRIsProjected(parsed) && fabs(OSRGetLinearUnits(parsed, NULL) - 1) < 1e-9;
    wd_crs_free(parsed);
    return parsed != NULL;
}

/* Returns the index of the first point that has no place there, which stays as it is, or `count`. */
static size_t transform(OGRCoordinateTransformationH change, double *x, double *y, size_t count)
{
    enum { CHUNK = 4096 };
    int done[CHUNK];
    for (size_t first = 0; first < count; first += CHUNK) {
        int n = count - first < CHUNK ? (int)(count - first) : CHUNK;
        double before_x[CHUNK], before_y[CHUNK];
        memcpy(before_x, x + first, n * sizeof *x);
        memcpy(before_y, y + first, n * sizeof *y);
        OCTTransformEx(change, n, x + first, y + first, NULL, done);
        for (int i = 0; i < n; i++)
            if (!done[i] || !isfinite(x[first + i]) || !isfinite(y[first + i])) {
                x[first + i] = before_x[i];
                y[first + i] = before_y[i];
                return first + i;
            }
    }
    return count;
}

char *wd_crs_in_metres_at(const char *crs, double x, double y, const char *subject,
                          const struct wd_log *log)
{
    OGRSpatialReferenceH parsed = wd_crs_parse(crs, subject, log);
    bool known = parsed != NULL, metric = known && wd_crs_is_metric(parsed);
    wd_crs_free(parsed);
    if (metric)
        return wd_strdup(crs);
    if (!known || !wd_reproject(crs, "EPSG:4326", &x, &y, 1, log))
        return NULL;
    OGRSpatialReferenceH utm = wd_crs_utm_at(x, y);
    char *wkt = utm ? wd_crs_wkt(utm) : NULL;
    if (!wkt)
        wd_error(log, "%s: there is no UTM zone at (%.9g, %.9g)", subject, x, y);
    wd_crs_free(utm);
    return wkt;
}

bool wd_reproject_some(const char *from_crs, const char *to_crs, double *x, double *y, size_t count,
                       size_t *placed, const struct wd_log *log)
{
    OGRSpatialReferenceH from = wd_crs_parse(from_crs, "coordinate system", log);
    OGRSpatialReferenceH to = from ? wd_crs_parse(to_crs, "coordinate system", log) : NULL;
    struct wd_gdal_scope scope;
    wd_gdal_enter(&scope, "reprojection", log);
    OGRCoordinateTransformationH change = to ? OCTNewCoordinateTransformation(from, to) : NULL;
    if (change)
        *placed = transform(change, x, y, count);
    else if (to)
        wd_error(log, "no way from \"%s\" to \"%s\"%s", from_crs, to_crs, wd_gdal_reason(&scope));
    if (change)
        OCTDestroyCoordinateTransformation(change);
    wd_gdal_leave(&scope);
    wd_crs_free(from);
    wd_crs_free(to);
    return change != NULL;
}

bool wd_reproject(const char *from_crs, const char *to_crs, double *x, double *y, size_t count,
                  const struct wd_log *log)
{
    size_t placed;
    return wd_reproject_some(from_crs, to_crs, x, y, count, &placed, log) &&
           (placed == count || wd_error(log, "%s: point %zu at (%.9g, %.9g) cannot be reprojected",
                                        from_crs, placed + 1, x[placed], y[placed]));
}
