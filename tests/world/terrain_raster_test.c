#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/clock.h"
#include "logged.h"
#include "made_raster.h"
#include "world/raster.h"

static struct logged logged;
static const struct wd_log log_kept = {logged_sink, &logged};

static int forget_log(void **state)
{
    (void)state;
    memset(&logged, 0, sizeof logged);
    return 0;
}

static struct wd_scene scene_of(const char *file)
{
    struct wd_scene scene = {.path = ""};
    scene.terrain = (struct wd_scene_terrain){.kind = WD_TERRAIN_RASTER, .file = file,
                                              .nodata = NAN};
    return scene;
}

static struct wd_terrain read_scene(const struct wd_scene *scene)
{
    struct wd_terrain terrain;
    bool ok = wd_terrain_init(&terrain, scene, 1, 0, 0, NULL, &log_kept);
    if (!ok)
        print_message("%s", logged.text);
    assert_true(ok);
    return terrain;
}

static struct wd_terrain read_file(const char *file)
{
    struct wd_scene scene = scene_of(file);
    return read_scene(&scene);
}

static void assert_refused(const struct wd_scene *scene, const char *part)
{
    struct wd_terrain terrain;
    forget_log(NULL);
    assert_false(wd_terrain_init(&terrain, scene, 1, 0, 0, NULL, &log_kept));
    assert_null(terrain.height_m);
    assert_int_equal(logged.errors, 1);
    if (!strstr(logged.text, part))
        fail_msg("\"%s\" does not say \"%s\"", logged.text, part);
}

static const double utm_2m[6] = {500000, 2, 0, 5000000, 0, -2};
static const float five_by_four[20] = {10, 11, 12, 13, 14, 20, 21, 22, 23, 24,
                                       30, 31, 32, 33, 34, 40, 41, 42, 43, 44};

static void assert_five_by_four(const struct wd_terrain *terrain)
{
    assert_int_equal(terrain->width, 5);
    assert_int_equal(terrain->height, 4);
    assert_float_equal(terrain->cell_m, 2, 0);
    assert_float_equal(terrain->origin_m[0], 500001, 1e-9); /* centre of the south-west pixel */
    assert_float_equal(terrain->origin_m[1], 4999993, 1e-9);
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 5; i++)
            assert_float_equal(terrain->height_m[j * 5 + i], five_by_four[(3 - j) * 5 + i], 0);
    assert_non_null(strstr(terrain->crs, "32632"));
    assert_int_equal(terrain->filled_samples, 0);
    assert_null(terrain->hole);
}

static void samples_are_pixel_centres_from_the_south_west(void **state)
{
    (void)state;
    make_raster(&(struct made_raster){.name = "/vsimem/plain.tif", .width = 5, .height = 4,
                                      .affine = utm_2m, .epsg = 32632, .values = five_by_four});
    struct wd_terrain terrain = read_file("/vsimem/plain.tif");
    assert_five_by_four(&terrain);
    wd_terrain_finish(&terrain);
}

static void south_up_files_are_turned(void **state)
{
    (void)state;
    float flipped[20];
    for (int j = 0; j < 4; j++)
        memcpy(flipped + j * 5, five_by_four + (3 - j) * 5, 5 * sizeof(float));
    const double affine[6] = {500000, 2, 0, 4999992, 0, 2};
    make_raster(&(struct made_raster){.name = "/vsimem/south.tif", .width = 5, .height = 4,
                                      .affine = affine, .epsg = 32632, .values = flipped});
    struct wd_terrain terrain = read_file("/vsimem/south.tif");
    assert_five_by_four(&terrain);
    wd_terrain_finish(&terrain);
}

static void georeferences_beyond_earth_are_told(void **state)
{
    (void)state;
    static const double affines[][6] = {{500000, 1e80, 0, 5000000, 0, -1e80},
                                        {500000, 2, 0, 1e200, 0, -2},
                                        {500000, 1e-200, 0, 5000000, 0, -1e-200},
                                        {500000, 2, 0, 5000000, 0, -1e9}};
    for (size_t i = 0; i < sizeof affines / sizeof *affines; i++) {
        make_raster(&(struct made_raster){.name = "/vsimem/far.tif", .width = 5, .height = 4, .affine = affines[i],
                                          .epsg = 32632, .values = five_by_four});
        const struct wd_scene scene = scene_of("/vsimem/far.tif");
        assert_refused(&scene, i == 2 ? "far.tif" : "no place on Earth");
    }
}

static double plane_m(double x_m, double y_m)
{
    return 300 + 0.3 * (x_m - 500000) + 0.1 * (y_m - 5000000);
}

/* Pixels of 4 m turned by atan(3/4). */
static void rotated_files_are_straightened(void **state)
{
    (void)state;
    enum { SIDE = 50 };
    const double affine[6] = {500000, 3.2, 2.4, 5000000, 2.4, -3.2};
    static float values[SIDE * SIDE];
    for (int k = 0; k < SIDE * SIDE; k++) {
        double px = k % SIDE + 0.5, py = k / SIDE + 0.5;
        values[k] = (float)plane_m(affine[0] + px * affine[1] + py * affine[2],
                                   affine[3] + px * affine[4] + py * affine[5]);
    }
    make_raster(&(struct made_raster){.name = "/vsimem/turned.tif", .width = SIDE, .height = SIDE,
                                      .affine = affine, .epsg = 32632, .values = values});
    struct wd_scene scene = scene_of("/vsimem/turned.tif");
    scene.terrain.nodata_rule = WD_NODATA_CUT;
    struct wd_terrain terrain = read_scene(&scene);
    double extent_m = SIDE * (3.2 + 2.4);
    assert_float_equal(wd_terrain_extent_x_m(&terrain), extent_m, 12);
    assert_float_equal(wd_terrain_extent_y_m(&terrain), extent_m, 12);
    double inside = 0, worst = 0;
    for (double y = 0; y < extent_m; y += 3)
        for (double x = 0; x < extent_m; x += 3) {
            if (!wd_terrain_contains(&terrain, x, y))
                continue;
            inside += 9;
            double there_m = plane_m(terrain.origin_m[0] + x, terrain.origin_m[1] + y);
            worst = fmax(worst, fabs(wd_terrain_height(&terrain, x, y) - there_m));
        }
    assert_float_equal(inside, SIDE * SIDE * 16, SIDE * SIDE * 16 * 0.05);
    assert_true(worst < 1.2); /* at the very edge the last pixel's height is held */
    assert_true(terrain.filled_samples > 0);
    wd_terrain_finish(&terrain);
}

static const float pit_values[] = {-7777, -9999, -32768, NAN, -12345, 20000, 32767, 0};

/* 8 pits of 2 x 2 pixels in a plane about 500. */
static void make_pits(const char *name, const double *nodata)
{
    enum { WIDTH = 40, HEIGHT = 20 };
    static float values[WIDTH * HEIGHT];
    for (int k = 0; k < WIDTH * HEIGHT; k++)
        values[k] = 500 + k % WIDTH;
    for (int pit = 0; pit < 8; pit++)
        for (int part = 0; part < 4; part++)
            values[(9 + part / 2) * WIDTH + 2 + pit * 5 + part % 2] = pit_values[pit];
    make_raster(&(struct made_raster){.name = name, .width = WIDTH, .height = HEIGHT,
                                      .affine = utm_2m, .epsg = 32632, .nodata = nodata,
                                      .values = values});
}

static void missing_heights_never_become_pits(void **state)
{
    (void)state;
    const double nodata = -7777;
    make_pits("/vsimem/pits.tif", &nodata);
    struct wd_scene scene = scene_of("/vsimem/pits.tif");
    scene.terrain.nodata = 0;
    struct wd_terrain terrain = read_scene(&scene);
    assert_int_equal(terrain.filled_samples, 32);
    assert_int_equal(logged.warnings, 1);
    assert_non_null(strstr(logged.text, "20 pixels cannot be heights"));
    for (uint32_t k = 0; k < terrain.width * terrain.height; k++)
        assert_float_equal(terrain.height_m[k], 500 + k % terrain.width, 0.75);
    assert_null(terrain.hole);
    wd_terrain_finish(&terrain);
}

static void missing_heights_can_be_cut_out(void **state)
{
    (void)state;
    const double nodata = -7777;
    make_pits("/vsimem/pits.tif", &nodata);
    struct wd_scene scene = scene_of("/vsimem/pits.tif");
    scene.terrain.nodata = 0;
    scene.terrain.nodata_rule = WD_NODATA_CUT;
    struct wd_terrain terrain = read_scene(&scene);
    uint64_t holes = 0;
    for (uint32_t k = 0; k < terrain.width * terrain.height; k++)
        holes += terrain.hole[k];
    assert_int_equal(holes, 32);
    assert_true(terrain.hole[(19 - 9) * 40 + 2] && terrain.hole[(19 - 10) * 40 + 3]);
    assert_false(wd_terrain_contains(&terrain, 2 * 2 + 1, (19 - 10) * 2 + 1));
    assert_true(wd_terrain_contains(&terrain, 1, 1));
    assert_true(terrain.min_m >= 499);
    wd_terrain_finish(&terrain);
}

static void masks_count_as_missing(void **state)
{
    (void)state;
    CPLSetConfigOption("GDAL_TIFF_INTERNAL_MASK", "YES");
    GDALDatasetH dataset = make_raster_open(
        &(struct made_raster){.name = "/vsimem/mask.tif", .width = 5, .height = 4,
                              .affine = utm_2m, .epsg = 32632, .values = five_by_four});
    GDALCreateDatasetMaskBand(dataset, GMF_PER_DATASET);
    GByte mask[20];
    memset(mask, 255, sizeof mask);
    mask[7] = 0;
    assert_int_equal(GDALRasterIO(GDALGetMaskBand(GDALGetRasterBand(dataset, 1)), GF_Write, 0, 0, 5,
                                  4, mask, 5, 4, GDT_Byte, 0, 0), CE_None);
    GDALClose(dataset);
    CPLSetConfigOption("GDAL_TIFF_INTERNAL_MASK", NULL);
    struct wd_terrain terrain = read_file("/vsimem/mask.tif");
    assert_int_equal(terrain.filled_samples, 1);
    assert_float_equal(terrain.height_m[2 * 5 + 2], 22, 3);
    wd_terrain_finish(&terrain);
}

static void bad_files_are_refused_clearly(void **state)
{
    (void)state;
    char name[] = "/tmp/weald-terrain-XXXXXX";
    int file = mkstemp(name);
    assert_true(file >= 0);
    struct wd_scene scene = scene_of(name);
    assert_refused(&scene, "is empty");
    assert_int_equal(write(file, "not a raster at all", 19), 19);
    assert_refused(&scene, "is not a raster that GDAL can read");
    close(file);
    unlink(name);
    assert_refused(&scene, "No such file");
    scene.terrain.file = "/tmp";
    assert_refused(&scene, "/tmp");
    scene.terrain.file = NULL;
    assert_refused(&scene, "terrain.file");

    float one = 5, none[4] = {-1, -1, -1, -1};
    const double nodata = -1;
    make_raster(&(struct made_raster){.name = "/vsimem/one.tif", .width = 1, .height = 1,
                                      .affine = utm_2m, .epsg = 32632, .values = &one});
    scene = scene_of("/vsimem/one.tif");
    assert_refused(&scene, "1 x 1");
    make_raster(&(struct made_raster){.name = "/vsimem/none.tif", .width = 2, .height = 2,
                                      .affine = utm_2m, .epsg = 32632, .values = none,
                                      .nodata = &nodata});
    scene = scene_of("/vsimem/none.tif");
    assert_refused(&scene, "all 4 pixels are missing");
    make_raster(&(struct made_raster){.name = "/vsimem/plain.tif", .width = 5, .height = 4,
                                      .affine = utm_2m, .epsg = 32632, .values = five_by_four});
    scene = scene_of("/vsimem/plain.tif");
    scene.terrain.band = 2;
    assert_refused(&scene, "band 2");
    scene.terrain.band = 1;
    scene.terrain.cell_m = 100;
    assert_refused(&scene, "terrain.cell_m: 100 m is too much for /vsimem/plain.tif, which is 8 x 6 m from middle to "
                           "middle of its outer pixels; at most 4 m fit");
    scene.terrain.cell_m = NAN;
    assert_refused(&scene, "terrain.cell_m");
}

static void truncated_files_are_refused(void **state)
{
    (void)state;
    static float values[200 * 200];
    make_raster(&(struct made_raster){.name = "/vsimem/whole.tif", .width = 200, .height = 200,
                                      .affine = utm_2m, .epsg = 32632, .values = values});
    vsi_l_offset size;
    GByte *bytes = VSIGetMemFileBuffer("/vsimem/whole.tif", &size, FALSE);
    GByte *half = malloc(size / 2);
    memcpy(half, bytes, size / 2);
    VSIFCloseL(VSIFileFromMemBuffer("/vsimem/half.tif", half, size / 2, FALSE));
    struct wd_scene scene = scene_of("/vsimem/half.tif");
    assert_refused(&scene, "/vsimem/half.tif");
    VSIUnlink("/vsimem/half.tif");
    free(half);
}

static void files_without_a_crs_ask_for_it(void **state)
{
    (void)state;
    make_raster(&(struct made_raster){.name = "/vsimem/nocrs.tif", .width = 5, .height = 4,
                                      .affine = utm_2m, .values = five_by_four});
    struct wd_scene scene = scene_of("/vsimem/nocrs.tif");
    assert_refused(&scene, "no coordinate system: give terrain.crs");
    scene.terrain.crs = "EPSG:nonsense";
    assert_refused(&scene, "EPSG:nonsense");
    scene.terrain.crs = "https://example.org/crs";
    assert_refused(&scene, "terrain.crs");
    scene.terrain.crs = NULL;
    scene.terrain.unit = "feet";
    assert_refused(&scene, "terrain.unit");
    scene.terrain.unit = "metres";
    struct wd_terrain terrain = read_scene(&scene);
    assert_null(terrain.crs);
    assert_float_equal(terrain.origin_m[1], 4999993, 1e-9);
    wd_terrain_finish(&terrain);
    scene.terrain.target_crs = "EPSG:32632";
    assert_refused(&scene, "terrain.crs");
    scene.terrain.crs = "EPSG:32632";
    scene.terrain.target_crs = "EPSG:4326";
    assert_refused(&scene, "not a projected");
    scene.terrain.target_crs = NULL;
    terrain = read_scene(&scene);
    assert_five_by_four(&terrain);
    wd_terrain_finish(&terrain);
}

static void pictures_without_a_position_get_one_from_the_cell(void **state)
{
    (void)state;
    make_raster(&(struct made_raster){.name = "/vsimem/picture.tif", .width = 5, .height = 4,
                                      .values = five_by_four});
    struct wd_scene scene = scene_of("/vsimem/picture.tif");
    scene.terrain.unit = "metres";
    scene.terrain.cell_m = 3;
    struct wd_terrain terrain = read_scene(&scene);
    assert_float_equal(wd_terrain_extent_x_m(&terrain), 12, 1e-9);
    assert_float_equal(terrain.height_m[0], 40, 0);
    wd_terrain_finish(&terrain);
    scene.terrain.unit = NULL;
    assert_refused(&scene, "no coordinate system");
    scene.terrain.crs = "EPSG:32632";
    assert_refused(&scene, "terrain.crs gives a coordinate system, but the file does not say where it lies in it");
    make_raster(&(struct made_raster){.name = "/vsimem/placeless.tif", .width = 5, .height = 4, .epsg = 32632,
                                      .values = five_by_four});
    scene = scene_of("/vsimem/placeless.tif");
    scene.terrain.unit = "metres";
    scene.terrain.cell_m = 3;
    assert_refused(&scene, "placeless.tif: has a coordinate system");
}

/* GDAL would take words for level ground and leave out rows. */
static void text_holds_what_its_header_says(void **state)
{
    (void)state;
    static const char *const cells[][2] = {{"1.5 2 3\n4 5 nan\n", NULL},
                                           {"1 2 3\n4 5 nan\n", "grid.asc:7: \"nan\" in a grid of whole numbers"},
                                           {"1,5 -2e0 3\r\n4 5 6", NULL},
                                           {"1 2 3\n4 x 6\n", "grid.asc:7: \"x\" is no number"},
                                           {"1 2 3\n4 5 6\n7 8 9\n", "grid.asc: has 9 numbers; its header says 3 x 2"},
                                           {"1 2 3\n4 5\n", "grid.asc: has 5 numbers"}};
    for (size_t i = 0; i < sizeof cells / sizeof *cells; i++) {
        VSILFILE *file = VSIFOpenL("/vsimem/grid.asc", "wb");
        VSIFPrintfL(file, "ncols 3\nNROWS 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n%s", cells[i][0]);
        VSIFCloseL(file);
        struct wd_scene scene = scene_of("/vsimem/grid.asc");
        scene.terrain.unit = "metres";
        if (cells[i][1]) {
            assert_refused(&scene, cells[i][1]);
            continue;
        }
        struct wd_terrain terrain = read_scene(&scene);
        wd_terrain_finish(&terrain);
    }
    VSIUnlink("/vsimem/grid.asc");
}

/* Heights that are a function of longitude and latitude, 3" apart. */
static double degrees_m(double longitude, double latitude)
{
    return 400 + 2000 * (longitude - 10) + 3000 * (latitude - 47);
}

static void degrees_become_metres(void **state)
{
    (void)state;
    enum { SIDE = 60 };
    const double size = 3.0 / 3600, affine[6] = {10, size, 0, 47.05, 0, -size};
    static float values[SIDE * SIDE];
    for (int k = 0; k < SIDE * SIDE; k++)
        values[k] = (float)degrees_m(10 + (k % SIDE + 0.5) * size, 47.05 - (k / SIDE + 0.5) * size);
    make_raster(&(struct made_raster){.name = "/vsimem/degrees.tif", .width = SIDE, .height = SIDE,
                                      .affine = affine, .epsg = 4326, .values = values});
    struct wd_terrain terrain = read_file("/vsimem/degrees.tif");
    assert_non_null(strstr(terrain.crs, "32632"));
    assert_float_equal(wd_terrain_extent_x_m(&terrain), SIDE * size * 111320 * cos(47.03 * M_PI / 180),
                       150);
    assert_float_equal(wd_terrain_extent_y_m(&terrain), SIDE * size * 111180, 150);
    assert_true(terrain.cell_m <= 8 && terrain.cell_m > 4);
    for (int k = 0; k < 100; k++) {
        double x = 10 + size * (5 + k % 10 * 5), y = 47.05 - size * (5 + k / 10 * 5);
        double expected_m = degrees_m(x, y);
        assert_true(wd_reproject("EPSG:4326", terrain.crs, &x, &y, 1, &log_kept));
        assert_float_equal(wd_terrain_height(&terrain, x - terrain.origin_m[0],
                                             y - terrain.origin_m[1]), expected_m, 0.02);
    }
    double *origin_m = terrain.origin_m;
    double window_m[4] = {origin_m[0] + 1000, origin_m[1] + 500, origin_m[0] + 2000,
                          origin_m[1] + 1500};
    struct wd_scene scene = scene_of("/vsimem/degrees.tif");
    scene.terrain.window_m = window_m;
    scene.terrain.window_count = 4;
    struct wd_terrain part = read_scene(&scene);
    assert_float_equal(wd_terrain_extent_x_m(&part), 1000, 100);
    for (double at = 0; at < 900; at += 37)
        assert_float_equal(wd_terrain_height(&part, at, 900 - at),
                           wd_terrain_height(&terrain, part.origin_m[0] - origin_m[0] + at,
                                             part.origin_m[1] - origin_m[1] + 900 - at), 0.02);
    wd_terrain_finish(&part);
    wd_terrain_finish(&terrain);
}

/* Web maps' metres, of which there are 1.5 to one on the ground at 49 degrees. */
static void mercator_becomes_metres(void **state)
{
    (void)state;
    enum { SIDE = 40 };
    double x = 9, y = 49;
    assert_true(wd_reproject("EPSG:4326", "EPSG:3857", &x, &y, 1, &log_kept));
    const double affine[6] = {x, 20, 0, y, 0, -20};
    static float values[SIDE * SIDE];
    make_raster(&(struct made_raster){.name = "/vsimem/web.tif", .width = SIDE, .height = SIDE,
                                      .affine = affine, .epsg = 3857, .values = values});
    struct wd_terrain terrain = read_file("/vsimem/web.tif");
    assert_non_null(strstr(terrain.crs, "32632"));
    assert_float_equal(wd_terrain_extent_x_m(&terrain), SIDE * 20 * cos(49 * M_PI / 180), 30);
    wd_terrain_finish(&terrain);
    struct wd_scene scene = scene_of("/vsimem/web.tif");
    scene.terrain.target_crs = "EPSG:3857";
    assert_refused(&scene, "is not a projected system in metres, as a UTM zone is");
}

static void half_the_earth_fits_no_zone(void **state)
{
    (void)state;
    const double affine[6] = {-90, 1, 0, 45, 0, -1};
    static float values[180 * 90];
    make_raster(&(struct made_raster){.name = "/vsimem/earth.tif", .width = 180, .height = 90,
                                      .affine = affine, .epsg = 4326, .values = values});
    struct wd_scene scene = scene_of("/vsimem/earth.tif");
    assert_refused(&scene, "terrain.target_crs");
    const double nowhere[6] = {500000, 1, 0, 5000000, 0, -1};
    make_raster(&(struct made_raster){.name = "/vsimem/nowhere.tif", .width = 180, .height = 90,
                                      .affine = nowhere, .epsg = 4326, .values = values});
    scene = scene_of("/vsimem/nowhere.tif");
    assert_refused(&scene, "/vsimem/nowhere.tif");
}

/* Feet across (New York Long Island) and feet up. */
static void feet_become_metres(void **state)
{
    (void)state;
    enum { SIDE = 30 };
    const double affine[6] = {1000000, 10, 0, 200000, 0, -10};
    static float values[SIDE * SIDE];
    for (int k = 0; k < SIDE * SIDE; k++)
        values[k] = 1000;
    make_raster(&(struct made_raster){.name = "/vsimem/feet.tif", .width = SIDE, .height = SIDE,
                                      .affine = affine, .epsg = 2263, .unit = "ft",
                                      .values = values});
    struct wd_terrain terrain = read_file("/vsimem/feet.tif");
    assert_float_equal(wd_terrain_extent_x_m(&terrain), SIDE * 3.048, 7);
    assert_float_equal(terrain.height_m[100], 304.8, 0.01);
    assert_non_null(strstr(terrain.crs, "32618"));
    wd_terrain_finish(&terrain);
}

static void make_waves(const char *name, int width, int height, double pixel_m)
{
    float *values = malloc(sizeof(float) * width * height);
    for (int k = 0; k < width * height; k++)
        values[k] = (float)(100 + 20 * sin(k % width * 0.7) * cos(k / width * 0.5));
    const double affine[6] = {500000, pixel_m, 0, 5000000, 0, -pixel_m};
    make_raster(&(struct made_raster){.name = name, .width = width, .height = height,
                                      .affine = affine, .epsg = 32632, .values = values});
    free(values);
}

static void coarse_ground_is_refined_smoothly(void **state)
{
    (void)state;
    make_waves("/vsimem/coarse.tif", 21, 11, 32);
    struct wd_terrain terrain = read_file("/vsimem/coarse.tif");
    assert_float_equal(terrain.cell_m, 8, 1e-12);
    assert_int_equal(terrain.width, 81);
    assert_int_equal(terrain.height, 41);
    double worst = 0;
    for (int j = 0; j < 41; j++)
        for (int i = 0; i < 81; i++) {
            double expected_m = 100 + 20 * sin(i * 0.7 / 4) * cos((10 - j / 4.0) * 0.5);
            double off_m = fabs(terrain.height_m[j * 81 + i] - expected_m);
            worst = fmax(worst, off_m);
            if (i % 4 == 0 && j % 4 == 0)
                assert_true(off_m < 1e-4);
        }
    assert_true(worst < 1.5);
    wd_terrain_finish(&terrain);
    /* Not beyond the samples allowed: 41 x 21 is, 81 x 41 is not. */
    struct wd_scene scene = scene_of("/vsimem/coarse.tif");
    assert_true(wd_terrain_init(&terrain, &scene, 1, 1000, 0, NULL, &log_kept));
    assert_float_equal(terrain.cell_m, 16, 1e-12);
    wd_terrain_finish(&terrain);
    /* Fewer samples than pixels: blocks. */
    assert_true(wd_terrain_init(&terrain, &scene, 1, 60, 0, NULL, &log_kept));
    assert_float_equal(terrain.cell_m, 64, 1e-12);
    assert_int_equal(terrain.width, 10);
    assert_int_equal(terrain.height, 5);
    assert_float_equal(terrain.origin_m[0], 500032, 1e-9);
    assert_float_equal(terrain.origin_m[1], 5000000 - 11 * 32 + 32, 1e-9);
    double sw_m = 0;
    for (int k = 0; k < 4; k++)
        sw_m += (100 + 20 * sin(k % 2 * 0.7) * cos((10 - k / 2) * 0.5)) / 4;
    assert_float_equal(terrain.height_m[0], sw_m, 1e-4);
    assert_non_null(strstr(logged.text, "decimated"));
    wd_terrain_finish(&terrain);
}

static void cell_and_window_can_be_chosen(void **state)
{
    (void)state;
    make_waves("/vsimem/waves.tif", 100, 80, 4);
    struct wd_scene scene = scene_of("/vsimem/waves.tif");
    scene.terrain.cell_m = 2.5;
    struct wd_terrain terrain = read_scene(&scene);
    assert_float_equal(terrain.cell_m, 2.5, 0);
    assert_float_equal(wd_terrain_extent_x_m(&terrain), 99 * 4, 2.5);
    wd_terrain_finish(&terrain);
    scene.terrain.cell_m = 0;
    double window_m[4] = {500100, 4999800, 500200, 4999900};
    scene.terrain.window_m = window_m;
    scene.terrain.window_count = 4;
    terrain = read_scene(&scene);
    assert_float_equal(terrain.origin_m[0], 500100, 2);
    assert_float_equal(terrain.origin_m[1], 4999800, 2);
    assert_float_equal(wd_terrain_extent_x_m(&terrain), 100, 4);
    int column = (int)((terrain.origin_m[0] - 500000) / 4);
    int row = (int)((5000000 - terrain.origin_m[1]) / 4);
    assert_float_equal(terrain.height_m[0], 100 + 20 * sin(column * 0.7) * cos(row * 0.5), 1e-4);
    wd_terrain_finish(&terrain);
    double elsewhere_m[4] = {600000, 4999800, 600100, 4999900};
    scene.terrain.window_m = elsewhere_m;
    assert_refused(&scene, "terrain.window_m");
    double reversed_m[4] = {500200, 4999800, 500100, 4999900};
    scene.terrain.window_m = reversed_m;
    assert_refused(&scene, "terrain.window_m");
}

static void heights_are_scaled_and_moved(void **state)
{
    (void)state;
    make_raster(&(struct made_raster){.name = "/vsimem/plain.tif", .width = 5, .height = 4,
                                      .affine = utm_2m, .epsg = 32632, .values = five_by_four});
    struct wd_scene scene = scene_of("/vsimem/plain.tif");
    scene.terrain.vertical_scale = 2;
    scene.terrain.base_m = 7;
    struct wd_terrain terrain = read_scene(&scene);
    assert_float_equal(terrain.height_m[0], 87, 0);
    assert_float_equal(terrain.max_m, 95, 0);
    wd_terrain_finish(&terrain);
}

/* Centimetres in whole numbers: 600 m is 60,000. */
static void small_units_are_scaled_first(void **state)
{
    (void)state;
    float centimetres[20];
    for (int k = 0; k < 20; k++)
        centimetres[k] = 60000 + five_by_four[k];
    make_raster(&(struct made_raster){.name = "/vsimem/cm.tif", .width = 5, .height = 4, .affine = utm_2m, .epsg = 32632,
                                      .type = GDT_UInt16, .values = centimetres});
    struct wd_scene scene = scene_of("/vsimem/cm.tif");
    assert_refused(&scene, "all 20 pixels are missing");
    scene.terrain.vertical_scale = 0.01;
    forget_log(NULL);
    struct wd_terrain terrain = read_scene(&scene);
    assert_int_equal(logged.warnings, 0);
    assert_float_equal(terrain.min_m, 600.1, 1e-3);
    wd_terrain_finish(&terrain);
    scene.terrain.vertical_scale = 1e-3; /* 60 m; exaggeration makes nothing a height that is none */
    terrain = read_scene(&scene);
    assert_float_equal(terrain.min_m, 60.01, 1e-3);
    wd_terrain_finish(&terrain);
    scene.terrain.vertical_scale = 3;
    assert_refused(&scene, "all 20 pixels are missing");
}

static void a_crs_beside_the_files_own_is_told(void **state)
{
    (void)state;
    make_raster(&(struct made_raster){.name = "/vsimem/plain.tif", .width = 5, .height = 4,
                                      .affine = utm_2m, .epsg = 32632, .values = five_by_four});
    struct wd_scene scene = scene_of("/vsimem/plain.tif");
    scene.terrain.crs = "EPSG:banana";
    assert_refused(&scene, "terrain.crs: \"EPSG:banana\" is not a coordinate system");
    static const char *const given[] = {"EPSG:32632", "EPSG:32632+5773", "EPSG:25833"};
    for (int i = 0; i < 3; i++) {
        scene.terrain.crs = given[i];
        forget_log(NULL);
        struct wd_terrain terrain = read_scene(&scene);
        assert_five_by_four(&terrain);
        wd_terrain_finish(&terrain);
        assert_int_equal(logged.warnings, i == 2);
    }
    assert_non_null(strstr(logged.text, "terrain.crs: \"EPSG:25833\" has no effect: the file has a coordinate system of its "
                                        "own, which counts: WGS 84 / UTM zone 32N"));
}

static void vectors_are_told(void **state)
{
    (void)state;
    static const char points[] = "{\"type\": \"FeatureCollection\", \"features\": [{\"type\": \"Feature\", \"properties\": {}, "
                                 "\"geometry\": {\"type\": \"Point\", \"coordinates\": [1, 2]}}]}";
    char name[] = "/tmp/weald-vectors-XXXXXX";
    int file = mkstemp(name);
    assert_true(file >= 0);
    assert_int_equal(write(file, points, sizeof points - 1), sizeof points - 1);
    struct wd_scene scene = scene_of(name);
    assert_refused(&scene, "export trees as CSV");
    close(file);
    unlink(name);
}

/* 40,000,000,000 pixels of which 256 x 256 were ever written. */
static void make_huge(void)
{
    const double nodata = -1, affine[6] = {400000, 1, 0, 5200000, 0, -1};
    GDALDatasetH dataset = make_raster_open(&(struct made_raster){
        .name = "/vsimem/huge.tif", .width = 200000, .height = 200000, .affine = affine,
        .epsg = 32632, .nodata = &nodata,
        .options = {"SPARSE_OK=TRUE", "TILED=YES", "BIGTIFF=YES"}});
    static float values[256 * 256];
    for (int k = 0; k < 256 * 256; k++)
        values[k] = 50 + k % 256;
    assert_int_equal(GDALRasterIO(GDALGetRasterBand(dataset, 1), GF_Write, 102400, 102400, 256, 256,
                                  values, 256, 256, GDT_Float32, 0, 0), CE_None);
    GDALClose(dataset);
}

static void huge_files_are_read_by_window(void **state)
{
    (void)state;
    make_huge();
    struct wd_scene scene = scene_of("/vsimem/huge.tif");
    double window_m[4] = {400000 + 102400, 5200000 - 102655, 400000 + 102655, 5200000 - 102400};
    scene.terrain.window_m = window_m;
    scene.terrain.window_count = 4;
    double start_s = wd_clock_s();
    struct wd_terrain terrain = read_scene(&scene);
    assert_true(wd_clock_s() - start_s < 5);
    assert_true(terrain.width >= 255 && terrain.width <= 257);
    assert_float_equal(wd_terrain_height(&terrain, 100, 100), 150, 1.1);
    wd_terrain_finish(&terrain);
    scene.terrain.window_count = 0;
    start_s = wd_clock_s();
    assert_true(wd_terrain_init(&terrain, &scene, 1, 1 << 22, 0, NULL, &log_kept));
    assert_true(wd_clock_s() - start_s < 60);
    assert_true((uint64_t)terrain.width * terrain.height <= 1 << 22);
    assert_non_null(strstr(logged.text, "decimated: one sample for 98 x 98 pixels"));
    assert_true(terrain.min_m >= 50 && terrain.max_m <= 305);
    assert_true(terrain.filled_samples > terrain.width);
    wd_terrain_finish(&terrain);
    VSIUnlink("/vsimem/huge.tif");
}

static bool stop_soon(void *user, const char *stage, uint64_t done, uint64_t total)
{
    (void)stage;
    (void)done;
    (void)total;
    return ++*(int *)user < 2;
}

static void can_be_stopped(void **state)
{
    (void)state;
    make_huge();
    int calls = 0;
    const struct wd_progress progress = {stop_soon, &calls};
    struct wd_scene scene = scene_of("/vsimem/huge.tif");
    struct wd_terrain terrain;
    assert_false(wd_terrain_init(&terrain, &scene, 1, 1 << 22, 0, &progress, &log_kept));
    assert_int_equal(calls, 2);
    VSIUnlink("/vsimem/huge.tif");
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

static void real_bei(void **state)
{
    (void)state;
    struct wd_scene scene = scene_of(data_file("bei_elev_5m_local.tif"));
    assert_refused(&scene, "no coordinate system");
    scene.terrain.unit = "metres";
    struct wd_terrain terrain = read_scene(&scene);
    assert_int_equal(terrain.width, 201);
    assert_int_equal(terrain.height, 101);
    assert_float_equal(terrain.cell_m, 5, 0);
    assert_float_equal(terrain.origin_m[0], 0, 1e-9);
    assert_float_equal(terrain.origin_m[1], 0, 1e-9);
    assert_float_equal(terrain.min_m, 119.8, 0.05);
    assert_float_equal(terrain.max_m, 159.5, 0.05);
    wd_terrain_finish(&terrain);
}

static void real_luxembourg(void **state)
{
    (void)state;
    struct wd_terrain terrain = read_file(data_file("luxembourg_elev_lonlat.tif"));
    assert_non_null(strstr(terrain.crs, "32632"));
    assert_float_equal(wd_terrain_extent_x_m(&terrain), 59400, 2500);
    assert_float_equal(wd_terrain_extent_y_m(&terrain), 84950, 2500);
    assert_true(terrain.min_m >= 140 && terrain.max_m <= 548);
    assert_true(terrain.filled_samples > 0);
    double x = 6.1319, y = 49.6117; /* the city stands at about 280 m */
    assert_true(wd_reproject("EPSG:4326", terrain.crs, &x, &y, 1, &log_kept));
    assert_float_equal(wd_terrain_height(&terrain, x - terrain.origin_m[0], y - terrain.origin_m[1]),
                       285, 30);
    wd_terrain_finish(&terrain);
}

static void real_colorado(void **state)
{
    (void)state;
    struct wd_scene scene = scene_of(data_file("colorado_srtm3_lonlat.asc"));
    assert_refused(&scene, "EPSG:4326");
    scene.terrain.crs = "EPSG:4326";
    struct wd_terrain terrain = read_scene(&scene);
    assert_true(terrain.min_m > 1900 && terrain.max_m < 3300);
    assert_float_equal(wd_terrain_extent_x_m(&terrain), 17000, 500);
    wd_terrain_finish(&terrain);
}

static void real_bigtujunga(void **state)
{
    (void)state;
    struct wd_terrain terrain = read_file(data_file("bigtujunga_srtm_30m_utm11n.tif"));
    assert_float_equal(terrain.cell_m, 7.5, 1e-6);
    assert_int_equal(terrain.width, 1196 * 4 + 1);
    assert_int_equal(terrain.height, 642 * 4 + 1);
    assert_float_equal(terrain.min_m, 315, 0.5);
    assert_float_equal(terrain.max_m, 2295, 0.5);
    wd_terrain_finish(&terrain);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(samples_are_pixel_centres_from_the_south_west, forget_log),
        cmocka_unit_test_setup(south_up_files_are_turned, forget_log),
        cmocka_unit_test_setup(georeferences_beyond_earth_are_told, forget_log),
        cmocka_unit_test_setup(rotated_files_are_straightened, forget_log),
        cmocka_unit_test_setup(missing_heights_never_become_pits, forget_log),
        cmocka_unit_test_setup(missing_heights_can_be_cut_out, forget_log),
        cmocka_unit_test_setup(masks_count_as_missing, forget_log),
        cmocka_unit_test_setup(bad_files_are_refused_clearly, forget_log),
        cmocka_unit_test_setup(truncated_files_are_refused, forget_log),
        cmocka_unit_test_setup(files_without_a_crs_ask_for_it, forget_log),
        cmocka_unit_test_setup(pictures_without_a_position_get_one_from_the_cell, forget_log),
        cmocka_unit_test_setup(text_holds_what_its_header_says, forget_log),
        cmocka_unit_test_setup(degrees_become_metres, forget_log),
        cmocka_unit_test_setup(mercator_becomes_metres, forget_log),
        cmocka_unit_test_setup(half_the_earth_fits_no_zone, forget_log),
        cmocka_unit_test_setup(feet_become_metres, forget_log),
        cmocka_unit_test_setup(coarse_ground_is_refined_smoothly, forget_log),
        cmocka_unit_test_setup(cell_and_window_can_be_chosen, forget_log),
        cmocka_unit_test_setup(heights_are_scaled_and_moved, forget_log),
        cmocka_unit_test_setup(small_units_are_scaled_first, forget_log),
        cmocka_unit_test_setup(a_crs_beside_the_files_own_is_told, forget_log),
        cmocka_unit_test_setup(vectors_are_told, forget_log),
        cmocka_unit_test_setup(huge_files_are_read_by_window, forget_log),
        cmocka_unit_test_setup(can_be_stopped, forget_log),
        cmocka_unit_test_setup(real_bei, forget_log),
        cmocka_unit_test_setup(real_luxembourg, forget_log),
        cmocka_unit_test_setup(real_colorado, forget_log),
        cmocka_unit_test_setup(real_bigtujunga, forget_log),
    };
    return cmocka_run_group_tests(tests, NULL, made_rasters_forget);
}
