#include "api/sources.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "api/arguments.h"
#include "api/forest.h"
#include "api/specimen.h"
#include "base/file.h"
#include "base/log.h"
#include "base/memory.h"
#include "output/film.h"
#include "tree/export.h"
#include "tree/model_beside.h"
#include "tree/model_obj.h"

/* --- outputs ----------------------------------------------------------------------------- */

/* A file that is there and would be written. */
struct there {
    dev_t device;
    ino_t number;
    uint64_t frame; /* of numbered pictures */
};

/* What would be lost: a file, or of numbered pictures those that are there, sorted. */
struct outputs {
    const char *path;
    bool numbered;
    struct there *items;
    size_t count, capacity;
};

static void add_there(struct outputs *outputs, const struct stat *status, uint64_t frame)
{
    struct there *added = wd_push(outputs->items, outputs->count, outputs->capacity);
    *added = (struct there){status->st_dev, status->st_ino, frame};
}

static void outputs_init(struct outputs *outputs, const char *path)
{
    struct stat status;
    *outputs = (struct outputs){.path = path};
    if (stat(path, &status) == 0)
        add_there(outputs, &status, 0);
}

static int compare_files(const void *first, const void *second)
{
    const struct there *a = first, *b = second;
    if (a->device != b->device)
        return a->device < b->device ? -1 : 1;
    return a->number != b->number ? a->number < b->number ? -1 : 1 : 0;
}

/* The folder is read, not each name tried: there may be millions of frames to come. */
static void outputs_init_numbered(struct outputs *outputs, const char *pattern, uint64_t frames)
{
    const char *slash = strrchr(pattern, '/');
    char *folder = slash ? wd_format("%.*s", (int)(slash + 1 - pattern), pattern) : wd_strdup(".");
    DIR *stream = opendir(folder);
    struct stat status;
    uint64_t frame;
    *outputs = (struct outputs){.path = pattern, .numbered = true};
    for (struct dirent *entry; stream && (entry = readdir(stream));)
        if (wd_film_frame_number(pattern, entry->d_name, &frame) && frame < frames &&
            fstatat(dirfd(stream), entry->d_name, &status, 0) == 0)
            add_there(outputs, &status, frame);
    if (stream)
        closedir(stream);
    free(folder);
    if (outputs->count)
        qsort(outputs->items, outputs->count, sizeof *outputs->items, compare_files);
}

static void outputs_finish(struct outputs *outputs)
{
    free(outputs->items);
    *outputs = (struct outputs){0};
}

/* False, logged, where `source`, the `what` of `of`, would be lost; NULL is none. */
static bool check_source(const char *source, const char *what, const char *of,
                         const struct outputs *outputs, const struct wd_log *log)
{
    struct stat status;
    if (!source || outputs->count == 0 || stat(source, &status) != 0)
        return true;
    const struct there key = {status.st_dev, status.st_ino, 0};
    const struct there *lost =
        bsearch(&key, outputs->items, outputs->count, sizeof key, compare_files);
    if (!lost)
        return true;
    char *name = outputs->numbered ? wd_film_frame_name(outputs->path, lost->frame) : NULL;
    wd_error(log, "%s: is the %s of %s, which would be lost; name another output",
             name ? name : outputs->path, what, of);
    free(name);
    return false;
}

/* --- species ----------------------------------------------------------------------------- */

static bool check_texture(const struct wd_species *species, const char *texture,
                          const struct outputs *outputs, const struct wd_log *log)
{
    if (!texture[0] || texture[0] == '*')
        return true;
    char *path = wd_model_beside(species->model.file, texture);
    bool ok = check_source(path, "texture", species->name, outputs, log);
    free(path);
    return ok;
}

static bool check_model(const struct wd_species *species, const struct outputs *outputs,
                        const struct wd_log *log)
{
    const struct wd_model_file *file = &species->imported->file;
    char *library = wd_model_obj_library(species->model.file);
    bool ok = check_source(library, "material library", species->name, outputs, log);
    for (uint32_t i = 0; i < file->material_count && ok; i++)
        ok = check_texture(species, file->materials[i].texture, outputs, log) &&
             check_texture(species, file->materials[i].cutout, outputs, log);
    free(library);
    return ok;
}

static bool check_species(const struct wd_species *species, const struct outputs *outputs,
                          const struct wd_log *log)
{
    return check_source(species->model.file, "model", species->name, outputs, log) &&
           check_source(species->path, "species file", species->name, outputs, log) &&
           check_source(species->clip_file, "clip", species->name, outputs, log) &&
           (!species->imported || check_model(species, outputs, log));
}

static bool check_specimens(const struct wd_specimen *const *specimens, uint32_t count,
                            const char *output)
{
    struct outputs file;
    outputs_init(&file, output);
    bool ok = true;
    for (uint32_t i = 0; i < count && ok; i++) {
        const struct wd_species *species = &specimens[i]->species;
        const struct wd_log *log = &specimens[i]->log;
        const char *clip = specimens[i]->clip_mesh.volume.name;
        ok = check_species(species, &file, log) &&
             check_source(specimens[i]->source, "species file", species->name, &file, log) &&
             check_source(clip, "clip", species->name, &file, log);
    }
    outputs_finish(&file);
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
                        const struct outputs *outputs, const struct wd_log *log)
{
    if (!name)
        return true;
    char *path = wd_path_beside(scene->path, name);
    bool ok = check_source(path, what, scene->path, outputs, log);
    free(path);
    return ok;
}

static bool check_scene(const struct wd_scene *scene, const struct outputs *outputs,
                        const struct wd_log *log)
{
    bool ok = check_source(scene->path, "scene file", scene->name, outputs, log) &&
              check_named(scene, scene->terrain.file, "terrain", outputs, log) &&
              check_named(scene, scene->water.map.file, "map of waters", outputs, log) &&
              check_named(scene, scene->sky.file, "sky", outputs, log);
    for (size_t i = 0; i < scene->layer_count && ok; i++)
        ok = check_named(scene, scene->layers[i].map.file, "map", outputs, log) &&
             check_named(scene, scene->layers[i].canopy.file, "canopy", outputs, log);
    for (size_t i = 0; i < scene->inventory_count && ok; i++)
        ok = check_named(scene, scene->inventories[i].file, "inventory", outputs, log);
    for (size_t i = 0; i < scene->species_file_count && ok; i++)
        ok = check_source(scene->species_files[i].value, "species file",
                          scene->species_files[i].name, outputs, log) &&
             check_species(&scene->species[i], outputs, log);
    return ok;
}

bool wd_scene_check_output(const struct wd_scene *scene, const char *output,
                           const struct wd_log *log)
{
    struct outputs file;
    outputs_init(&file, output);
    bool ok = check_scene(scene, &file, log);
    outputs_finish(&file);
    return ok;
}

enum wd_result wd_forest_check_output(const struct wd_forest *forest, const char *path,
                                      uint64_t frames, const struct wd_log *log)
{
    if (!wd_given(forest, log) || !wd_given(path, log))
        return WD_ERROR_INPUT;
    if (frames == 0)
        return wd_scene_check_output(&forest->scene, path, log) ? WD_OK : WD_ERROR_INPUT;
    if (!wd_film_sequence_check(path, log))
        return WD_ERROR_INPUT;
    struct outputs pictures;
    outputs_init_numbered(&pictures, path, frames);
    bool ok = check_scene(&forest->scene, &pictures, log);
    outputs_finish(&pictures);
    return ok ? WD_OK : WD_ERROR_INPUT;
}
