#include <dirent.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/file.h"
#include "log.h"
#include "scene/latin_names.h"
#include "scene/scene.h"

static char *species_dir;

/* A fresh folder with scenes/ beside species/, the latter the project's own. */
struct fixture {
    char root[64], scene_path[272];
    struct collected log;
    struct wd_scene scene;
};

static int setup(void **state)
{
    struct fixture *f = calloc(1, sizeof *f);
    strcpy(f->root, "/tmp/weald-scene-XXXXXX");
    char path[256];
    if (!mkdtemp(f->root))
        return -1;
    snprintf(path, sizeof path, "%s/scenes", f->root);
    snprintf(f->scene_path, sizeof f->scene_path, "%s/a.json", path);
    mkdir(path, 0777);
    snprintf(path, sizeof path, "%s/species", f->root);
    *state = f;
    return symlink(species_dir, path);
}

static int teardown(void **state)
{
    struct fixture *f = *state;
    char path[256];
    wd_scene_finish(&f->scene);
    unlink(f->scene_path);
    snprintf(path, sizeof path, "%s/species", f->root);
    unlink(path);
    snprintf(path, sizeof path, "%s/scenes", f->root);
    rmdir(path);
    rmdir(f->root);
    free(f);
    return 0;
}

static bool load_with(struct fixture *f, const char *text, const char *data_dir)
{
    wd_scene_finish(&f->scene);
    f->log = (struct collected){0};
    struct wd_log log = {collect, &f->log};
    FILE *file = fopen(f->scene_path, "wb");
    fputs(text, file);
    fclose(file);
    struct wd_scene_params params = {.data_dir = data_dir};
    return wd_scene_load_with(&f->scene, f->scene_path, &params, &log);
}

static bool load(struct fixture *f, const char *text)
{
    return load_with(f, text, NULL);
}

static void species_are_found_and_loaded(void **state)
{
    struct fixture *f = *state;
    assert_true(load(f, "{\"species\": {\"eiche\": \"../species/oak.json\"},"
                        " \"layers\": [{\"species\": {\"spruce\": 3, \"eiche\": 1}}]}"));
    assert_int_equal(f->scene.species_file_count, 2);
    int oak = wd_scene_find_species(&f->scene, "eiche");
    int spruce = wd_scene_find_species(&f->scene, "spruce");
    assert_true(oak == 0 && spruce == 1);
    assert_int_equal(wd_scene_find_species(&f->scene, "beech"), -1);
    assert_string_equal(f->scene.species[oak].name, "oak");
    assert_string_equal(f->scene.species[spruce].name, "spruce");
    assert_true(f->scene.species[spruce].form == WD_FORM_CONIFER);
    assert_true(f->scene.layers[0].species[0].share == 3);
    assert_string_equal(f->scene.layers[0].name, "layer 1");
    assert_string_equal(f->scene.name, "a");
    assert_int_equal(f->log.errors + f->log.warnings, 0);
}

/* As files and people call them: by an installed name in place of a file, by Latin names in place of names. */
static void species_by_latin_names(void **state)
{
    struct fixture *f = *state;
    assert_true(load(f, "{\"species\": {\"Fichte\": \"../species/spruce.json\", \"Eiche\": \"Quercus robur L.\"},"
                        " \"layers\": [{\"species\": {\"Fagus sylvatica\": 1, \"Picea_abies\": 1}}],"
                        " \"inventories\": [{\"file\": \"a.csv\", \"species\": {\"Abies alba\": \"Picea abies\", \"Bi\":"
                        " \"Betula pendula\"}}]}"));
    static const char *const names[] = {"Fichte", "Eiche", "beech", "birch"};
    static const char *const files[] = {"spruce", "oak", "beech", "birch"};
    assert_int_equal(f->scene.species_file_count, 4);
    for (int i = 0; i < 4; i++) {
        assert_string_equal(f->scene.species_files[i].name, names[i]);
        assert_string_equal(f->scene.species[i].name, files[i]);
    }
    assert_string_equal(f->scene.layers[0].species[0].name, "beech");
    assert_string_equal(f->scene.layers[0].species[1].name, "Fichte");
    assert_string_equal(f->scene.inventories[0].species[0].value, "Fichte");
    assert_string_equal(f->scene.inventories[0].species[1].value, "birch");
    assert_int_equal(f->log.errors + f->log.warnings, 0);
    assert_true(load(f, "{\"species\": {\"Fichte\": \"spruce\"}, \"layers\": [{\"species\": \"Fichte\"}]}"));
    assert_string_equal(f->scene.species[0].name, "spruce");
}

/* A scene's own spruce may be another species, its beech a hedge. */
static void latin_names_stay_what_they_mean(void **state)
{
    struct fixture *f = *state;
    assert_true(load(f, "{\"species\": {\"spruce\": \"../species/oak.json\"}, \"openness\": {\"Picea abies\": 1},"
                        " \"layers\": [{\"species\": {\"spruce\": 1, \"Picea abies\": 1}}]}"));
    int own = wd_scene_find_species(&f->scene, "spruce"), installed = wd_scene_find_species(&f->scene, "Picea abies");
    assert_string_equal(f->scene.species[own].name, "oak");
    assert_string_equal(f->scene.species[installed].name, "spruce");
    assert_true(f->scene.species[installed].openness == 1 && f->scene.species[own].openness < 1);
    assert_true(load(f, "{\"species\": {\"hedge\": \"../species/beech.json\"}, \"clips\": {\"hedge\": {\"box_m\": [2, 1, 1.8]}},"
                        " \"layers\": [{\"species\": {\"hedge\": 1}}, {\"species\": {\"Fagus sylvatica\": 1}}]}"));
    assert_string_equal(f->scene.layers[1].species[0].name, "beech");
    assert_true(wd_name_is_latin("Larix decidua Mill.", "Larix decidua"));
    assert_true(wd_name_is_latin("Larix decidua \303\205ngstr\303\266m", "Larix decidua"));
    assert_false(wd_name_is_latin("Larix decidua \303\227 kaempferi", "Larix decidua"));
    assert_false(wd_name_is_latin("Unknown", "unknown"));
}

struct wrong {
    const char *text, *message;
};

/* Of the same file where the scene names no other, with heights of the trees that they stand for. */
static void trees_in_the_open_are_others(void **state)
{
    struct fixture *f = *state;
    assert_true(load(f, "{\"species\": {\"wide\": \"oak\"}, \"openness\": {\"edge\": 0.5, \"wide\": 1}, \"in_the_open\": "
                        "{\"Picea abies\": \"free\", \"oak\": \"edge\", \"edge\": \"wide\"}, "
                        "\"layers\": [{\"species\": {\"spruce\": 1, \"oak\": 1}, \"height_m\": [9, 20]}]}"));
    static const struct {
        const char *name, *file, *next;
        float openness;
    } wanted[] = {{"oak", "oak", "edge", 0.2f}, {"edge", "oak", "wide", 0.5f}, {"wide", "oak", NULL, 1},
                  {"spruce", "spruce", "free", 0.2f}, {"free", "spruce", NULL, 0.8f}};
    assert_int_equal(f->scene.species_file_count, 5);
    for (int i = 0; i < 5; i++) {
        const struct wd_species *species = &f->scene.species[wd_scene_find_species(&f->scene, wanted[i].name)];
        int next = wanted[i].next ? wd_scene_find_species(&f->scene, wanted[i].next) : -1;
        assert_string_equal(species->name, wanted[i].file);
        assert_true(species->openness == wanted[i].openness);
        assert_int_equal(species->in_the_open, next + 1);
        assert_true(species->planted_m[0] == 9 && species->planted_m[1] == 20);
    }
    assert_int_equal(f->log.errors + f->log.warnings, 0);
    static const struct wrong cases[] = {
        {"\"in_the_open\": {\"larch\": \"free\"}", "in_the_open.larch: no layer or inventory has the species \"larch\""},
        {"\"in_the_open\": {\"oak\": \"free\"}, \"openness\": {\"free\": 0.1}",
         "in_the_open.oak: \"free\" has an openness of 0.1, \"oak\" of 0.2; what stands in the open must have more"},
        {"\"in_the_open\": {\"oak\": \"free\"}, \"clips\": {\"oak\": {\"box_m\": [2, 1, 5]}}", "in_the_open.oak: is cut to"},
        {"\"in_the_open\": {\"oak\": 1}", "in_the_open.oak: found 1"},
        {"\"in_the_open\": {\"oak\": \"oak\"}", "in_the_open.oak: stands for itself"},
        {"\"when_young\": {\"oak\": \"oak\"}", "when_young.oak: stands for itself"},
        {"\"when_young\": {\"larch\": \"sapling\"}", "when_young.larch: no layer or inventory has the species \"larch\""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[400];
        snprintf(text, sizeof text, "{%s, \"layers\": [{\"species\": \"oak\", \"height_m\": [4, 6]}]}", cases[i].text);
        assert_false(load(f, text));
        if (!logged(&f->log, cases[i].message))
            fail_msg("\"%s\" is not told", cases[i].message);
    }
}

static void heights_of_other_species_are_told(void **state)
{
    struct fixture *f = *state;
    assert_true(load(f, "{\"layers\": [{\"species\": {\"oak\": 1}},\n{\"species\": {\"fern\": 1}}]}"));
    assert_true(logged(&f->log, ":2:1: layers[1].height_m: trees of 14 to 28 m are planted; those of fern are"));
    assert_int_equal(f->log.warnings, 1);
    assert_true(load(f, "{\"layers\": [{\"species\": {\"fern\": 1}, \"height_m\": [0.5, 1]}, {\"species\": {\"hedge\":"
                        " 1}}], \"species\": {\"hedge\": \"beech\"}, \"clips\": {\"hedge\": {\"box_m\": [2, 1, 1.8]}}}"));
    assert_int_equal(f->log.warnings, 0);
}

static void unknown_species_are_errors(void **state)
{
    struct fixture *f = *state;
    static const struct wrong cases[] = {
        {"{\"layers\": [{\"species\": {\"oka\": 1}}]}",
         ":1:33: layers[0].species.oka: unknown species \"oka\"; did you mean \"oak\"? Known are: "},
        {"{\"layers\": [{\"species\": \"zzzzzz\"}]}", "unknown species \"zzzzzz\". Known are: "},
        {"{\"layers\": [{\"species\": \"../species/oak\"}]}", "unknown species \"../species/oak\""},
        {"{\"species\": {\"oak\": \"no.json\"}}", "species.oak: there is no file "},
        {"{\"inventories\": [{\"file\": \"a.csv\", \"species\": {\"*\": \"spruze\"}}]}",
         "inventories[0].species.*: unknown species \"spruze\"; did you mean \"spruce\"?"},
        {"{\"inventories\": [{\"file\": \"a.csv\"}]}", "inventories[0]: names no species"},
        {"{\"species\": {\"me\": \"a.json\"}}", "\"latin\" is missing"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_false(load(f, cases[i].text));
        assert_true(logged(&f->log, cases[i].message));
        struct wd_scene zero = {0};
        assert_memory_equal(&f->scene, &zero, sizeof zero);
    }
}

static void checks_across_keys_hold(void **state)
{
    struct fixture *f = *state;
    static const struct wrong cases[] = {
        {"{\"terrain\": {\"kind\": \"raster\"}}", "terrain: a raster terrain needs \"file\""},
        {"{\"terrain\": {\"file\": \"a.tif\"}}", "terrain.file: only a terrain of"},
        {"{\"terrain\": {\"kind\": \"raster\", \"file\": \"a\", \"window_m\": [1, 1, 0, 2]}}",
         "terrain.window_m: found [1, 1, 0, 2]"},
        {"{\"terrain\": {\"size_m\": [0, 1]}}", "terrain.size_m: found 0 x 1; either both"},
        {"{\"terrain\": {\"kind\": \"diamond-square\", \"size_m\": [0, 0]}}", "both must be above 0"},
        {"{\"terrain\": {\"size_m\": [5, -1]}}", "terrain.size_m[1]: found -1"},
        {"{\"ground\": {\"rock_slope_deg\": 0}}", "ground.rock_slope_deg: found 0"},
        {"{\"layers\": [{\"species\": {\"oak\": 0}}]}", "the shares sum to 0"},
        {"{\"layers\": [{\"species\": {}}]}", "the shares sum to 0"},
        {"{\"layers\": [{\"species\": {\"oak\": -1}}]}", "layers[0].species.oak: found -1"},
        {"{\"layers\": [{\"spacing_m\": 4}]}", "layers[0]: \"species\" is missing"},
        {"{\"layers\": [{\"species\": \"oak\", \"density\": 2}]}", "layers[0].density: found 2"},
        {"{\"layers\": [{\"species\": \"oak\", \"placement\": \"canopy\"}]}",
         "canopy placement needs \"canopy\""},
        {"{\"layers\": [{\"species\": \"oak\", \"map\": {\"file\": \"a.tif\"}}]}",
         "layers[0].map: needs \"classes\""},
        {"{\"layers\": [{\"species\": \"oak\", \"map\": {\"classes\": 1}}]}",
         "layers[0].map: \"file\" is missing"},
        {"{\"layers\": [{\"species\": \"oak\", \"map\": {\"file\": \"a\", \"classes\": [1, 2],"
         " \"class_density\": [1]}}]}",
         "class_density: found 1 numbers for 2 classes"},
        {"{\"layers\": [{\"species\": \"oak\", \"height_m\": [9, 2]}]}", "height_m: found [9, 2]"},
        {"{\"layers\": [{\"species\": \"oak\", \"altitude_m\": [9, 2]}]}", "found 2 after 9"},
        {"{\"layers\": [{\"species\": \"oak\", \"height_m\": -3}]}", "height_m: found -3"},
        {"{\"layers\": [{\"name\": \"a\", \"species\": \"oak\"}, {\"name\": \"a\", \"species\": "
         "\"oak\"}]}",
         "layers[1].name: \"a\" is the name of layers[0] already"},
        {"{\"cameras\": [{\"name\": \"a\", \"position_m\": [0, 0, 1], \"look_at_m\": [0, 0, 1]}]}",
         "cameras[0].look_at_m: is the camera's own position"},
        {"{\"cameras\": [{\"name\": \"a\", \"position_m\": [0, 0, 1], \"look_at_m\": [0, 0]}]}",
         "look_at_m: found a list of 2; allowed is a list of 3 numbers"},
        {"{\"paths\": [{\"name\": \"a\", \"keys\": [{\"position_m\": [0, 0, 1]}]}]}",
         "paths[0].keys: found 1; a path needs at least two keys"},
        {"{\"quality\": {\"width\": 0}}", "quality.width: found 0; allowed is a whole number from "
                                          "1 to 16384"},
        {"{\"$schema\": null}", "a.json:1:13: $schema: is no text"},
        {"{\"layers\": [{\"species\": \"oak\", \"map\": {\"file\": \"a\", \"value_range\": [-1e31, 1]}}]}",
         "value_range[0]: found -1e+31; allowed is a list of 2 numbers, each a number from -1e+30 to 1e+30"},
        {"{\"quality\": {\"height\": 16385}}", "quality.height: found 16385"},
        {"{\"terrain\": {\"size_m\": [0, 0]}, \"layers\": [{\"species\": \"oak\"}]}",
         "terrain.size_m: found 0 x 0, to be fitted to inventories, of which there are none"},
        {"{\"cameras\": [{\"name\": \"a\", \"position_m\": [0, -2e6, 1]}]}",
         "cameras[0].position_m: found [0, -2000000, 1]; allowed is less than 2000000 each way"},
        {"{\"paths\": [{\"name\": \"a\", \"keys\": [{\"position_m\": [0, 0, 1]}, {\"position_m\": [0, 0, 3e6]}]}]}",
         "paths[0].keys[1].position_m: found [0, 0, 3000000]"},
        {"{\"method\": \"octre\"}", "method: found \"octre\"; did you mean \"octree\"?"},
        {"{\"species\": {\"oak\": \"../species/oak.json\"}, \"inventories\": [{\"file\": \"a\", "
         "\"delimiter\": \"xy\", \"frame\": \"EPSG:x\"}]}",
         "delimiter: found \"xy\""},
        {"{\"species\": {\"oak\": \"../species/oak.json\"}, \"inventories\": [{\"file\": \"a\", "
         "\"frame\": \"EPSG:32610\", \"rotate_deg\": 3}]}",
         "rotate_deg: only the local frame"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_false(load(f, cases[i].text));
        assert_true(logged(&f->log, cases[i].message));
    }
}

/* What is wrong is told, and not what only follows from its not being read. */
static void refused_ground_is_told_once(void **state)
{
    struct fixture *f = *state;
    static const char *const sizes[] = {"{\"size_m\": 100}", "{\"size_m\": [\"100\", \"100\"]}",
                                        "{\"size_m\": [-100, 100]}", "\"flat\"", "{\"size_m\": [0, 0]}"};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        char text[128];
        snprintf(text, sizeof text, "{\"terrain\": %s, \"layers\": [{\"species\": \"oak\"}]}", sizes[i]);
        assert_false(load(f, text));
        assert_true(logged(&f->log, "terrain"));
        assert_int_equal(f->log.errors, 1);
        assert_true(i == 4 || !strstr(f->log.text, "to be fitted"));
    }
}

static void keys_without_effect_are_told(void **state)
{
    struct fixture *f = *state;
    static const struct wrong cases[] = {
        {"{\"terrain\": {\"relief_m\": 9, \"crs\": \"EPSG:32632\"}, \"layers\": [{\"species\": \"oak\"}]}",
         "a.json:1:13: terrain: relief_m has no effect: only"},
        {"{\"terrain\": {\"crs\": \"EPSG:32632\", \"band\": 1}, \"layers\": [{\"species\": \"oak\"}]}",
         "terrain: crs, band have no effect: only"},
        {"{\"layers\": [{\"species\": \"oak\", \"placement\": \"canopy\", \"canopy\": {\"file\": \"a\"}, "
         "\"density\": 0.1, \"height_m\": 4}]}", "layers[0]: density, height_m have no effect: the canopy says"},
        {"{\"layers\": [{\"species\": \"oak\", \"canopy\": {\"file\": \"a\"}}]}", "layers[0]: canopy has no effect"},
        {"{\"layers\": [{\"species\": \"oak\"}], \"cameras\": [{\"name\": \"a\", \"position_m\": [0, 0, 1], "
         "\"look_at_m\": [5, 5, 5], \"yaw_deg\": 3}]}", "cameras[0]: yaw_deg has no effect: look_at_m"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_true(load(f, cases[i].text));
        assert_true(logged(&f->log, cases[i].message));
        assert_int_equal(f->log.warnings, i ? 1 : 2);
    }
    assert_true(load(f, "{\"layers\": [{\"species\": \"oak\"}], \"cameras\": [{\"name\": \"a\", "
                        "\"position_m\": [0, 0, 1], \"yaw_deg\": 3}]}"));
    assert_int_equal(f->log.warnings, 0);
}

/* The default rule of slopes is for trees that are made up. */
static void measured_trees_stand_on_any_slope(void **state)
{
    struct fixture *f = *state;
    assert_true(load(f, "{\"layers\": [{\"species\": \"oak\", \"placement\": \"canopy\", \"canopy\": {\"file\": \"a\"}},"
                        "{\"species\": \"oak\", \"placement\": \"canopy\", \"canopy\": {\"file\": \"a\"}, "
                        "\"slope_deg\": [0, 42]}, {\"species\": \"oak\"}]}"));
    assert_true(f->scene.layers[0].slope_deg[1] == 90);
    assert_true(f->scene.layers[1].slope_deg[1] == 42 && f->scene.layers[2].slope_deg[1] == 42);
}

/* Items that were refused are empty where the checks of the whole scene come to them. */
static void refused_items_are_passed_over(void **state)
{
    struct fixture *f = *state;
    static const struct wrong cases[] = {
        {"{\"layers\": [{\"species\": \"oak\"}], \"inventories\": [{\"file\": \"a.csv\", "
         "\"species\": {\"x\": null}}]}", "inventories[0].species.x: found null"},
        {"{\"layers\": [{\"species\": \"oak\"}], \"inventories\": [{\"file\": \"a.csv\", "
         "\"species\": {\"x\": [], \"*\": \"oak\"}}]}", "inventories[0].species.x: found a list"},
        {"{\"layers\": [{\"species\": \"oak\"}], \"inventories\": [{\"file\": \"a.csv\", "
         "\"dead\": [null]}]}", "inventories[0].dead[0]: found null"},
        {"{\"layers\": [{\"species\": \"oak\"}], \"clips\": {\"oak\": 1}, \"openness\": {\"oak\": \"x\"}, "
         "\"species\": {\"a\": 1}}", "clips.oak: found 1"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_false(load(f, cases[i].text));
        assert_true(logged(&f->log, cases[i].message));
    }
}

static void all_errors_come_in_one_pass(void **state)
{
    struct fixture *f = *state;
    assert_false(load(f, "{\"seed\": -1, \"layers\": [{\"species\": \"oka\", \"jitter\": 2}],\n"
                         "\"wind\": {\"sped_mps\": 1}}"));
    assert_int_equal(f->log.errors, 4);
    assert_true(logged(&f->log, "a.json:2:10: wind.sped_mps: unknown key; did you mean"));
}

static void data_directory_is_put_into_names(void **state)
{
    struct fixture *f = *state;
    const char *text = "{\"terrain\": {\"kind\": \"raster\", \"file\": \"${data}/a.tif\"}}";
    assert_false(load(f, text));
    assert_true(logged(&f->log, "terrain.file: found \"${data}/a.tif\", but no data directory"));
    assert_true(logged(&f->log, "--data DIR"));
    assert_true(load_with(f, text, f->root));
    char wanted[128];
    snprintf(wanted, sizeof wanted, "%s/a.tif", f->root);
    assert_string_equal(f->scene.terrain.file, wanted);
    assert_false(load_with(f, text, "/nowhere/at/all"));
    assert_true(logged(&f->log, "/nowhere/at/all does not exist"));
    assert_false(load(f, "{\"terrain\": {\"kind\": \"raster\", \"file\": \"${date}/a.tif\"}}"));
    assert_true(logged(&f->log, "the one variable there is is ${data}"));
}

static void unreadable_files_are_errors(void **state)
{
    struct fixture *f = *state;
    struct wd_log log = {collect, &f->log};
    assert_false(wd_scene_load_with(&f->scene, "/nowhere/a.json", NULL, &log));
    assert_true(logged(&f->log, "/nowhere/a.json: cannot be opened"));
    assert_false(wd_scene_load_with(&f->scene, f->root, NULL, &log));
    assert_true(logged(&f->log, "is a directory"));
}

static void cameras_are_found_by_name(void **state)
{
    struct fixture *f = *state;
    assert_true(load(f, "{\"cameras\": [{\"name\": \"a\", \"position_m\": [1, 2, 3]}, {\"name\": "
                        "\"b\", \"position_m\": [4, 5, 6], \"look_at_m\": [0, 0, 0]}]}"));
    assert_null(wd_scene_find_camera(&f->scene, "c"));
    const struct wd_scene_camera *b = wd_scene_find_camera(&f->scene, "b");
    assert_true(b->position_m[2] == 6 && b->look_at_count == 3 && b->fov_deg == 50);
    assert_false(b->automatic);
}

static void allometry_inverts(void **state)
{
    struct fixture *f = *state;
    assert_true(load(f, "{\"layers\": [{\"species\": {\"spruce\": 1, \"oak\": 1}}]}"));
    for (size_t i = 0; i < 2; i++) {
        const struct wd_species *species = &f->scene.species[i];
        const struct wd_allometry *a = &species->allometry;
        double last = 0;
        for (double dbh = 1; dbh < 60; dbh += 1) {
            double height = wd_species_height_m(species, dbh);
            double libm = 1.3 + a->height_a * pow(1 - exp(-a->height_b * dbh), a->height_c);
            assert_true(fabs(height - libm) < 1e-9 && height > last);
            assert_true(fabs(wd_species_dbh_cm(species, height) - dbh) < 1e-6);
            assert_true(wd_species_crown_m(species, dbh) > 0);
            last = height;
        }
        assert_true(wd_species_height_m(species, -1) == 1.3);
        assert_true(wd_species_dbh_cm(species, 1e6) > 399 && wd_species_dbh_cm(species, 0) < 0.51);
    }
}

/* Of heights over stems of stands, tables of yield have 60 to 100 at such heights; of those in the open it is 30 to 60
 * (Hasenauer 1997). */
static void stems_of_stands_are_slender(void **state)
{
    struct fixture *f = *state;
    assert_true(load(f, "{\"layers\": [{\"species\": {\"oak\": 1, \"beech\": 1, \"birch\": 1, \"maple\": 1, "
                        "\"larch\": 1, \"pine\": 1, \"spruce\": 1}}]}"));
    for (size_t i = 0; i < f->scene.species_file_count; i++) {
        const struct wd_species *species = &f->scene.species[i];
        double height_m = (double)species->typical_height_m;
        double forest = 100 * height_m / wd_species_stem_of_height_cm(species, height_m);
        double open = forest / wd_species_open_stem(species, height_m, 1);
        if (forest < 60 || forest > 101 || open < 30 || open > 65)
            fail_msg("%s: %.0f times its stem in stands, %.0f in the open", species->name, forest, open);
    }
}

static void assert_variants(const struct fixture *f, const char *name, float low_m, float high_m)
{
    float range_m[2];
    wd_species_variant_range_m(&f->scene.species[wd_scene_find_species(&f->scene, name)], range_m);
    if (fabsf(range_m[0] - low_m) > 0.01f || fabsf(range_m[1] - high_m) > 0.01f)
        fail_msg("%s stands for %g to %g m", name, (double)range_m[0], (double)range_m[1]);
}

/* Saplings under a name of their own are grown as saplings; one low layer changes no tree of the others. */
static void saplings_have_variants_of_their_own(void **state)
{
    struct fixture *f = *state;
    assert_true(load(f, "{\"species\": {\"young oak\": \"../species/oak.json\"}, \"layers\": ["
                        "{\"name\": \"a\", \"species\": {\"oak\": 1, \"beech\": 1}, \"height_m\": [16, 30]},"
                        "{\"name\": \"b\", \"species\": {\"young oak\": 1}, \"height_m\": [2, 5]},"
                        "{\"name\": \"c\", \"species\": {\"young oak\": 1}, \"height_m\": [4, 9]},"
                        "{\"name\": \"d\", \"species\": {\"beech\": 1, \"hazel\": 1}, \"height_m\": [1, 2]}]}"));
    assert_variants(f, "oak", 12.6f, 30.8f);
    assert_variants(f, "beech", 14.4f, 35.2f);
    assert_variants(f, "young oak", 2, 9);
    const struct wd_species *hazel = &f->scene.species[wd_scene_find_species(&f->scene, "hazel")];
    assert_variants(f, "hazel", 0.45f * hazel->typical_height_m, 1.1f * hazel->typical_height_m);
}

/* Of an inventory's trees, or of a layer's of all heights. */
static void young_ones_stand_for_low_trees(void **state)
{
    struct fixture *f = *state;
    assert_true(load(f, "{\"when_young\": {\"oak\": \"young oak\", \"beech\": \"young beech\"}, \"openness\": {\"oak\": 0.6},"
                        "\"layers\": [{\"species\": {\"beech\": 1}, \"height_m\": [4, 30]}], \"inventories\": [{\"file\": "
                        "\"t.csv\", \"species\": {\"*\": \"oak\"}}]}"));
    const struct wd_species *species = f->scene.species;
    int oak = wd_scene_find_species(&f->scene, "oak"), young = wd_scene_find_species(&f->scene, "young oak");
    assert_int_equal(species[oak].when_young, 1 + young);
    assert_true(species[young].openness == species[oak].openness);
    assert_variants(f, "oak", 12.6f, 30.8f);
    assert_variants(f, "young oak", 0.06f * 28, 12.6f);
    assert_variants(f, "beech", 14.4f, 35.2f);
    assert_variants(f, "young beech", 4, 14.4f);
}

/* An inventory may hold any height, but only of what it names. */
static void inventories_leave_saplings_alone(void **state)
{
    struct fixture *f = *state;
    assert_true(load(f, "{\"species\": {\"young oak\": \"../species/oak.json\", \"young beech\": \"../species/beech.json\"},"
                        "\"layers\": [{\"species\": {\"young oak\": 1, \"young beech\": 1}, \"height_m\": [2, 5]}],"
                        "\"inventories\": [{\"file\": \"t.csv\", \"species\": {\"*\": \"oak\", \"b\": \"young beech\"}}]}"));
    assert_variants(f, "young oak", 2, 5);
    assert_variants(f, "young beech", 14.4f, 35.2f);
}

/* Chlorophyll leaves more red beside green than one would paint: PROSPECT-D's leaves of 35 to 65 ug/cm2 have 0.57 to
 * 0.63 in what they reflect and 0.39 to 0.63 in what they let through. */
static void green_leaves_are_not_too_green(void **state)
{
    struct fixture *f = *state;
    assert_true(load(f, "{\"layers\": [{\"species\": {\"oak\": 1, \"beech\": 1, \"birch\": 1, \"maple\": 1, "
                        "\"larch\": 1, \"hazel\": 1, \"willow\": 1, \"catalpa\": 1, \"coconut\": 1, \"fern\": 1, "
                        "\"angelique\": 1, \"bramble\": 1, \"grass\": 1, \"meadow\": 1, \"pine\": 1, "
                        "\"spruce\": 1, \"camellia-red\": 1}}]}"));
    for (size_t i = 0; i < f->scene.species_file_count; i++) {
        const struct wd_species *species = &f->scene.species[i];
        const float *upper = species->leaf.color, *through = species->leaf.transmittance;
        double reflected = (double)(upper[0] / upper[1]), let_through = (double)(through[0] / through[1]);
        if (reflected < 0.53 || reflected > 0.7 || let_through < 0.35 || let_through > 0.7)
            fail_msg("%s: red over green is %.2f reflected, %.2f let through", species->name, reflected, let_through);
    }
}

static void months_change_leaves(void **state)
{
    struct fixture *f = *state;
    assert_true(load(f, "{\"layers\": [{\"species\": {\"spruce\": 1, \"oak\": 1, \"meadow\": 1}}]}"));
    const struct wd_species *spruce = &f->scene.species[0], *oak = &f->scene.species[1];
    const struct wd_species *meadow = &f->scene.species[2];
    struct wd_species in;
    assert_true(wd_species_in_month(&in, oak, 7.5, NULL));
    assert_true(in.leaf.count == oak->leaf.count && in.leaf.color[0] == oak->leaf.color[0]);
    assert_true(wd_species_in_month(&in, oak, 2, NULL) && in.leaf.count == 0);
    assert_true(wd_species_in_month(&in, spruce, 2, NULL));
    assert_true(in.leaf.count == spruce->leaf.count);
    assert_true(wd_species_in_month(&in, oak, 10.8, NULL));
    assert_true(in.leaf.color[0] > 2 * oak->leaf.color[0] && in.leaf.count > 0);
    assert_true(wd_species_in_month(&in, meadow, 1.5, NULL)); /* straw */
    assert_true(in.leaf.count > meadow->leaf.count / 2 && in.leaf.color[0] > in.leaf.color[1]);
    assert_true(wd_species_in_month(&in, meadow, 4.5, NULL) && in.leaf.color[0] < in.leaf.color[1]);
    assert_false(wd_species_in_month(&in, oak, 0.5, NULL));
    assert_false(wd_species_in_month(&in, oak, (double)NAN, NULL));
}

/* A model's file knows one season only. */
static void dates_leave_models_as_they_are(void **state)
{
    struct fixture *f = *state;
    char *model = wd_path_beside(f->scene_path, "a.obj"); /* it is not opened here */
    fclose(fopen(model, "wb"));
    bool loaded = load(f, "{\"species\": {\"own\": \"a.obj\"}, \"time\": {\"date\": \"2026-10-25\"},"
                          " \"layers\": [{\"species\": {\"own\": 1, \"oak\": 1}}]}");
    unlink(model);
    free(model);
    assert_true(loaded);
    const struct wd_species *own = &f->scene.species[wd_scene_find_species(&f->scene, "own")];
    const struct wd_species *oak = &f->scene.species[wd_scene_find_species(&f->scene, "oak")];
    assert_true(oak->leaf.season_color[0][0] > 0);
    assert_float_equal(own->leaf.color[1], 0.111, 1e-6);
    assert_float_equal(own->leaf.transmittance[1], 0.106, 1e-6);
    assert_true(own->leaf.season_color[0][0] == 0 && own->leaf.season_count[0] == 0);
}

/* Whether the scene plants models that lie with the data. */
static bool needs_models(const char *path)
{
    char *text = NULL;
    size_t size;
    struct wd_log log = {NULL, NULL};
    bool needs = wd_file_read(path, 1 << 20, &log, &text, &size) && strstr(text, "${data}/models");
    free(text);
    return needs;
}

/* The project's own scenes. Without the data the folder of species stands in for it: of rasters and
 * tables only the names are looked at here, models are opened. */
static void own_scenes_load(void **state)
{
    (void)state;
    char *folder_path = wd_path_beside(species_dir, "scenes");
    DIR *folder = opendir(folder_path);
    assert_non_null(folder);
    int loaded = 0;
    char *data_path = wd_path_beside(species_dir, "../shared/data");
    bool data = access(data_path, R_OK) == 0;
    for (struct dirent *entry; (entry = readdir(folder));) {
        size_t length = strlen(entry->d_name);
        if (length < 6 || strcmp(entry->d_name + length - 5, ".json") != 0)
            continue;
        struct collected all = {0};
        struct wd_log log = {collect, &all};
        struct wd_scene_params params = {.data_dir = data ? data_path : species_dir};
        struct wd_scene scene;
        char *path = wd_format("%s/%s", folder_path, entry->d_name);
        if (!data && needs_models(path)) {
            print_message("%s: skipped, there is no ../shared/data\n", entry->d_name);
            free(path);
            continue;
        }
        if (!wd_scene_load_with(&scene, path, &params, &log) || all.warnings)
            fail_msg("%s", all.text);
        assert_non_null(wd_scene_find_camera(&scene, "overview"));
        assert_false(scene.cameras[0].automatic);
        wd_scene_finish(&scene);
        free(path);
        loaded++;
    }
    closedir(folder);
    free(folder_path);
    free(data_path);
    assert_true(loaded > 0);
}

int main(int argc, char **argv)
{
    if (argc != 2)
        return 2;
    species_dir = argv[1];
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(species_are_found_and_loaded, setup, teardown),
        cmocka_unit_test_setup_teardown(species_by_latin_names, setup, teardown),
        cmocka_unit_test_setup_teardown(latin_names_stay_what_they_mean, setup, teardown),
        cmocka_unit_test_setup_teardown(trees_in_the_open_are_others, setup, teardown),
        cmocka_unit_test_setup_teardown(heights_of_other_species_are_told, setup, teardown),
        cmocka_unit_test_setup_teardown(unknown_species_are_errors, setup, teardown),
        cmocka_unit_test_setup_teardown(checks_across_keys_hold, setup, teardown),
        cmocka_unit_test_setup_teardown(refused_ground_is_told_once, setup, teardown),
        cmocka_unit_test_setup_teardown(keys_without_effect_are_told, setup, teardown),
        cmocka_unit_test_setup_teardown(measured_trees_stand_on_any_slope, setup, teardown),
        cmocka_unit_test_setup_teardown(refused_items_are_passed_over, setup, teardown),
        cmocka_unit_test_setup_teardown(all_errors_come_in_one_pass, setup, teardown),
        cmocka_unit_test_setup_teardown(data_directory_is_put_into_names, setup, teardown),
        cmocka_unit_test_setup_teardown(unreadable_files_are_errors, setup, teardown),
        cmocka_unit_test_setup_teardown(cameras_are_found_by_name, setup, teardown),
        cmocka_unit_test(own_scenes_load),
        cmocka_unit_test_setup_teardown(allometry_inverts, setup, teardown),
        cmocka_unit_test_setup_teardown(stems_of_stands_are_slender, setup, teardown),
        cmocka_unit_test_setup_teardown(saplings_have_variants_of_their_own, setup, teardown),
        cmocka_unit_test_setup_teardown(young_ones_stand_for_low_trees, setup, teardown),
        cmocka_unit_test_setup_teardown(inventories_leave_saplings_alone, setup, teardown),
        cmocka_unit_test_setup_teardown(green_leaves_are_not_too_green, setup, teardown),
        cmocka_unit_test_setup_teardown(months_change_leaves, setup, teardown),
        cmocka_unit_test_setup_teardown(dates_leave_models_as_they_are, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
