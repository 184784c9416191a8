#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/memory.h"
#include "logged.h"
#include "made_raster.h"
#include "world/raster.h"
#include "world/terrain_parts.h"

/* NaN outside or where there is no data. */
static float raster_at(const struct wd_raster *raster, double x_m, double y_m)
{
    double u = x_m / raster->cell_x_m, v = y_m / raster->cell_y_m;
    if (!(u >= 0 && v >= 0 && u <= raster->width && v <= raster->height))
        return NAN;
    /* The far edges belong to the last cells: trees may stand exactly there. */
    uint32_t i = u < raster->width ? (uint32_t)u : raster->width - 1;
    uint32_t j = v < raster->height ? (uint32_t)v : raster->height - 1;
    return raster->values[(size_t)j * raster->width + i];
}

static struct logged logged;
static const struct wd_log log_kept = {logged_sink, &logged};
static const struct wd_scene scene = {.path = ""};

static int forget_log(void **state)
{
    (void)state;
    memset(&logged, 0, sizeof logged);
    return 0;
}

/* Flat ground at a place on Earth, or nowhere (crs NULL). */
static struct wd_terrain ground(const char *crs, double x_m, double y_m, double width_m,
                                double height_m)
{
    struct wd_scene flat = {.path = ""};
    double window_m[4] = {x_m, y_m, x_m + width_m, y_m + height_m};
    flat.terrain.window_m = window_m;
    flat.terrain.window_count = 4;
    flat.terrain.target_crs = crs;
    struct wd_terrain terrain;
    assert_true(wd_terrain_init(&terrain, &flat, 1, 0, 0, NULL, &log_kept));
    return terrain;
}

static struct wd_raster loaded(const struct wd_scene_map *map, const struct wd_terrain *terrain,
                               enum wd_resampling resampling)
{
    struct wd_raster raster;
    bool ok = wd_raster_load(&raster, &scene, map, terrain, resampling, 0, &log_kept);
    if (!ok)
        print_message("%s", logged.text);
    assert_true(ok);
    return raster;
}

static void assert_refused(const struct wd_scene_map *map, const struct wd_terrain *terrain,
                           const char *part)
{
    struct wd_raster raster;
    forget_log(NULL);
    assert_false(wd_raster_load(&raster, &scene, map, terrain, WD_RESAMPLE_LINEAR, 0, &log_kept));
    assert_null(raster.values);
    assert_int_equal(logged.errors, 1);
    if (!strstr(logged.text, part))
        fail_msg("\"%s\" does not say \"%s\"", logged.text, part);
}

static const double utm_10m[6] = {500000, 10, 0, 5000040, 0, -10};
static const float classes[20] = {11, 41, 41, 42, 43, 11, 41, 81, 82, 43,
                                  11, 90, 81, 82, 95, 21, 90, 90, 82, 95};

static void make_classes(const char *name, int epsg, const double *affine)
{
    const double nodata = 21;
    make_raster(&(struct made_raster){.name = name, .width = 5, .height = 4, .affine = affine,
                                      .epsg = epsg, .type = GDT_Byte, .nodata = &nodata,
                                      .values = classes});
}

static void classes_stay_what_they_are(void **state)
{
    (void)state;
    make_classes("/vsimem/classes.tif", 32632, utm_10m);
    struct wd_terrain terrain = ground("EPSG:32632", 500000, 5000000, 50, 40);
    struct wd_scene_map map = {.file = "/vsimem/classes.tif"};
    struct wd_raster raster = loaded(&map, &terrain, WD_RESAMPLE_NEAREST);
    assert_int_equal(raster.width, 5);
    assert_int_equal(raster.height, 4);
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 5; i++) {
            float class = raster_at(&raster, i * 10 + 3, j * 10 + 7);
            if (classes[(3 - j) * 5 + i] == 21)
                assert_true(isnan(class)); /* the file's no-data value */
            else
                assert_float_equal(class, classes[(3 - j) * 5 + i], 0);
        }
    assert_true(isnan(raster_at(&raster, -0.01, 5)));
    assert_true(isnan(raster_at(&raster, 5, 40.01)));
    assert_true(isnan(raster_at(&raster, NAN, 5)));
    assert_float_equal(raster_at(&raster, 50, 40), 43, 0);
    wd_raster_finish(&raster);
    wd_terrain_finish(&terrain);
}

static void rasters_that_cover_a_part_are_missing_elsewhere(void **state)
{
    (void)state;
    make_classes("/vsimem/classes.tif", 32632, utm_10m);
    struct wd_terrain terrain = ground("EPSG:32632", 500020, 4999980, 100, 40);
    struct wd_scene_map map = {.file = "/vsimem/classes.tif"};
    struct wd_raster raster = loaded(&map, &terrain, WD_RESAMPLE_NEAREST);
    assert_float_equal(raster_at(&raster, 5, 25), 90, 0);
    assert_float_equal(raster_at(&raster, 25, 35), 95, 0);
    assert_true(isnan(raster_at(&raster, 5, 15)));
    assert_true(isnan(raster_at(&raster, 35, 35)));
    wd_raster_finish(&raster);
    wd_terrain_finish(&terrain);
    terrain = ground("EPSG:32632", 500050, 5000000, 100, 40);
    assert_refused(&map, &terrain, "does not overlap");
    wd_terrain_finish(&terrain);
    terrain = ground("EPSG:32618", 500000, 5000000, 100, 40);
    assert_refused(&map, &terrain, "does not overlap");
    wd_terrain_finish(&terrain);
}

static void local_rasters_are_stretched(void **state)
{
    (void)state;
    make_classes("/vsimem/nowhere.tif", 0, NULL);
    struct wd_terrain terrain = ground(NULL, 0, 0, 1000, 500);
    struct wd_scene_map map = {.file = "/vsimem/nowhere.tif", .crs = "local"};
    struct wd_raster raster = loaded(&map, &terrain, WD_RESAMPLE_NEAREST);
    assert_int_equal(raster.width, 5);
    assert_float_equal(raster.cell_x_m, 200, 1e-9);
    assert_float_equal(raster.cell_y_m, 125, 1e-9);
    assert_float_equal(raster_at(&raster, 999, 1), 95, 0);
    assert_float_equal(raster_at(&raster, 1, 499), 11, 0);
    wd_raster_finish(&raster);
    map.crs = NULL;
    assert_refused(&map, &terrain, "\"local\"");
    wd_terrain_finish(&terrain);
}

static void frames_that_cannot_be_matched_are_refused(void **state)
{
    (void)state;
    make_classes("/vsimem/classes.tif", 32632, utm_10m);
    make_classes("/vsimem/nocrs.tif", 0, utm_10m);
    struct wd_terrain nowhere = ground(NULL, 500000, 5000000, 50, 40);
    struct wd_scene_map map = {.file = "/vsimem/classes.tif"};
    assert_refused(&map, &nowhere, "the terrain has none");
    map.file = "/vsimem/nocrs.tif"; /* both without: the same metres */
    struct wd_raster raster = loaded(&map, &nowhere, WD_RESAMPLE_NEAREST);
    assert_float_equal(raster_at(&raster, 15, 5), 90, 0);
    wd_raster_finish(&raster);
    wd_terrain_finish(&nowhere);
    struct wd_terrain somewhere = ground("EPSG:32632", 500000, 5000000, 50, 40);
    assert_refused(&map, &somewhere, "no coordinate system");
    map.crs = "EPSG:32632";
    raster = loaded(&map, &somewhere, WD_RESAMPLE_NEAREST);
    assert_float_equal(raster_at(&raster, 15, 5), 90, 0);
    wd_raster_finish(&raster);
    map.file = "/vsimem/absent.tif";
    assert_refused(&map, &somewhere, "/vsimem/absent.tif");
    map.file = NULL;
    assert_refused(&map, &somewhere, "names no file");
    wd_terrain_finish(&somewhere);
}

/* Cells half a pixel off: linear values lie halfway, maxima move but none is lost or doubled. */
static void linear_and_max_between_pixels(void **state)
{
    (void)state;
    enum { SIDE = 12 };
    static float values[SIDE * SIDE];
    for (int k = 0; k < SIDE * SIDE; k++)
        values[k] = k % SIDE;
    values[5 * SIDE + 4] = 40;
    values[2 * SIDE + 9] = NAN;
    make_raster(&(struct made_raster){.name = "/vsimem/canopy.tif", .width = SIDE, .height = SIDE,
                                      .affine = utm_10m, .epsg = 32632, .values = values});
    struct wd_terrain terrain = ground("EPSG:32632", 500015, 5000040 - 115, 100, 100);
    struct wd_scene_map map = {.file = "/vsimem/canopy.tif"};
    struct wd_raster linear = loaded(&map, &terrain, WD_RESAMPLE_LINEAR);
    assert_int_equal(linear.width, 10);
    assert_float_equal(linear.values[0], 1.5, 1e-5);
    assert_float_equal(linear.values[9], 10.5, 1e-5);
    struct wd_raster most = loaded(&map, &terrain, WD_RESAMPLE_MAX);
    int tops = 0, missing = 0;
    for (int k = 0; k < 100; k++) {
        tops += most.values[k] == 40;
        missing += isnan(most.values[k]);
    }
    assert_int_equal(tops, 1);
    assert_int_equal(missing, 1);
    wd_raster_finish(&linear);
    wd_raster_finish(&most);
    wd_terrain_finish(&terrain);
}

static void a_crs_beside_the_files_own_is_told(void **state)
{
    (void)state;
    make_raster(&(struct made_raster){.name = "/vsimem/own.tif", .width = 5, .height = 4, .affine = utm_10m, .epsg = 32632,
                                      .values = classes});
    struct wd_terrain terrain = ground("EPSG:32632", 500000, 5000000, 40, 40);
    struct wd_scene_map map = {.file = "/vsimem/own.tif", .crs = "EPSG:banana"};
    assert_refused(&map, &terrain, "/vsimem/own.tif: \"EPSG:banana\" is not a coordinate system");
    forget_log(NULL);
    for (int i = 0; i < 3; i++) {
        map.crs = i == 0 ? "EPSG:32632" : i == 1 ? "local" : "EPSG:25833";
        struct wd_raster raster = loaded(&map, &terrain, WD_RESAMPLE_NEAREST);
        assert_int_equal(logged.warnings, i == 2);
        wd_raster_finish(&raster);
    }
    assert_non_null(strstr(logged.text, "/vsimem/own.tif: \"EPSG:25833\" has no effect"));
    wd_terrain_finish(&terrain);
}

static void maxima_survive_decimation(void **state)
{
    (void)state;
    enum { SIDE = 100 };
    static float values[SIDE * SIDE];
    memset(values, 0, sizeof values);
    for (int top = 0; top < 25; top++)
        values[(top / 5 * 20 + 7 + top % 3) * SIDE + top % 5 * 20 + 3 + top % 7] = 20 + top;
    make_raster(&(struct made_raster){.name = "/vsimem/tops.tif", .width = SIDE, .height = SIDE,
                                      .affine = utm_10m, .epsg = 32632, .values = values});
    struct wd_terrain terrain = ground("EPSG:32632", 500000, 5000040 - 1000, 1000, 1000);
    struct wd_scene_map map = {.file = "/vsimem/tops.tif"};
    struct wd_raster raster;
    assert_true(wd_raster_load(&raster, &scene, &map, &terrain, WD_RESAMPLE_MAX, 625, &log_kept));
    assert_int_equal(raster.width, 25);
    int tops = 0;
    for (int k = 0; k < 625; k++)
        tops += raster.values[k] >= 20;
    assert_int_equal(tops, 25);
    wd_raster_finish(&raster);
    assert_true(wd_raster_load(&raster, &scene, &map, &terrain, WD_RESAMPLE_LINEAR, 625, &log_kept));
    double sum = 0;
    for (int k = 0; k < 625; k++)
        sum += raster.values[k] * 16;
    assert_float_equal(sum, 25 * 20 + 24 * 25 / 2, 0.01); /* means keep the sum */
    wd_raster_finish(&raster);
    wd_terrain_finish(&terrain);
}

static void points_are_reprojected(void **state)
{
    (void)state;
    double x[2] = {9, 10.5}, y[2] = {0, 47.25};
    assert_true(wd_reproject("EPSG:4326", "EPSG:32632", x, y, 2, &log_kept));
    assert_float_equal(x[0], 500000, 1e-6);
    assert_float_equal(y[0], 0, 1e-6);
    assert_float_equal(y[1], 5234000, 2500);
    assert_true(x[1] > 610000 && x[1] < 616000);
    assert_true(wd_reproject("EPSG:32632", "EPSG:4326", x, y, 2, &log_kept));
    assert_float_equal(x[1], 10.5, 1e-9);
    assert_float_equal(y[1], 47.25, 1e-9);
    assert_true(wd_reproject("EPSG:4326", "EPSG:32632", NULL, NULL, 0, &log_kept));
    assert_int_equal(logged.errors, 0);
    assert_false(wd_reproject("EPSG:nine", "EPSG:32632", x, y, 2, &log_kept));
    assert_false(wd_reproject("EPSG:4326", "", x, y, 2, &log_kept));
    double nowhere[2] = {INFINITY, 500}, high[2] = {0, 500};
    assert_false(wd_reproject("EPSG:4326", "EPSG:32632", nowhere, high, 2, &log_kept));
    assert_int_equal(logged.errors, 3);
}

static const char *data_file(const char *name)
{
    static char path[1024];
    snprintf(path, sizeof path, "%s/terrain/%s", WD_TEST_DATA, name);
    if (access(path, R_OK) != 0) {
        print_message("%s is not here: skipped\n", path);
        skip();
    }
    return path;
}

static float greatest_of(const struct wd_raster *raster)
{
    float most = -INFINITY;
    for (size_t k = 0; k < (size_t)raster->width * raster->height; k++)
        most = fmaxf(most, raster->values[k]);
    return most;
}

/* The raster's own grid as ground, placed by its own geotransform. */
static struct wd_terrain ground_under(const char *path, const char *crs)
{
    GDALAllRegister();
    GDALDatasetH dataset = GDALOpen(path, GA_ReadOnly);
    double t[6];
    GDALGetGeoTransform(dataset, t);
    double width_m = GDALGetRasterXSize(dataset) * t[1], height_m = GDALGetRasterYSize(dataset) * -t[5];
    GDALClose(dataset);
    return ground(crs, t[0], t[3] - height_m, width_m, height_m);
}

static void real_canopies(void **state)
{
    (void)state;
    const struct {
        const char *name, *crs;
        uint32_t width, height;
        double most_m;
    } canopies[] = {{"quesnel_chm_2m_utm10n.tif", "EPSG:32610", 746, 658, 42.9},
                    {"nouragues_chm_1m_utm22n.tif", "EPSG:32622", 535, 495, 60.5}};
    for (int i = 0; i < 2; i++) {
        struct wd_scene_map map = {.file = data_file(canopies[i].name)};
        struct wd_terrain terrain = ground_under(map.file, canopies[i].crs);
        struct wd_raster raster = loaded(&map, &terrain, WD_RESAMPLE_MAX);
        assert_int_equal(raster.width, canopies[i].width);
        assert_int_equal(raster.height, canopies[i].height);
        assert_float_equal(greatest_of(&raster), canopies[i].most_m, 0.06);
        wd_raster_finish(&raster);
        wd_terrain_finish(&terrain);
    }
}

/* Albers onto UTM: every cell has the class of the very pixel under its centre. */
static void real_land_cover(void **state)
{
    (void)state;
    struct wd_scene_map map = {.file = data_file("augusta_nlcd_30m_albers.tif")};
    GDALDatasetH dataset = GDALOpen(map.file, GA_ReadOnly);
    int width = GDALGetRasterXSize(dataset), height = GDALGetRasterYSize(dataset);
    float *pixels = wd_alloc_array((size_t)width * height, sizeof(float));
    assert_int_equal(GDALRasterIO(GDALGetRasterBand(dataset, 1), GF_Read, 0, 0, width, height,
                                  pixels, width, height, GDT_Float32, 0, 0), CE_None);
    double t[6];
    GDALGetGeoTransform(dataset, t);
    const char *albers = GDALGetProjectionRef(dataset);
    double x = t[0] + t[1] * width / 2, y = t[3] + t[5] * height / 2;
    assert_true(wd_reproject(albers, "EPSG:32617", &x, &y, 1, &log_kept));
    struct wd_terrain terrain = ground("EPSG:32617", x - 6000, y - 4000, 12000, 8000);
    struct wd_raster raster = loaded(&map, &terrain, WD_RESAMPLE_NEAREST);
    assert_true(raster.width > 380 && raster.width < 420);
    uint64_t water = 0, forest = 0;
    for (uint32_t j = 0; j < raster.height; j += 3)
        for (uint32_t i = 0; i < raster.width; i += 3) {
            x = terrain.origin_m[0] + (i + 0.5) * raster.cell_x_m;
            y = terrain.origin_m[1] + (j + 0.5) * raster.cell_y_m;
            assert_true(wd_reproject("EPSG:32617", albers, &x, &y, 1, &log_kept));
            double u = (x - t[0]) / t[1], v = (y - t[3]) / t[5];
            if (fabs(u - nearbyint(u)) < 1e-3 || fabs(v - nearbyint(v)) < 1e-3)
                continue; /* on a border between pixels */
            float class = raster.values[(size_t)j * raster.width + i];
            assert_float_equal(class, pixels[(size_t)v * width + (size_t)u], 0);
            water += class == 11;
            forest += class == 41 || class == 42 || class == 43;
        }
    assert_true(water > 0 && forest > 100);
    GDALClose(dataset);
    free(pixels);
    wd_raster_finish(&raster);
    wd_terrain_finish(&terrain);
}

static void drivers_that_the_host_destroys_come_back(void **state)
{
    (void)state;
    char file[] = "/tmp/weald-raster-XXXXXX"; /* what is in memory goes with them */
    int made = mkstemp(file);
    assert_true(made >= 0);
    close(made);
    make_classes(file, 0, NULL);
    struct wd_terrain terrain = ground(NULL, 0, 0, 1000, 500);
    struct wd_scene_map map = {.file = file, .crs = "local"};
    for (int i = 0; i < 2; i++) {
        struct wd_raster raster = loaded(&map, &terrain, WD_RESAMPLE_NEAREST);
        wd_raster_finish(&raster);
        GDALDestroyDriverManager();
    }
    wd_terrain_finish(&terrain);
    unlink(file);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(classes_stay_what_they_are, forget_log),
        cmocka_unit_test_setup(rasters_that_cover_a_part_are_missing_elsewhere, forget_log),
        cmocka_unit_test_setup(local_rasters_are_stretched, forget_log),
        cmocka_unit_test_setup(frames_that_cannot_be_matched_are_refused, forget_log),
        cmocka_unit_test_setup(linear_and_max_between_pixels, forget_log),
        cmocka_unit_test_setup(a_crs_beside_the_files_own_is_told, forget_log),
        cmocka_unit_test_setup(drivers_that_the_host_destroys_come_back, forget_log),
        cmocka_unit_test_setup(maxima_survive_decimation, forget_log),
        cmocka_unit_test_setup(points_are_reprojected, forget_log),
        cmocka_unit_test_setup(real_canopies, forget_log),
        cmocka_unit_test_setup(real_land_cover, forget_log),
    };
    return cmocka_run_group_tests(tests, NULL, made_rasters_forget);
}
