#include "api/forest.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <xxhash.h>

#include "base/clock.h"
#include "base/file.h"
#include "picture_key.h"
#include "tree/clip_mesh.h"
#include "tree/import.h"
#include "weald/reference.h"

static const size_t MAX_TEXT_BYTES = (size_t)1 << 30;

uint64_t wd_code_key(void)
{
    return WD_CODE_KEY;
}

static uint64_t text_key(uint64_t key, const char *text)
{
    return XXH64(text, strlen(text) + 1, key);
}

static bool add_file(uint64_t *key, const char *path, const struct wd_log *log)
{
    char *data;
    size_t size;
    struct stat info;
    double now_s = wd_clock_s();
    if (stat(path, &info) == 0 && !S_ISREG(info.st_mode)) { /* a pipe is read once: no key is equal */
        *key = XXH64(&now_s, sizeof now_s, *key);
        return true;
    }
    if (!wd_file_read(path, MAX_TEXT_BYTES, log, &data, &size))
        return false;
    *key = XXH64(data, size, *key);
    free(data);
    return true;
}

bool wd_forest_key_files(struct wd_forest *forest, const struct wd_forest_params *params)
{
    const struct wd_scene *scene = &forest->scene;
    uint64_t key = 0;
    bool ok = add_file(&key, params->scene_path, &forest->log);
    for (size_t i = 0; ok && i < scene->species_file_count; i++)
        ok = add_file(&key, scene->species_files[i].value, &forest->log);
    forest->methods_key = 0;
    for (size_t i = 0; params->settings && params->settings[i]; i++) {
        const char *setting = params->settings[i];
        uint64_t *of = strncmp(setting, "methods.", 8) == 0 ? &forest->methods_key : &key;
        *of = text_key(*of, setting);
    }
    forest->key = key;
    return ok;
}

/* --- what rasters and models have become ------------------------------------------------------- */

static uint64_t array_key(uint64_t key, const void *items, size_t count, size_t size)
{
    return items ? XXH64(items, count * size, key) : key + 1;
}

static uint64_t mesh_key(uint64_t key, const struct wd_tree_mesh *mesh)
{
    key = array_key(key, mesh->vertices, mesh->vertex_count, sizeof *mesh->vertices);
    return array_key(key, mesh->indices, mesh->index_count, sizeof *mesh->indices);
}

static uint64_t import_key(uint64_t key, const struct wd_tree_import *import)
{
    key = mesh_key(key, &import->model.full);
    for (size_t i = 0; i < import->materials.picture_count; i++) {
        const struct wd_model_image *image = &import->materials.pictures[i].image;
        key = array_key(key, image->rgba, (size_t)image->width * image->height, 4);
    }
    return key;
}

static uint64_t world_key(uint64_t key, const struct wd_world *world)
{
    const struct wd_terrain *terrain = &world->terrain;
    size_t samples = (size_t)terrain->width * terrain->height;
    key ^= wd_world_hash(world);
    key = array_key(key, &terrain->cell_m, 1, sizeof terrain->cell_m);
    key = array_key(key, terrain->origin_m, 2, sizeof *terrain->origin_m);
    key = array_key(key, terrain->height_m, samples, sizeof *terrain->height_m);
    key = array_key(key, terrain->hole, samples, 1);
    key = array_key(key, terrain->water_m, samples, sizeof *terrain->water_m);
    key = array_key(key, world->sky.sun_direction, 3, sizeof(float));
    key = array_key(key, world->sky.sun_irradiance, 3, sizeof(float));
    return array_key(key, world->sky.rgb, (size_t)world->sky.width * world->sky.height * 3,
                     sizeof *world->sky.rgb);
}

uint64_t wd_reference_key(const struct wd_forest *forest)
{
    const struct wd_scene *scene = &forest->scene;
    uint64_t key = world_key(forest->key ^ WD_CODE_KEY, &forest->world);
    for (size_t i = 0; i < scene->species_file_count; i++) {
        const struct wd_species *species = &scene->species[i];
        if (species->imported)
            key = import_key(key, species->imported);
        if (species->clip)
            key = array_key(key, species->clip->volume.positions_m,
                            3 * (size_t)species->clip->volume.vertex_count, sizeof(float));
    }
    return key;
}

uint64_t wd_forest_key(const struct wd_forest *forest)
{
    uint64_t key = wd_reference_key(forest);
    return XXH64(&forest->methods_key, sizeof forest->methods_key, key);
}
