/* A build without GDAL says so wherever a raster or a reprojection is asked for. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "logged.h"
#include "world/raster.h"
#include "world/terrain_parts.h"

static void everything_is_refused(void **state)
{
    (void)state;
    struct logged logged = {0};
    const struct wd_log log = {logged_sink, &logged};
    struct wd_scene scene = {.path = "", .terrain = {.kind = WD_TERRAIN_RASTER, .file = "dem.tif"}};
    struct wd_terrain terrain = {0};
    assert_false(wd_terrain_read_raster(&terrain, &scene, 100, NULL, &log));
    assert_non_null(strstr(logged.text, "dem.tif: this build has no GDAL"));
    assert_null(wd_crs_wkt_in_metres("EPSG:32632", &log));
    assert_null(wd_crs_in_metres_at("EPSG:4326", 9, 50, "t.csv", &log));
    struct wd_scene_map map = {.file = "cover.tif"};
    struct wd_raster raster;
    assert_false(wd_raster_load(&raster, &scene, &map, &terrain, WD_RESAMPLE_MAX, 0, &log));
    assert_null(raster.values);
    assert_non_null(strstr(logged.text, "cover.tif: this build has no GDAL"));
    double x = 1, y = 2;
    assert_false(wd_reproject("EPSG:4326", "EPSG:32632", &x, &y, 1, &log));
    assert_int_equal(logged.errors, 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(everything_is_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
