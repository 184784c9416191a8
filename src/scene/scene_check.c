#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "scene/scene_parts.h"
#include "weald/forest.h"

static struct wd_keys_place child(const struct wd_keys_place *place, const char *key)
{
    return (struct wd_keys_place){place->reader, place, key, 0};
}

static struct wd_keys_place item(const struct wd_keys_place *list, size_t index)
{
    return (struct wd_keys_place){list->reader, list, NULL, index};
}

/* Keys that others of the same object leave without effect are told in one warning, not refused: parts of a scene
 * are switched off to try what they do. `keys` ends with NULL. */
static void tell_unused(const struct wd_keys_place *place, const char *const *keys, const char *why)
{
    char names[256] = "";
    size_t used = 0, count = 0;
    for (; *keys; keys++)
        if (wd_keys_given(place, *keys) && used < sizeof names)
            used += (size_t)snprintf(names + used, sizeof names - used, "%s%s", count++ ? ", " : "", *keys);
    if (count)
        wd_keys_warn(place, NULL, "%s %s no effect: %s", names, count > 1 ? "have" : "has", why);
}

bool wd_scene_expand_file(const char **file, const char *key, const struct wd_keys_place *place)
{
    static const char variable[] = "${data}";
    if (!*file || !strstr(*file, "${"))
        return true;
    size_t length = sizeof variable - 1;
    if (strncmp(*file, variable, length) != 0 || strstr(*file + length, "${"))
        return wd_keys_error(place, key, "found \"%.80s\"; the one variable there is is ${data}, "
                             "at the beginning of a name", *file);
    const struct wd_scene_params *params = wd_keys_user(place);
    if (!params || !params->data_dir)
        return wd_keys_error(place, key, "found \"%.80s\", but no data directory is given; give it "
                             "with --data DIR", *file);
    char *directory = realpath(params->data_dir, NULL);
    if (!directory)
        return wd_keys_error(place, key, "the data directory %.200s does not exist",
                             params->data_dir);
    char *whole = wd_format("%s%s", directory, *file + length);
    *file = wd_arena_strdup(wd_keys_arena(place), whole);
    free(whole);
    free(directory);
    return true;
}

static bool check_readable(const char *path, bool raster, const char *key,
                           const struct wd_keys_place *place)
{
    struct stat info;
    if (stat(path, &info) != 0 && errno == ENOENT)
        return wd_keys_error(place, key, "there is no file %.200s", path);
    if (access(path, R_OK) != 0)
        return wd_keys_error(place, key, "%.200s cannot be opened: %s", path, strerror(errno));
    return raster || !S_ISDIR(info.st_mode) ||
           wd_keys_error(place, key, "%.200s is a directory, a file is wanted", path);
}

/* GDAL has names that are no file's (/vsizip/..., NETCDF:...), and rasters that are directories. */
static bool find_file(const char **file, bool raster, const struct wd_keys_place *place)
{
    const struct wd_scene_params *params = wd_keys_user(place);
    if (!wd_scene_expand_file(file, "file", place))
        return false;
    if (!*file || !params || !params->find_files ||
        (raster && (strncmp(*file, "/vsi", 4) == 0 || strchr(*file, ':'))))
        return true;
    char *path = wd_path_beside(wd_keys_path(place), *file);
    bool ok = check_readable(path, raster, "file", place);
    free(path);
    return ok;
}

static void tell_unused_of_terrain(const struct wd_scene_terrain *terrain, const struct wd_keys_place *place)
{
    static const char *const of_fractals[] = {"relief_m", "roughness", "valley", NULL};
    static const char *const of_rasters[] = {"crs", "unit", "band", "nodata", "nodata_rule", "vertical_scale", NULL};
    static const char *const of_made[] = {"size_m", NULL};
    if (terrain->kind != WD_TERRAIN_DIAMOND_SQUARE)
        tell_unused(place, of_fractals, "only \"kind\": \"diamond-square\" makes relief");
    if (terrain->kind != WD_TERRAIN_RASTER)
        tell_unused(place, of_rasters, "only \"kind\": \"raster\" reads a file");
    else
        tell_unused(place, of_made, "a raster has a size of its own (window_m takes a part)");
}

bool wd_scene_check_terrain(void *object, const struct wd_keys_place *place)
{
    struct wd_scene_terrain *terrain = object;
    if (terrain->kind == WD_TERRAIN_RASTER && !terrain->file)
        return wd_keys_error(place, NULL, "a raster terrain needs \"file\": any GDAL raster");
    if (terrain->kind == WD_TERRAIN_DIAMOND_SQUARE &&
        !(terrain->size_m[0] > 0 && terrain->size_m[1] > 0))
        return wd_keys_error(place, "size_m", "found %g x %g; both must be above 0 (only flat "
                             "ground can be fitted to inventories)", terrain->size_m[0],
                             terrain->size_m[1]);
    if (terrain->kind != WD_TERRAIN_RASTER && terrain->file)
        return wd_keys_error(place, "file", "only a terrain of \"kind\": \"raster\" has a file");
    if (terrain->kind == WD_TERRAIN_FLAT && (terrain->size_m[0] == 0) != (terrain->size_m[1] == 0))
        return wd_keys_error(place, "size_m", "found %g x %g; either both are above 0, or both are "
                             "0: fitted to the inventories", terrain->size_m[0],
                             terrain->size_m[1]);
    const double *window = terrain->window_m;
    if (terrain->window_count && (window[0] >= window[2] || window[1] >= window[3]))
        return wd_keys_error(place, "window_m", "found [%.9g, %.9g, %.9g, %.9g]; allowed is [xmin, "
                             "ymin, xmax, ymax] with xmin < xmax and ymin < ymax", window[0],
                             window[1], window[2], window[3]);
    tell_unused_of_terrain(terrain, place);
    terrain->checked = true;
    return find_file(&terrain->file, true, place);
}

bool wd_scene_check_sky(void *object, const struct wd_keys_place *place)
{
    struct wd_scene_sky *sky = object;
    if (sky->file && sky->cover > 0)
        return wd_keys_error(place, "cover", "found %g beside a \"file\"; a map has its own clouds: "
                             "allowed is 0", sky->cover);
    if (!sky->file && sky->turn_deg != 0)
        return wd_keys_error(place, "turn_deg", "found %g without a \"file\"; only a map can be "
                             "turned", sky->turn_deg);
    return find_file(&sky->file, false, place);
}

bool wd_scene_check_map(void *object, const struct wd_keys_place *place)
{
    struct wd_scene_map *map = object;
    bool ranged = map->value_range[0] != map->value_range[1];
    if (!map->file && (map->class_count || map->class_density_count || ranged))
        return wd_keys_error(place, NULL, "\"file\" is missing; it names a raster");
    if (map->class_density_count && map->class_density_count != map->class_count)
        return wd_keys_error(place, "class_density", "found %zu numbers for %zu classes; allowed "
                             "is one for each", map->class_density_count, map->class_count);
    if (map->class_count && ranged)
        return wd_keys_error(place, "value_range", "found together with classes; allowed is one of "
                             "the two");
    return find_file(&map->file, true, place);
}

static bool check_layer_maps(const struct wd_scene_layer *layer, const struct wd_keys_place *place)
{
    const struct wd_scene_map *map = &layer->map, *canopy = &layer->canopy;
    if (map->file && !map->class_count && map->value_range[0] == map->value_range[1])
        return wd_keys_error(place, "map", "needs \"classes\" (values where trees stand) or "
                             "\"value_range\" (values at probability 0 and 1, not the same)");
    if (canopy->class_count || canopy->value_range[0] != canopy->value_range[1])
        return wd_keys_error(place, "canopy", "a raster of heights has neither classes nor "
                             "value_range");
    if (layer->placement == WD_PLACE_CANOPY && !canopy->file)
        return wd_keys_error(place, NULL, "canopy placement needs \"canopy\": { \"file\": ... }, a "
                             "raster of canopy heights");
    return true;
}

/* What was measured stands where it is, unless the scene itself says where trees may. */
static void settle_canopy(struct wd_scene_layer *layer, const struct wd_keys_place *place)
{
    static const char *const of_grids[] = {"density", "height_m", NULL}, *const of_canopies[] = {"canopy", NULL};
    if (layer->placement != WD_PLACE_CANOPY) {
        tell_unused(place, of_canopies, "only \"placement\": \"canopy\" reads it");
        return;
    }
    tell_unused(place, of_grids, "the canopy says where trees stand and how tall they are");
    if (!wd_keys_given(place, "slope_deg"))
        layer->slope_deg[0] = 0, layer->slope_deg[1] = 90;
}

bool wd_scene_check_layer(void *object, const struct wd_keys_place *place)
{
    struct wd_scene_layer *layer = object;
    double sum = 0;
    for (size_t i = 0; i < layer->species_count; i++)
        sum += layer->species[i].share;
    bool ok = true;
    if (!(sum > 0))
        ok = wd_keys_error(place, "species", "the shares sum to 0; at least one must be above 0");
    if (layer->placement != WD_PLACE_POISSON && layer->density > 1)
        ok = wd_keys_error(place, "density", "found %g; allowed is a probability from 0 to 1 "
                           "(only poisson takes a mean number of trees)", layer->density);
    if (layer->yaw_count > 1)
        ok = wd_keys_error(place, "yaw_deg", "found %zu angles; allowed is one", layer->yaw_count);
    settle_canopy(layer, place);
    return check_layer_maps(layer, place) && ok;
}

static bool frame_known(const char *frame)
{
    if (strcmp(frame, "local") == 0 || strcmp(frame, "projected") == 0)
        return true;
    size_t digits = strncmp(frame, "EPSG:", 5) == 0 ? strspn(frame + 5, "0123456789") : 0;
    return digits > 0 && digits < 8 && frame[5 + digits] == '\0';
}

bool wd_scene_check_inventory(void *object, const struct wd_keys_place *place)
{
    struct wd_scene_inventory *inventory = object;
    bool ok = true;
    if (inventory->delimiter && strlen(inventory->delimiter) != 1)
        ok = wd_keys_error(place, "delimiter", "found \"%.20s\"; allowed is one character, such as "
                           "\",\", \";\" or \"\\t\"", inventory->delimiter);
    if (!frame_known(inventory->frame))
        ok = wd_keys_error(place, "frame", "found \"%.60s\"; allowed is \"local\", \"projected\" "
                           "or \"EPSG:n\"", inventory->frame);
    else if (inventory->rotate_deg != 0 && strcmp(inventory->frame, "local") != 0)
        ok = wd_keys_error(place, "rotate_deg", "only the local frame can be turned");
    return find_file(&inventory->file, false, place) && ok;
}

bool wd_scene_check_camera(void *object, const struct wd_keys_place *place)
{
    static const char *const turns[] = {"yaw_deg", "pitch_deg", NULL};
    const struct wd_scene_camera *camera = object;
    const double *at = camera->position_m;
    /* of projected coordinates it is told once the terrain says where it is */
    bool local = strcmp(camera->frame, "local") == 0;
    if (local && fmax(fmax(fabs(at[0]), fabs(at[1])), fabs(at[2])) >= WD_MOST_PLACE_M)
        return wd_keys_error(place, "position_m", "found [%.10g, %.10g, %.10g]; allowed is less than "
                             "%.10g each way", at[0], at[1], at[2], WD_MOST_PLACE_M);
    if (camera->look_at_count && memcmp(camera->look_at_m, camera->position_m,
                                        sizeof camera->position_m) == 0)
        return wd_keys_error(place, "look_at_m", "is the camera's own position; it must be "
                             "another point");
    if (camera->look_at_count)
        tell_unused(place, turns, "look_at_m says where to look");
    return true;
}

bool wd_scene_check_path(void *object, const struct wd_keys_place *place)
{
    const struct wd_scene_path *path = object;
    if (path->key_count < 2)
        return wd_keys_error(place, "keys", "found %zu; a path needs at least two keys",
                             path->key_count);
    return true;
}

/* Ground of no size is made under inventories. A terrain that was refused has no size that the file names. */
static bool check_size(const struct wd_scene *scene, const struct wd_keys_place *place)
{
    const struct wd_scene_terrain *terrain = &scene->terrain;
    struct wd_keys_place here = child(place, "terrain");
    return terrain->kind != WD_TERRAIN_FLAT || terrain->size_m[0] > 0 || terrain->window_count ||
           scene->inventory_count || !terrain->checked ||
           wd_keys_error(&here, "size_m", "found 0 x 0, to be fitted to inventories, of which there are "
                         "none; both must be above 0");
}

/* Names of items that begin with `const char *name`, of which no two may be the same. */
static bool check_unique(const void *items, size_t count, size_t size, const char *key,
                         const struct wd_keys_place *place)
{
    struct wd_keys_place list = child(place, key);
    bool ok = true;
    for (size_t i = 0; i < count; i++) {
        const char *const *name = (const void *)((const char *)items + i * size);
        for (size_t j = 0; j < i && *name; j++) {
            const char *const *other = (const void *)((const char *)items + j * size);
            struct wd_keys_place here = item(&list, i);
            if (*other && strcmp(*name, *other) == 0) {
                ok = wd_keys_error(&here, "name", "\"%.60s\" is the name of %s[%zu] already", *name,
                                   key, j);
                break;
            }
        }
    }
    return ok;
}

static void name_layers(struct wd_scene *scene, struct wd_arena *arena)
{
    for (size_t i = 0; i < scene->layer_count; i++) {
        if (scene->layers[i].name)
            continue;
        char *name = wd_format("layer %zu", i + 1);
        scene->layers[i].name = wd_arena_strdup(arena, name);
        free(name);
    }
}

static void name_scene(struct wd_scene *scene, const struct wd_keys_place *place)
{
    const char *slash = strrchr(wd_keys_path(place), '/');
    char *name = wd_arena_strdup(wd_keys_arena(place), slash ? slash + 1 : wd_keys_path(place));
    char *dot = strrchr(name, '.');
    if (dot && dot != name)
        *dot = '\0';
    scene->name = name;
}

static void add_automatic_camera(struct wd_scene *scene, struct wd_arena *arena)
{
    scene->cameras = wd_arena_alloc(arena, sizeof *scene->cameras);
    scene->camera_count = 1;
    scene->cameras[0] = (struct wd_scene_camera){
        .name = "default", .frame = "local", .fov_deg = 50, .automatic = true};
}

bool wd_scene_check(void *object, const struct wd_keys_place *place)
{
    struct wd_scene *scene = object;
    struct wd_arena *arena = wd_keys_arena(place);
    scene->path = wd_arena_strdup(arena, wd_keys_path(place));
    if (!scene->name)
        name_scene(scene, place);
    bool ok = check_unique(scene->cameras, scene->camera_count, sizeof *scene->cameras, "cameras",
                           place);
    ok = check_unique(scene->paths, scene->path_count, sizeof *scene->paths, "paths", place) && ok;
    ok = check_unique(scene->layers, scene->layer_count, sizeof *scene->layers, "layers", place) &&
         ok;
    name_layers(scene, arena);
    ok = check_size(scene, place) && ok;
    if (scene->camera_count == 0)
        add_automatic_camera(scene, arena);
    ok = wd_scene_load_species(scene, place) && ok;
    ok = ok && wd_scene_apply_time(scene, place);
    const struct wd_scene_params *params = wd_keys_user(place);
    bool bare = scene->layer_count == 0 && scene->inventory_count == 0;
    if (ok && bare && !(params && params->planted))
        wd_warn(wd_keys_log(place), "%s: has neither layers nor inventories: bare ground",
                wd_keys_path(place));
    return ok;
}
