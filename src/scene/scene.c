#include "scene/scene.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/log.h"
#include "scene/json_text.h"

enum { MAX_SCENE_BYTES = 16 << 20 };

/* --- files that are no scenes ------------------------------------------------------------ */

struct other_kind {
    const char *endings[8]; /* ended by NULL */
    const char *advice;
};

static const char *advice_of(const struct other_kind *kinds, size_t count, const char *path)
{
    for (size_t i = 0; i < count; i++)
        for (const char *const *ending = kinds[i].endings; *ending; ending++)
            if (wd_has_ending(path, *ending))
                return kinds[i].advice;
    return NULL;
}

static const char vectors_advice[] = "holds vector data: export the trees as CSV (x, y, species, height ...), and name "
                                     "that in a scene's \"inventories\"";

const char *wd_scene_table_advice(const char *path)
{
    static const struct other_kind kinds[] = {
        {{".gpkg", ".shp", ".dbf", ".geojson", ".kml", ".gml", ".fgb"}, vectors_advice},
        {{".xlsx", ".xls", ".ods"}, "is a workbook: save its sheet as CSV, and name that in a scene's \"inventories\""},
    };
    return advice_of(kinds, sizeof kinds / sizeof *kinds, path);
}

static bool refuse_kind(const char *path, const char *advice, const struct wd_log *log)
{
    return wd_error(log, "%s: is no scene (.json); it %s", path, advice);
}

/* A scene may have any name but those of what scenes are made of. */
static bool check_name(const char *path, const struct wd_log *log)
{
    static const struct other_kind kinds[] = {
        {{".csv", ".tsv"}, "is a table: name it in a scene's \"inventories\""},
        {{".tif", ".tiff", ".asc", ".vrt"},
         "is a raster: name it in a scene, as the \"file\" of its \"terrain\" or of a layer's \"map\" or \"canopy\""},
    };
    const char *advice = wd_scene_table_advice(path);
    if (!advice)
        advice = advice_of(kinds, sizeof kinds / sizeof *kinds, path);
    return !advice || !wd_file_exists(path) || refuse_kind(path, advice, log);
}

static bool check_text(const char *path, const char *text, size_t size, const struct wd_log *log)
{
    static const char geojson[] = "\"FeatureCollection\"";
    return !memmem(text, size < 1024 ? size : 1024, geojson, strlen(geojson)) || refuse_kind(path, vectors_advice, log);
}

bool wd_scene_load_with(struct wd_scene *scene, const char *path,
                        const struct wd_scene_params *params, const struct wd_log *log)
{
    *scene = (struct wd_scene){0};
    char *text;
    size_t size;
    if (!check_name(path, log) || !wd_file_read(path, MAX_SCENE_BYTES, log, &text, &size))
        return false;
    struct wd_arena arena = {0};
    const struct wd_keys_input input = {path, text, size, params, params ? params->settings : NULL};
    bool ok = check_text(path, text, size, log) && wd_keys_read_input(&wd_scene_keys, &input, &arena, log, scene);
    free(text);
    if (ok)
        scene->arena = arena;
    else
        wd_arena_finish(&arena);
    return ok;
}

static size_t count_known(json_t *root, const struct wd_keys *table)
{
    size_t known = 0;
    for (const struct wd_key *key = table->keys; key->name; key++)
        known += json_object_get(root, key->name) != NULL;
    return known;
}

bool wd_scene_text_is_species(const char *path, const char *text, size_t size)
{
    char *json = wd_json_blank_comments(path, text, size, &wd_log_quiet);
    json_t *root = json ? json_loadb(json, strlen(json), 0, NULL) : NULL;
    size_t scene = count_known(root, &wd_scene_keys);
    bool species = count_known(root, &wd_species_keys) > scene ||
                   count_known(root, &wd_species_model_keys) > scene;
    json_decref(root);
    free(json);
    return species;
}

void wd_scene_finish(struct wd_scene *scene)
{
    wd_arena_finish(&scene->arena);
    *scene = (struct wd_scene){0};
}

const struct wd_scene_camera *wd_scene_find_camera(const struct wd_scene *scene, const char *name)
{
    for (size_t i = 0; i < scene->camera_count; i++) {
        if (strcmp(scene->cameras[i].name, name) == 0)
            return &scene->cameras[i];
    }
    return NULL;
}

int wd_scene_find_species(const struct wd_scene *scene, const char *name)
{
    for (size_t i = 0; i < scene->species_file_count; i++) {
        if (strcmp(scene->species_files[i].name, name) == 0)
            return (int)i;
    }
    return -1;
}

double wd_scene_lens_radius_m(const struct wd_scene *scene, double fov_rad)
{
    const double film_m = 0.024;
    double focal_m = 0.5 * film_m / tan(fov_rad * 0.5);
    return scene->lens.f_number > 0 ? 0.5 * focal_m / scene->lens.f_number : 0;
}
