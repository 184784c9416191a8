#include "api/sources.h"

#include <stdlib.h>
#include <sys/stat.h>

#include "api/arguments.h"
#include "api/forest.h"
#include "api/specimen.h"
#include "base/file.h"
#include "base/log.h"
#include "output/film.h"
#include "tree/export.h"
#include "tree/model_obj.h"

bool wd_source_check_output(const char *source, const char *what, const char *of,
                            const char *output, const struct wd_log *log)
{
    struct stat from, to;
    if (!source || stat(output, &to) != 0 || stat(source, &from) != 0 ||
        from.st_dev != to.st_dev || from.st_ino != to.st_ino)
        return true;
    return wd_error(log, "%s: is the %s of %s, which would be lost; name another output", output,
                    what, of);
}

/* --- species ----------------------------------------------------------------------------- */

static bool check_texture(const struct wd_species *species, const char *texture, const char *output,
                          const struct wd_log *log)
{
    if (!texture[0] || texture[0] == '*')
        return true;
    char *path = wd_model_texture_path(species->model.file, texture);
    bool ok = wd_source_check_output(path, "texture", species->name, output, log);
    free(path);
    return ok;
}

static bool check_model(const struct wd_species *species, const char *output,
                        const struct wd_log *log)
{
    const struct wd_model_file *file = &species->imported->file;
    char *library = wd_model_obj_library(species->model.file);
    bool ok = wd_source_check_output(library, "material library", species->name, output, log);
    for (uint32_t i = 0; i < file->material_count && ok; i++)
        ok = check_texture(species, file->materials[i].texture, output, log) &&
             check_texture(species, file->materials[i].cutout, output, log);
    free(library);
    return ok;
}

bool wd_species_check_output(const struct wd_species *species, const char *output,
                             const struct wd_log *log)
{
    return wd_source_check_output(species->model.file, "model", species->name, output, log) &&
           wd_source_check_output(species->path, "species file", species->name, output, log) &&
           wd_source_check_output(species->clip_file, "clip", species->name, output, log) &&
           (!species->imported || check_model(species, output, log));
}

static bool check_specimens(const struct wd_specimen *const *specimens, uint32_t count,
                            const char *output)
{
    bool ok = true;
    for (uint32_t i = 0; i < count && ok; i++) {
        const struct wd_species *species = &specimens[i]->species;
        const struct wd_log *log = &specimens[i]->log;
        const char *clip = specimens[i]->clip_mesh.volume.name;
        ok = wd_species_check_output(species, output, log) &&
             wd_source_check_output(specimens[i]->source, "species file", species->name, output,
                                    log) &&
             wd_source_check_output(clip, "clip", species->name, output, log);
    }
    return ok;
}

enum wd_result wd_specimens_check_output(const struct wd_specimen *const *specimens, uint32_t count,
                                         const char *path)
{
    if (!wd_given(path, NULL) || (count && !wd_specimens_check(specimens, count, NULL)))
        return WD_ERROR_INPUT;
    bool ok = check_specimens(specimens, count, path);
    for (uint32_t i = 0; i < count && ok; i++) {
        char *beside;
        for (uint32_t k = 0;
             ok && (beside = wd_export_obj_beside(path, specimens[i]->species.name, k)); k++) {
            ok = check_specimens(specimens, count, beside);
            free(beside);
        }
    }
    return ok ? WD_OK : WD_ERROR_INPUT;
}

/* --- scenes ------------------------------------------------------------------------------ */

/* A file that the scene names. */
static bool check_named(const struct wd_scene *scene, const char *name, const char *what,
                        const char *output, const struct wd_log *log)
{
    if (!name)
        return true;
    char *path = wd_path_beside(scene->path, name);
    bool ok = wd_source_check_output(path, what, scene->path, output, log);
    free(path);
    return ok;
}

bool wd_scene_check_output(const struct wd_scene *scene, const char *output,
                           const struct wd_log *log)
{
    bool ok = wd_source_check_output(scene->path, "scene file", scene->name, output, log) &&
              check_named(scene, scene->terrain.file, "terrain", output, log) &&
              check_named(scene, scene->water.map.file, "map of waters", output, log) &&
              check_named(scene, scene->sky.file, "sky", output, log);
    for (size_t i = 0; i < scene->layer_count && ok; i++)
        ok = check_named(scene, scene->layers[i].map.file, "map", output, log) &&
             check_named(scene, scene->layers[i].canopy.file, "canopy", output, log);
    for (size_t i = 0; i < scene->inventory_count && ok; i++)
        ok = check_named(scene, scene->inventories[i].file, "inventory", output, log);
    for (size_t i = 0; i < scene->species_file_count && ok; i++)
        ok = wd_source_check_output(scene->species_files[i].value, "species file",
                                    scene->species_files[i].name, output, log) &&
             wd_species_check_output(&scene->species[i], output, log);
    return ok;
}

enum wd_result wd_forest_check_output(const struct wd_forest *forest, const char *path,
                                      uint64_t frames, const struct wd_log *log)
{
    bool ok = wd_given(forest, log) && wd_given(path, log) &&
              wd_scene_check_output(&forest->scene, path, log) &&
              (frames == 0 || wd_film_sequence_check(path, log));
    for (uint64_t i = 0; i < frames && ok; i++) {
        char *name = wd_film_frame_name(path, i);
        ok = wd_scene_check_output(&forest->scene, name, log);
        free(name);
    }
    return ok ? WD_OK : WD_ERROR_INPUT;
}
