#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/memory.h"
#include "inventory_file.h"

static const char *const path = "inventory_test.csv";

/* Tree by the order of placement. */
static struct wd_tree tree_at(const struct wd_world *world, size_t index)
{
    return world->trees[world->tree_of_id[index + 1]];
}

static void assert_stands(const struct wd_world *world, size_t index, int32_t x_mm, int32_t y_mm)
{
    struct wd_tree tree = tree_at(world, index);
    assert_int_equal(tree.x_mm, x_mm);
    assert_int_equal(tree.y_mm, y_mm);
}

static void test_positions_and_sizes(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world world;
    small_scene_init(&small);
    small_scene_inventory(&small, path);
    write_file(path, "id,x,y,species,dbh,height,crown_diameter\n"
               "1,10.5,20.25,oak,40,21.5,9.5\n"
               "2,30,40,Picea abies,40,,\n"
               "3,50,60,SPRUCE,,25,\n"
               "4,70,80,whatever,,,\n");
    make_or_fail(&small, &world);
    assert_int_equal(world.tree_count, 4);
    assert_stands(&world, 0, 10500, 20250);
    struct wd_tree tree = tree_at(&world, 0);
    assert_int_equal(tree.z_mm, 100000);
    assert_int_equal(tree.size, 2150 | 950 << 16);
    tree = tree_at(&world, 1);
    assert_int_equal(WD_TREE_SPECIES(tree), 1);
    const struct wd_species *spruce = &small.species[1];
    assert_int_equal(tree.size & 0xffff,
                     (uint32_t)floor(wd_species_height_m(spruce, 40.0) * 100.0 + 0.5));
    assert_int_equal(tree.size >> 16,
                     (uint32_t)floor(wd_species_crown_m(spruce, 40.0) * 100.0 + 0.5));
    tree = tree_at(&world, 2);
    assert_int_equal(WD_TREE_SPECIES(tree), 1);
    assert_int_equal(tree.size & 0xffff, 2500);
    double crown_m = wd_species_crown_m(spruce, wd_species_dbh_cm(spruce, 25.0));
    assert_true(fabs((tree.size >> 16) - crown_m * 100.0) < 1.0);
    tree = tree_at(&world, 3);
    assert_int_equal(WD_TREE_SPECIES(tree), 0);
    assert_int_equal(tree.size & 0xffff, 2000); /* typical */
    assert_int_equal(world.species_counts[1], 2);
    assert_int_equal(world.inventories[0].rows, 4);
    assert_int_equal(world.inventories[0].planted, 4);
    for (size_t i = 0; i < 4; i++)
        assert_int_equal(world.layer_of_tree[i], 255);
    assert_said(captured.others, "4 rows, 4 planted");
    wd_world_finish(&world);
}

static void test_mapping_units_and_commas(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world world;
    struct wd_string_pair names[] = {{"Fi", "spruce"}, {"bi", "birch"}, {"*", "oak"}};
    small_scene_init(&small);
    struct wd_scene_inventory *inventory = small_scene_inventory(&small, path);
    inventory->species = names;
    inventory->species_count = 3;
    inventory->columns.x = "Rechts";
    inventory->columns.y = "Hoch";
    inventory->columns.species = "Art";
    inventory->columns.dbh = "BHD";
    inventory->columns.height = "Hoehe";
    inventory->dbh_unit = "mm";
    inventory->height_unit = "ft";
    inventory->height_m[0] = 5.0f;
    inventory->height_m[1] = 6.0f;
    write_file(path, "\xef\xbb\xbfRechts;Hoch;Art;BHD;Hoehe\r\n"
               "10,5;20,25;Fi;305,5;50\r\n11,5;20,25;Bi;;\r\n12,5;20;Ei;400;\r\n");
    make_or_fail(&small, &world);
    assert_stands(&world, 0, 10500, 20250);
    struct wd_tree tree = tree_at(&world, 0);
    assert_int_equal(WD_TREE_SPECIES(tree), 1);
    assert_int_equal(tree.size & 0xffff, 1524);
    double crown_m = wd_species_crown_m(&small.species[1], 30.55);
    assert_true(fabs((tree.size >> 16) - crown_m * 100.0) < 1.0);
    tree = tree_at(&world, 1);
    assert_int_equal(WD_TREE_SPECIES(tree), 2);
    assert_in_range(tree.size & 0xffff, 500, 600);
    tree = tree_at(&world, 2);
    assert_int_equal(WD_TREE_SPECIES(tree), 0);
    wd_world_finish(&world);
}

static void test_dead_duplicates_outside_invalid(void **state)
{
    (void)state;
    static const char *dead[] = {"D", "fallen"};
    struct small_scene small;
    struct wd_world world;
    small_scene_init(&small);
    struct wd_scene_inventory *inventory = small_scene_inventory(&small, path);
    inventory->dead = dead;
    inventory->dead_count = 2;
    write_file(path, "x,y,species,dbh,status\n"
               "10,10,oak,30,A\n"
               "10,10,oak,30,A\n"      /* duplicate */
               "10,10,spruce,30,A\n"   /* another species may stand there */
               "10,10,oak,12,A\n"      /* another stem, mapped coarsely */
               "10.0004,10,oak,30,\n"  /* within the millimetre */
               "20,20,oak,30,d\n"      /* dead */
               "30,20,oak,-5,Fallen\n" /* dead: its size does not matter */
               "-1,20,oak,30,A\n"      /* outside */
               "500,20,oak,30,A\n"     /* outside */
               ",20,oak,30,A\n"        /* no position */
               "40,40,oak,0,A\n");     /* not measured */
    make_or_fail(&small, &world);
    const struct wd_inventory_report *report = &world.inventories[0];
    assert_int_equal(report->rows, 11);
    assert_int_equal(report->planted, 4);
    assert_int_equal(report->duplicates, 2);
    assert_int_equal(report->dead, 2);
    assert_int_equal(report->outside, 2);
    assert_int_equal(report->invalid, 1);
    assert_said(captured.others, "inventory_test.csv:11: 1 rows have no position");
    assert_said(captured.others, "inventory_test.csv:3: 2 rows repeat");
    assert_said(captured.others, "2 trees stand outside");
    wd_world_finish(&world);

    inventory->outside = WD_OUTSIDE_KEEP;
    make_or_fail(&small, &world);
    assert_int_equal(world.inventories[0].planted, 6);
    assert_int_equal(world.inventories[0].outside, 2);
    assert_stands(&world, 3, -1000, 20000);
    wd_world_finish(&world);

    inventory->outside = WD_OUTSIDE_ERROR;
    assert_false(make(&small, &world));
    assert_said(captured.errors, "inventory_test.csv:9: stands at (-1.000, 20.000), outside");
}

/* Trees with other numbers are other trees; a number goes with its tree. */
static void test_tags(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world world;
    small_scene_init(&small);
    small_scene_layer(&small);
    struct wd_scene_inventory *inventory = small_scene_inventory(&small, path);
    small_scene_inventory(&small, path)->offset_m[0] = 100.0;
    write_file(path, "nr,x,y,dbh\n"
               "A-7,10,10,30\n"
               "A-8,10,10,30\n"  /* another tree */
               "A-7,10,10,30\n"  /* the same again */
               ",10,10,30\n"     /* none of them */
               "NA,10,10,30\n"   /* the same again */
               "B 1,20,10,30\n");
    inventory->columns.id = "nr";
    make_or_fail(&small, &world);
    assert_int_equal(world.inventories[0].planted, 4);
    assert_int_equal(world.inventories[0].duplicates, 2);
    assert_int_equal(world.inventories[1].planted, 2); /* its numbers are not asked for */
    static const char *const tags[] = {"A-7", "A-8", "", "B 1", "", ""};
    for (size_t i = 0; i < sizeof tags / sizeof *tags; i++)
        assert_string_equal(wd_tree_tags_get(&world.tags, i + 1), tags[i]);
    static const struct wd_tree_row rows[] = {{0, 2, 30.0f}, {0, 3, 30.0f}, {0, 5, 30.0f}, {0, 7, 30.0f},
                                              {1, 2, 30.0f}, {1, 7, 30.0f}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct wd_tree_row row = wd_tree_tags_get_row(&world.tags, i + 1);
        assert_memory_equal(&row, &rows[i], sizeof row);
    }
    assert_int_equal(wd_tree_tags_get_row(&world.tags, world.tree_count).line, 0);
    assert_stands(&world, 3, 20000, 10000);
    assert_string_equal(wd_tree_tags_get(&world.tags, world.tree_count), "");
    wd_world_finish(&world);
}

/* Without a word of the scene numbers are tags where each is another's, and tell no rows apart. */
static void test_usual_tags(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world world;
    small_scene_init(&small);
    small_scene_inventory(&small, path);
    write_file(path, "N\302\260 arbre,x,y,dbh\nA,10,10,30\nB,10,10,30\n,20,10,30\nC,30,10,\n");
    make_or_fail(&small, &world);
    assert_int_equal(world.inventories[0].duplicates, 1);
    static const char *const tags[] = {"A", "", "C"};
    for (size_t i = 0; i < 3; i++)
        assert_string_equal(wd_tree_tags_get(&world.tags, i + 1), tags[i]);
    assert_true(wd_tree_tags_get_row(&world.tags, 3).dbh_cm == 0.0f);
    wd_world_finish(&world);
    write_file(path, "TreeID,x,y,dbh\n1,10,10,30\n2,20,10,30\n1,30,10,30\n");
    make_or_fail(&small, &world);
    assert_string_equal(wd_tree_tags_get(&world.tags, 1), "");
    wd_world_finish(&world);
}

static void test_rotation_and_offset(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world world;
    small_scene_init(&small);
    struct wd_scene_inventory *inventory = small_scene_inventory(&small, path);
    inventory->rotate_deg = 90.0;
    inventory->offset_m[0] = 100.0;
    inventory->offset_m[1] = 50.0;
    write_file(path, "x,y\n10,0\n0,20\n");
    make_or_fail(&small, &world);
    assert_stands(&world, 0, 100000, 60000);
    assert_stands(&world, 1, 80000, 50000);
    wd_world_finish(&world);
}

static void test_fitted_ground(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world world;
    small_scene_init(&small);
    small.scene.terrain.size_m[0] = small.scene.terrain.size_m[1] = 0.0;
    struct wd_scene_inventory *inventory = small_scene_inventory(&small, path);
    inventory->frame = "projected";
    write_file(path, "x,y,height_m\n493471.123,5821351.4567,20\n493571,5821251,10\n");
    make_or_fail(&small, &world);
    assert_int_equal(world.inventories[0].planted, 2);
    assert_true(world.terrain.origin_m[0] == 493421.0);
    assert_true(world.terrain.origin_m[1] == 5821201.0);
    assert_stands(&world, 0, 50123, 150457);
    assert_stands(&world, 1, 150000, 50000);
    assert_true(wd_terrain_extent_x_m(&world.terrain) >= 200.0);
    wd_world_finish(&world);

    /* local coordinates, also negative ones, fit as well */
    inventory->frame = "local";
    write_file(path, "x,y,height_m\n-5,-8,3\n5,2,3\n");
    make_or_fail(&small, &world);
    assert_int_equal(world.inventories[0].planted, 2);
    assert_true(world.terrain.origin_m[0] == -55.0 && world.terrain.origin_m[1] == -58.0);
    assert_stands(&world, 0, 50000, 50000);
    wd_world_finish(&world);
}

/* Ground of a given size is laid under the data. */
static void test_ground_under_data(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world world;
    small_scene_init(&small);
    small_scene_inventory(&small, path)->frame = "projected";
    write_file(path, "x,y\n500000,6000000\n500100,6000200\n");
    make_or_fail(&small, &world);
    assert_int_equal(world.inventories[0].planted, 2);
    assert_stands(&world, 0, 150000, 50000);
    assert_stands(&world, 1, 250000, 250000);
    wd_world_finish(&world);
}

#ifdef HAVE_GDAL
/* The same offset is as many metres whether the file is in metres, feet or degrees. */
static void test_offsets_are_metres(void **state)
{
    (void)state;
    static const struct {
        const char *frame, *row;
    } files[] = {{"EPSG:32610", "493471,5821351\n"}, {"EPSG:2227", "6000000,2100000\n"},
                 {"EPSG:4326", "-123.0,52.5\n"}};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        struct small_scene small;
        struct wd_world world;
        small_scene_init(&small);
        for (int k = 0; k < 2; k++) {
            struct wd_scene_inventory *inventory = small_scene_inventory(&small, path);
            inventory->frame = files[i].frame;
            inventory->offset_m[0] = k * 5.0;
            inventory->offset_m[1] = k * -7.0;
        }
        char text[64];
        snprintf(text, sizeof text, "%s\n%s", i == 2 ? "lon,lat" : "x,y", files[i].row);
        write_file(path, text);
        make_or_fail(&small, &world);
        struct wd_tree here = tree_at(&world, 0), there = tree_at(&world, 1);
        assert_in_range(there.x_mm - here.x_mm, 4999, 5001);
        assert_in_range(here.y_mm - there.y_mm, 6999, 7001);
        wd_world_finish(&world);
    }
}

/* A place that cannot be reprojected is told by its line, a frame that is none by the file. */
static void test_frames_without_a_place(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world world;
    small_scene_init(&small);
    small_scene_inventory(&small, path)->frame = "EPSG:4326";
    write_file(path, "lon,lat\n9.0,48.0\n9.001,148.0\n");
    assert_false(make(&small, &world));
    assert_said(captured.errors, "inventory_test.csv:3: (9.001, 148) is no place of EPSG:4326");
    small.scene.terrain.target_crs = "EPSG:32632";
    small.inventories[0].frame = "EPSG:999999";
    assert_false(make(&small, &world));
    assert_said(captured.errors, "inventory_test.csv: frame: \"EPSG:999999\" is not a coordinate system");
}

/* Longitude and latitude on made-up ground: the UTM zone of the data. 0.001 degrees are 111.3 m
 * along the equator and 110.6 m along a meridian; UTM shortens by 0.9996 at its middle. */
static void test_degrees(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world world;
    small_scene_init(&small);
    small.scene.terrain.size_m[0] = small.scene.terrain.size_m[1] = 0.0;
    small_scene_inventory(&small, path)->frame = "EPSG:4326";
    write_file(path, "lon,lat\n9.0,0.0\n9.001,0.001\n");
    make_or_fail(&small, &world);
    assert_non_null(strstr(world.terrain.crs, "32N"));
    struct wd_tree first = tree_at(&world, 0), second = tree_at(&world, 1);
    assert_in_range(second.x_mm - first.x_mm, 111200, 111330);
    assert_in_range(second.y_mm - first.y_mm, 110480, 110600);
    assert_true(world.terrain.origin_m[0] == 499950.0);
    wd_world_finish(&world);

    /* fractal ground, by a system that is no less in degrees: 0.001 of latitude */
    small_scene_hills(&small);
    small.inventories[0].frame = "EPSG:4283";
    write_file(path, "lon,lat\n147.0,-35.0\n147.0,-35.001\n");
    make_or_fail(&small, &world);
    assert_non_null(strstr(world.terrain.crs, "55S"));
    assert_in_range(tree_at(&world, 0).y_mm - tree_at(&world, 1).y_mm, 110850, 110950);
    wd_world_finish(&world);

    /* ... and by one in feet, of which 100 are 30.48 m */
    small.inventories[0].frame = "EPSG:2227";
    write_file(path, "x,y\n6000000,2100000\n6000000,2100100\n");
    make_or_fail(&small, &world);
    assert_non_null(strstr(world.terrain.crs, "10N"));
    assert_in_range(tree_at(&world, 1).y_mm - tree_at(&world, 0).y_mm, 30440, 30490);
    wd_world_finish(&world);

    /* which nobody can ask for */
    small.scene.terrain.target_crs = "EPSG:2227";
    assert_false(make(&small, &world));
    assert_said(captured.errors, "\"EPSG:2227\" is not a projected system in metres");
    small_scene_init(&small);
    small.scene.terrain.size_m[0] = small.scene.terrain.size_m[1] = 0.0;
    small_scene_inventory(&small, path);

    /* metres of a CRS that is named */
    small.inventories[0].frame = "EPSG:32610";
    write_file(path, "x,y\n493471,5821351\n493571,5821251\n");
    make_or_fail(&small, &world);
    assert_stands(&world, 0, 50000, 150000);
    assert_non_null(strstr(world.terrain.crs, "10N"));
    wd_world_finish(&world);
}
#endif

static void expect_error(const char *text, const char *part)
{
    struct small_scene small;
    struct wd_world world;
    const struct wd_world nothing = {0};
    small_scene_init(&small);
    small_scene_inventory(&small, path);
    write_file(path, text);
    assert_false(make(&small, &world));
    assert_memory_equal(&world, &nothing, sizeof world);
    assert_said(captured.errors, part);
    const char *line = strchr(captured.errors, '\n');
    assert_true(line && line[1] == 0); /* one message */
}

static void test_errors(void **state)
{
    (void)state;
    expect_error("x,y,dbh\n1,2,NaN\n", "inventory_test.csv:2: column dbh: \"NaN\" is not a number");
    expect_error("x,y,dbh\n1,2,-3\n", "inventory_test.csv:2: column dbh: -3 is negative");
    expect_error("x,y,height\n1,2,3\n1,2,1700\n",
                 "inventory_test.csv:3: column height: 1700 is too much");
    expect_error("x,y,crown\n1,1,81.91\n1,2,81.92\n",
                 "inventory_test.csv:3: column crown: 81.92 is too much; above 0 and up to 81.91 m");
    expect_error("x,y\n1,nan\n", "inventory_test.csv:2: column y");
    expect_error("x,y\n1,2,3\n", "inventory_test.csv:2: 3 fields, but the header has 2");
    expect_error("x,y\n", "no trees");
    expect_error("x;y,z\n1,2\n", "no column for x was recognised");
    expect_error("px1,y\n1,2\n", "no column for x was recognised; name it in columns.x; the header "
                                 "has: px1, y");
    expect_error("x,y\n5000,5000\n", "no tree stands on the ground");
    expect_error("x,y\n,2\n", "no living tree");
    expect_error("x,y,x,dbh\n1,2,3,4\n", "inventory_test.csv:1: column x is there twice");
    expect_error("x,y,DBH (cm),dbh_cm\n1,2,3,4\n",
                 "inventory_test.csv:1: columns DBH (cm) and dbh_cm can both be the trees' dbh; say "
                 "which it is in columns.dbh");
}

/* How files name diameters and heights: a unit in brackets, after a dot or none, and other words. */
static void test_names_of_columns(void **state)
{
    (void)state;
    static const struct {
        const char *header, *row;
        double dbh_cm;
        uint32_t height_cm;
    } files[] = {
        {" X , Y ,DBH(cm),Height [m],crown", "10,10,20,10,3", 0.0, 1000},
        {"x,y,dbh (mm),height (cm)", "10,10,305,1200", 30.5, 1200},
        {"x,y,DBH.mm,Height.ft", "10,10,305,50", 30.5, 1524},
        {"x [m],y [m],DBH [m],total height", "10,10,0.4,12", 40.0, 1200},
        {"Easting (m),Northing (m),D130,Ht (feet)", "10,10,40,50", 40.0, 1524},
        {"x,y,BHD,H", "10,10,40,12", 40.0, 1200},
        {"x,y,diam_mm,tree height (m)", "10,10,400,12", 40.0, 1200},
        {"x,y,D1.3 [mm],h/m", "10,10,400,12", 40.0, 1200},
        {"x,y,dbh,dbh_mm,height", "10,10,7,400,12", 40.0, 1200}, /* the one that has its unit */
    };
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        struct small_scene small;
        struct wd_world world;
        small_scene_init(&small);
        small_scene_inventory(&small, path);
        char *text = wd_format("%s\n%s\n", files[i].header, files[i].row);
        write_file(path, text);
        free(text);
        make_or_fail(&small, &world);
        struct wd_tree tree = tree_at(&world, 0);
        assert_stands(&world, 0, 10000, 10000);
        assert_int_equal(tree.size & 0xffff, files[i].height_cm);
        double crown_m = files[i].dbh_cm > 0.0 ? wd_species_crown_m(&small.species[0], files[i].dbh_cm) : 3.0;
        assert_true(fabs((tree.size >> 16) - crown_m * 100.0) < 1.0);
        assert_null(strstr(captured.others, "recognised"));
        wd_world_finish(&world);
    }
}

/* What the scene says of units counts, and is told from what it leaves to the column's name. */
static void test_one_column_for_two(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world world;
    small_scene_init(&small);
    struct wd_scene_inventory *inventory = small_scene_inventory(&small, path);
    inventory->columns.y = "X";
    write_file(path, "x,y\n1,2\n");
    assert_false(make(&small, &world));
    assert_said(captured.errors, "inventory_test.csv:1: column x counts as both x and y");
}

static void test_units_said_twice(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world world;
    small_scene_init(&small);
    struct wd_scene_inventory *inventory = small_scene_inventory(&small, path);
    inventory->dbh_unit = "cm";
    inventory->height_unit = "m";
    write_file(path, "x,y,dbh_mm,height (ft),crown_cm\n10,10,30,20,250\n20,20,30,,\n");
    make_or_fail(&small, &world);
    assert_int_equal(tree_at(&world, 0).size, 2000 | 250 << 16);
    double crown_m = wd_species_crown_m(&small.species[0], 30.0);
    assert_true(fabs((tree_at(&world, 1).size >> 16) - crown_m * 100.0) < 1.0);
    wd_world_finish(&world);
    assert_said(captured.others, "inventory_test.csv:1: the name of column dbh_mm says mm, but the scene's "
                                 "dbh_unit says cm, which counts");
    assert_said(captured.others, "the name of column height (ft) says ft, but the scene's height_unit says m");

    inventory->dbh_unit = "mm";
    inventory->height_unit = "ft";
    make_or_fail(&small, &world);
    assert_int_equal(tree_at(&world, 0).size & 0xffff, 610);
    wd_world_finish(&world);
    assert_null(strstr(captured.others, "which counts"));
}

static void test_no_sizes(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world world;
    small_scene_init(&small);
    small_scene_inventory(&small, path);
    write_file(path, "x,y,girth\n10,10,94\n20,20,94\n");
    make_or_fail(&small, &world);
    wd_world_finish(&world);
    assert_said(captured.others, "inventory_test.csv:1: neither a stem diameter nor a height");
    assert_said(captured.others, "\"columns\": {\"dbh\": \"...\"}");
    assert_said(captured.others, "the header has: x, y, girth");
    assert_null(strstr(strstr(captured.others, "neither") + 1, "neither"));
    /* places alone are meant so */
    write_file(path, "x,y,species\n10,10,oak\n");
    make_or_fail(&small, &world);
    wd_world_finish(&world);
    assert_null(strstr(captured.others, "neither"));
}

static void test_sizes_that_are_not_meant_so(void **state)
{
    (void)state;
    static const char *dead[] = {"felled", "gone"};
    struct small_scene small;
    small_scene_init(&small);
    struct wd_scene_inventory *inventory = small_scene_inventory(&small, path);
    assert_said(said_of(path, "x,y,dbh,height\n10,10,320,19\n20,20,410,22\n", &small),
                "inventory_test.csv: the middle one of the trees would be 410 cm thick and 22 m high, 5.94 times as "
                "long as thick; it would be a usual tree with \"dbh_unit\": \"mm\"\n");
    assert_said(said_of(path, "x,y,dbh\n10,10,0.32\n20,20,0.41\n", &small), "a usual tree with \"dbh_unit\": \"m\"");
    assert_null(strstr(said_of(path, "x,y,dbh,height\n10,10,32,19\n20,20,1,2\n", &small), "the middle one"));
    assert_null(strstr(said_of(path, "x,y,dbh,height\n10,10,32,\n20,20,,1.1\n", &small), "the middle one"));
    assert_null(strstr(said_of(path, "x,y,dbh_mm,height\n10,10,320,19\n", &small), "the middle one"));
    assert_said(said_of(path, "x,y,DBH_2015,DBH_2020,Height\n10,10,30,31,19\n", &small),
                "no column was recognised for the trees' dbh; if DBH_2015 is, say so: \"columns\": {\"dbh\": \"DBH_2015\"}");
    assert_null(strstr(said_of(path, "x,y,BHD,H\303\266he\n10,10,30,19\n", &small), "no column"));
    inventory->species = (struct wd_string_pair[]){{"*", "oak"}};
    inventory->species_count = 1;
    assert_said(said_of(path, "x,y,species,dbh\n10,10,Abies alba,30\n20,20,oak,30\n", &small),
                "\"*\" stands for 1 species, all drawn as oak: \"Abies alba\" (1, from line 2)");
    inventory->dead = dead;
    inventory->dead_count = 2;
    const char *said = said_of(path, "x,y,dbh,status\n10,10,30,felled\n20,20,30,alive\n", &small);
    assert_said(said, "no row has the status \"gone\" in column status");
    assert_null(strstr(said, "\"felled\""));
}

static void test_degrees_as_metres(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world world;
    expect_error("lon,lat,dbh\n10,10,30\n", "inventory_test.csv:1: columns lon and lat read as degrees, but "
                                             "the frame \"local\" is in metres; say \"frame\": \"EPSG:4326\"");
    small_scene_init(&small);
    struct wd_scene_inventory *inventory = small_scene_inventory(&small, path);
    inventory->frame = "projected";
    inventory->columns.x = "Longitude";
    write_file(path, "x,Longitude,y\n10,10,30\n");
    assert_false(make(&small, &world));
    assert_said(captured.errors, "columns Longitude and y read as degrees, but the frame \"projected\"");
    inventory->columns.x = NULL;
    make_or_fail(&small, &world); /* degrees beside metres do no harm */
    wd_world_finish(&world);
}

static void test_wrong_column(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world world;
    small_scene_init(&small);
    small_scene_inventory(&small, path)->columns.dbh = "dhb_cm";
    write_file(path, "x,y,dbh_cm,height\n1,2,3,4\n");
    assert_false(make(&small, &world));
    assert_said(captured.errors, "columns.dbh: no column \"dhb_cm\"; the header has: x, y, dbh_cm, "
                                 "height; did you mean \"dbh_cm\"?");
}

static void test_unmapped_species(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world world;
    small_scene_init(&small);
    small_scene_inventory(&small, path)->species_count = 0;
    write_file(path, "x,y,species\n1,2,elm\n2,2,oak\n3,2,ash\n4,2,elm\n5,2,\n");
    assert_false(make(&small, &world));
    assert_said(captured.errors, ":2: column species: 3 species names are not mapped to a species of the scene: "
                                 "\"elm\" (2, from line 2), \"(empty)\" (1, from line 6), \"ash\" (1, from line 4)");
    write_file(path, "x,y\n1,2\n");
    assert_false(make(&small, &world));
    assert_said(captured.errors, "no column for the species");
    small.scene.species_file_count = 1;
    make_or_fail(&small, &world); /* there is only one it can be */
    assert_int_equal(world.tree_count, 1);
    wd_world_finish(&world);
}

static void test_delimiter_given_wrongly(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_world world;
    small_scene_init(&small);
    small_scene_inventory(&small, path)->delimiter = ";";
    write_file(path, "x,y\n1,2\n");
    assert_false(make(&small, &world));
    assert_said(captured.errors, "is the delimiter right?");
}

/* ---- real inventories ---- */

static char *real_file(const char *name)
{
    char *file = wd_format("%s/inventories/%s", WD_TEST_DATA, name);
    if (access(file, R_OK) == 0)
        return file;
    print_message("%s is not here: skipped\n", file);
    free(file);
    return NULL;
}

static void check_real(const char *name, void (*change)(struct wd_scene_inventory *inventory),
                       uint64_t rows, uint64_t planted, uint64_t duplicates)
{
    char *file = real_file(name);
    if (!file)
        skip();
    struct small_scene small;
    struct wd_world world;
    small_scene_init(&small);
    small.scene.terrain.size_m[0] = small.scene.terrain.size_m[1] = 0.0;
    struct wd_scene_inventory *inventory = small_scene_inventory(&small, file);
    if (change)
        change(inventory);
    make_or_fail(&small, &world);
    print_message("%s", strstr(captured.others, "inventory "));
    assert_int_equal(world.inventories[0].rows, rows);
    assert_int_equal(world.inventories[0].planted, planted);
    assert_int_equal(world.inventories[0].duplicates, duplicates);
    assert_int_equal(world.tree_count, planted);
    assert_true(wd_terrain_extent_x_m(&world.terrain) < 5000.0);
    wd_world_finish(&world);
    free(file);
}

static void test_bei(void **state)
{
    (void)state;
    check_real("bei.csv", NULL, 3604, 3604, 0);
}

static void set_projected(struct wd_scene_inventory *inventory)
{
    inventory->frame = "projected";
}

static void test_quesnel(void **state)
{
    (void)state;
    check_real("quesnel_treetops.csv", set_projected, 24465, 24465, 0);
}

static void set_nouragues(struct wd_scene_inventory *inventory)
{
    inventory->frame = "projected";
    inventory->columns.x = "x_utm22n";
    inventory->columns.y = "y_utm22n";
}

static void test_nouragues(void **state)
{
    (void)state;
    check_real("nouragues_trees.csv", set_nouragues, 2050, 2050, 0);
}

static void test_boreas(void **state)
{
    (void)state;
    check_real("boreasNS.csv", NULL, 1418, 1418, 0);
    check_real("boreasSP.csv", NULL, 420, 420, 0);
}

static void test_lansing(void **state)
{
    (void)state;
    check_real("lansing.csv", NULL, 2251, 2250, 1);
}

static void test_finpines(void **state)
{
    (void)state;
    check_real("finpines.csv", NULL, 126, 126, 0);
    check_real("longleaf.csv", NULL, 584, 584, 0);
}

static int remove_file(void **state)
{
    (void)state;
    unlink(path);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_positions_and_sizes),
        cmocka_unit_test(test_mapping_units_and_commas),
        cmocka_unit_test(test_dead_duplicates_outside_invalid),
        cmocka_unit_test(test_tags),
        cmocka_unit_test(test_usual_tags),
        cmocka_unit_test(test_rotation_and_offset),
        cmocka_unit_test(test_fitted_ground),
        cmocka_unit_test(test_ground_under_data),
#ifdef HAVE_GDAL
        cmocka_unit_test(test_offsets_are_metres),
        cmocka_unit_test(test_frames_without_a_place),
        cmocka_unit_test(test_degrees),
#endif
        cmocka_unit_test(test_errors),
        cmocka_unit_test(test_names_of_columns),
        cmocka_unit_test(test_one_column_for_two),
        cmocka_unit_test(test_units_said_twice),
        cmocka_unit_test(test_no_sizes),
        cmocka_unit_test(test_sizes_that_are_not_meant_so),
        cmocka_unit_test(test_degrees_as_metres),
        cmocka_unit_test(test_wrong_column),
        cmocka_unit_test(test_unmapped_species),
        cmocka_unit_test(test_delimiter_given_wrongly),
        cmocka_unit_test(test_bei),
        cmocka_unit_test(test_quesnel),
        cmocka_unit_test(test_nouragues),
        cmocka_unit_test(test_boreas),
        cmocka_unit_test(test_lansing),
        cmocka_unit_test(test_finpines),
    };
    return cmocka_run_group_tests_name("inventory", tests, NULL, remove_file);
}
