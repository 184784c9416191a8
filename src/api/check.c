#include "weald/forest.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "api/arguments.h"
#include "api/forest.h"
#include "base/file.h"
#include "base/log.h"
#include "tree/import.h"
#include "world/inventory.h"
#include "world/terrain.h"
#include "world/world.h"

/* --- inventories ------------------------------------------------------------------------- */

static bool check_size(const struct wd_csv *csv, const struct wd_inventory_columns *columns,
                       enum wd_inventory_size which)
{
    float size;
    return wd_inventory_read_size(csv, columns, which, &size) != WD_CSV_BAD;
}

static bool check_place(const struct wd_csv *csv, int column)
{
    double place;
    return wd_csv_number(csv, column, &place) != WD_CSV_BAD;
}

static bool check_rows(struct wd_csv *csv)
{
    enum { MAX_FAULTS = 20 };
    const struct wd_scene_inventory wanted = {0};
    struct wd_inventory_columns columns;
    if (!wd_inventory_find_columns(&columns, csv, &wanted, csv->log))
        return false;
    int faults = 0;
    uint64_t rows = 0;
    for (;;) {
        enum wd_csv_row row = wd_csv_next(csv);
        if (row == WD_CSV_END)
            break;
        if (row == WD_CSV_ERROR)
            return false;
        rows++;
        bool ok = check_place(csv, columns.x) & check_place(csv, columns.y) &
                  check_size(csv, &columns, WD_SIZE_DBH) & check_size(csv, &columns, WD_SIZE_HEIGHT) &
                  check_size(csv, &columns, WD_SIZE_CROWN);
        if (!ok && ++faults == MAX_FAULTS)
            return wd_error(csv->log, "%s: more faults are not listed", csv->path);
    }
    if (rows == 0)
        return wd_error(csv->log, "%s: there is no tree after the header row", csv->path);
    return faults == 0;
}

static bool check_csv(const char *path, const struct wd_log *log)
{
    struct wd_csv csv;
    if (!wd_csv_open(&csv, path, NULL, log))
        return false;
    bool ok = check_rows(&csv);
    wd_csv_close(&csv);
    return ok;
}

/* --- rasters ----------------------------------------------------------------------------- */

/* As ground, coarsely. A GeoPackage may hold rasters: GDAL knows. */
static bool check_raster(const char *path, const struct wd_log *log)
{
    const char *advice = wd_has_ending(path, ".gpkg") ? NULL : wd_scene_table_advice(path);
    if (advice)
        return wd_error(log, "%s: %s", path, advice);
    enum { COARSE_SAMPLES = 65536 };
    const struct wd_scene scene = {
        .path = "",
        .terrain = {.kind = WD_TERRAIN_RASTER,
                    .file = path,
                    .band = 1,
                    .nodata = NAN,
                    .vertical_scale = 1.0},
    };
    struct wd_terrain terrain;
    if (!wd_terrain_init(&terrain, &scene, 0, COARSE_SAMPLES, 0, NULL, log))
        return false;
    wd_terrain_finish(&terrain);
    return true;
}

/* --- scenes and species ------------------------------------------------------------------ */

/* All end in .json. */
static bool is_species(const char *path, bool *species, const struct wd_log *log)
{
    enum { MAX_BYTES = 64 << 20 };
    char *text;
    size_t size;
    if (!wd_file_read(path, MAX_BYTES, log, &text, &size))
        return false;
    *species = wd_scene_text_is_species(path, text, size);
    free(text);
    return true;
}

/* Model files too. */
static bool check_species(const char *path, const struct wd_log *log)
{
    struct wd_arena arena = {0};
    struct wd_species species;
    bool ok = wd_species_load(&species, path, &arena, log);
    ok = ok && wd_species_import_models(&species, 1, NULL, log);
    if (ok)
        wd_species_drop_models(&species, 1);
    wd_arena_finish(&arena);
    return ok;
}

/* All that comes before the layers' trees, and the cameras on that ground. */
static bool check_world(const struct wd_scene *scene, const struct wd_log *log)
{
    struct wd_world world;
    if (!wd_world_check(&world, scene, &(struct wd_world_params){.log = log}))
        return false;
    bool ok = wd_scene_check_places(scene, &world.terrain, log);
    wd_world_finish(&world);
    return ok;
}

static bool check_json(const char *path, const char *data_dir, const struct wd_log *log)
{
    bool species_file;
    if (!is_species(path, &species_file, log))
        return false;
    if (species_file)
        return check_species(path, log);
    const struct wd_scene_params params = {.data_dir = data_dir, .find_files = true};
    struct wd_scene scene;
    if (!wd_scene_load_with(&scene, path, &params, log))
        return false;
    bool ok = check_world(&scene, log);
    wd_scene_finish(&scene);
    return ok;
}

enum wd_result wd_file_check(const char *path, const char *data_dir, const struct wd_log *log)
{
    if (!wd_given(path, log))
        return WD_ERROR_INPUT;
    if (!wd_file_exists(path)) {
        wd_error(log, "%s: there is no such file", path);
        return WD_ERROR_INPUT;
    }
    bool ok = wd_has_ending(path, ".json")     ? check_json(path, data_dir, log)
              : wd_has_ending(path, ".csv")    ? check_csv(path, log)
              : wd_species_is_model_file(path) ? check_species(path, log)
                                               : check_raster(path, log);
    return ok ? WD_OK : WD_ERROR_INPUT;
}

char *wd_schema_text(const char *kind)
{
    static const struct {
        const char *name;
        const struct wd_keys *table;
    } kinds[] = {
        {"scene", &wd_scene_keys}, {"species", &wd_species_keys}, {"model", &wd_species_model_keys}};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (kind && strcmp(kind, kinds[i].name) == 0)
            return wd_keys_schema(kinds[i].table, kind);
    return NULL;
}
