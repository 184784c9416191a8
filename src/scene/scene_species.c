#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "scene/latin_names.h"
#include "scene/scene_parts.h"
#include "scene/species_folders.h"

enum { MAX_SPECIES = 255 };

struct loader {
    const struct wd_keys_place *root;
    const struct wd_scene *scene; /* its clips are known */
    struct wd_string_pair *files;
    size_t count, capacity;
    struct wd_species_folders folders; /* where species without a file are looked for */
    struct wd_latin_names latin;       /* of those, once they are asked for */
    bool has_latin;
    size_t made_first; /* from here on: what stands for another and is of its file */
    const char **own_latin; /* of files, as far as it was asked for; NULL: has none */
    size_t own_count, own_capacity;
};

static bool has(const struct loader *loader, const char *name)
{
    for (size_t i = 0; i < loader->count; i++) {
        if (strcmp(loader->files[i].name, name) == 0)
            return true;
    }
    return false;
}

static const char *file_of(const struct loader *loader, const char *name)
{
    size_t i = 0;
    while (strcmp(loader->files[i].name, name) != 0)
        i++;
    return loader->files[i].value;
}

static void add(struct loader *loader, const char *name, const char *file)
{
    struct wd_arena *arena = wd_keys_arena(loader->root);
    struct wd_string_pair *pair = wd_push(loader->files, loader->count, loader->capacity);
    *pair = (struct wd_string_pair){wd_arena_strdup(arena, name), wd_arena_strdup(arena, file)};
}

struct names {
    const char **items;
    size_t count, capacity;
};

static void push_name(struct names *names, const char *name, size_t length, struct wd_arena *arena)
{
    for (size_t i = 0; i < names->count; i++) {
        if (strlen(names->items[i]) == length && strncmp(names->items[i], name, length) == 0)
            return;
    }
    char *copy = wd_arena_alloc(arena, length + 1);
    memcpy(copy, name, length);
    *wd_push(names->items, names->count, names->capacity) = copy;
}

static int compare_names(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* Every species there is: those the scene names and those lying in the folders, sorted. */
static struct names known_names(const struct loader *loader)
{
    struct names names = {0};
    struct wd_arena *arena = wd_keys_arena(loader->root);
    for (size_t i = 0; i < loader->count; i++)
        push_name(&names, loader->files[i].name, strlen(loader->files[i].name), arena);
    for (size_t i = 0; i < loader->folders.count; i++) {
        DIR *folder = opendir(loader->folders.paths[i]);
        for (struct dirent *entry; folder && (entry = readdir(folder));) {
            size_t length = strlen(entry->d_name);
            if (length > 5 && strcmp(entry->d_name + length - 5, ".json") == 0)
                push_name(&names, entry->d_name, length - 5, arena);
        }
        if (folder)
            closedir(folder);
    }
    if (names.count)
        qsort(names.items, names.count, sizeof *names.items, compare_names);
    return names;
}

static bool no_species(const struct loader *loader, const char *name, const struct wd_keys_place *place,
                       const char *key)
{
    char *text = wd_species_folders_text(&loader->folders);
    wd_keys_error(place, key, "unknown species \"%.60s\"; say which file it is, at the scene's root: "
                  "\"species\": {\"%.60s\": \"PATH.json\"}; it was looked for in %s", name, name, text);
    free(text);
    return false;
}

static bool unknown_species(const struct loader *loader, const char *name,
                            const struct wd_keys_place *place, const char *key)
{
    struct names names = known_names(loader);
    const char *near = wd_nearest_name(name, names.items, names.count);
    char hint[80] = "", list[512] = "";
    if (near)
        snprintf(hint, sizeof hint, "; did you mean \"%.40s\"?", near);
    size_t used = 0;
    for (size_t i = 0; i < names.count && used < sizeof list; i++)
        used += (size_t)snprintf(list + used, sizeof list - used, "%s%.40s", used ? ", " : "",
                                 names.items[i]);
    free(names.items);
    if (!near && names.count <= loader->count) /* no folder has another */
        return no_species(loader, name, place, key);
    return wd_keys_error(place, key, "unknown species \"%.60s\"%s Known are: %s", name,
                         near ? hint : ".", list);
}

static bool is_clipped(const struct loader *loader, const char *name)
{
    for (size_t i = 0; i < loader->scene->clip_count; i++)
        if (strcmp(loader->scene->clips[i].name, name) == 0)
            return true;
    return false;
}

/* Each file is read once, however many names are looked up. */
static const char *latin_of(struct loader *loader, size_t index)
{
    while (loader->own_count <= index) {
        struct wd_species species;
        bool known = wd_species_load(&species, loader->files[loader->own_count].value, wd_keys_arena(loader->root),
                                     &wd_log_quiet);
        *wd_push(loader->own_latin, loader->own_count, loader->own_capacity) = known ? species.latin : NULL;
    }
    return loader->own_latin[index];
}

/* Which of the scene's species so far has the Latin name, but for hedges; NULL: none. */
static const char *find_own_latin(struct loader *loader, const char *name)
{
    for (size_t i = 0; i < loader->count; i++) {
        const char *latin = is_clipped(loader, loader->files[i].name) ? NULL : latin_of(loader, i);
        if (latin && wd_name_is_latin(name, latin))
            return loader->files[i].name;
    }
    return NULL;
}

/* The installed species of that Latin name; NULL: there is none. */
static const struct wd_latin_name *find_installed_latin(struct loader *loader, const char *name)
{
    if (!wd_name_has_words(name) || strchr(name, '/'))
        return NULL;
    if (!loader->has_latin)
        wd_latin_names_init(&loader->latin, &loader->folders);
    loader->has_latin = true;
    return wd_latin_names_find(&loader->latin, name);
}

/* A Latin name becomes that which the scene, or else the folder has for the species; where the scene calls another species
 * so it stays. */
static bool want_latin(struct loader *loader, const char **name)
{
    const char *own = wd_name_has_words(*name) ? find_own_latin(loader, *name) : NULL;
    const struct wd_latin_name *found = own ? NULL : find_installed_latin(loader, *name);
    if (own)
        *name = own;
    else if (found && has(loader, found->name))
        add(loader, *name, found->file);
    else if (found) {
        add(loader, found->name, found->file);
        *name = wd_arena_strdup(wd_keys_arena(loader->root), found->name);
    }
    return own || found;
}

/* Finds the file of a species that has no entry in the scene. A name is no path. */
static bool want(struct loader *loader, const char **name, const struct wd_keys_place *place,
                 const char *key)
{
    if (!*name || has(loader, *name)) /* no name: an error that has been reported */
        return true;
    char *file = wd_species_folders_find(&loader->folders, *name);
    if (!file)
        return want_latin(loader, name) || unknown_species(loader, *name, place, key);
    add(loader, *name, file);
    free(file);
    return true;
}

/* What an entry of "species" says: a path beside the scene, or the name of an installed species. free() it. */
static char *entry_file(struct loader *loader, const char *value)
{
    char *file = wd_path_beside(wd_keys_path(loader->root), value);
    if (wd_file_exists(file))
        return file;
    char *named = wd_species_folders_find(&loader->folders, value);
    const struct wd_latin_name *latin = named ? NULL : find_installed_latin(loader, value);
    if (latin)
        named = wd_strdup(latin->file);
    if (!named)
        return file;
    free(file);
    return named;
}

static bool take_entries(struct loader *loader, const struct wd_scene *scene)
{
    const struct wd_keys_place *root = loader->root;
    struct wd_keys_place map = {root->reader, root, "species", 0};
    bool ok = true;
    for (size_t i = 0; i < scene->species_file_count; i++) {
        struct wd_string_pair entry = scene->species_files[i];
        if (!entry.value || !wd_scene_expand_file(&entry.value, entry.name, &map)) {
            ok = false;
            continue;
        }
        char *file = entry_file(loader, entry.value);
        if (wd_file_exists(file))
            add(loader, entry.name, file);
        else
            ok = wd_keys_error(&map, entry.name, "there is no file %.200s", file);
        free(file);
    }
    return ok;
}

static bool take_layers(struct loader *loader, const struct wd_scene *scene)
{
    const struct wd_keys_place *root = loader->root;
    struct wd_keys_place list = {root->reader, root, "layers", 0};
    bool ok = true;
    for (size_t i = 0; i < scene->layer_count; i++) {
        struct wd_keys_place layer = {root->reader, &list, NULL, i};
        struct wd_keys_place shares = {root->reader, &layer, "species", 0};
        for (size_t j = 0; j < scene->layers[i].species_count; j++) {
            const char **name = &scene->layers[i].species[j].name;
            ok = want(loader, name, &shares, *name) && ok;
        }
    }
    return ok;
}

static bool take_inventories(struct loader *loader, const struct wd_scene *scene)
{
    const struct wd_keys_place *root = loader->root;
    struct wd_keys_place list = {root->reader, root, "inventories", 0};
    bool ok = true;
    for (size_t i = 0; i < scene->inventory_count; i++) {
        struct wd_scene_inventory *inventory = &scene->inventories[i];
        struct wd_keys_place here = {root->reader, &list, NULL, i};
        struct wd_keys_place map = {root->reader, &here, "species", 0};
        for (size_t j = 0; j < inventory->species_count; j++)
            ok = want(loader, &inventory->species[j].value, &map, inventory->species[j].name) && ok;
        if (ok && loader->count == 0)
            ok = wd_keys_error(&here, NULL, "names no species; say which species the names in its file are: "
                               "\"species\": { \"Picea abies\": \"spruce\", \"*\": \"oak\" }, \"*\" for all others");
    }
    return ok;
}

/* Species that stand for others: which ones, and where the scene says so. */
struct stand_ins {
    const char *key;
    struct wd_string_pair *pairs;
    size_t count;
};

static struct stand_ins young_ones(const struct wd_scene *scene)
{
    return (struct stand_ins){"when_young", scene->when_young, scene->when_young_count};
}

static struct stand_ins open_ones(const struct wd_scene *scene)
{
    return (struct stand_ins){"in_the_open", scene->in_the_open, scene->in_the_open_count};
}

/* They are of the same file where the scene does not say another. */
static bool take_stand_ins(struct loader *loader, struct stand_ins of)
{
    struct wd_keys_place map = {loader->root->reader, loader->root, of.key, 0};
    bool ok = true;
    for (size_t i = 0; i < of.count; i++) {
        const struct wd_string_pair *pair = &of.pairs[i];
        const char *own = has(loader, pair->name) ? pair->name : find_own_latin(loader, pair->name);
        if (!own)
            ok = wd_keys_error(&map, pair->name, "no layer or inventory has the species \"%.60s\"", pair->name);
        else if (pair->value && !has(loader, pair->value)) /* no value: an error that has been reported */
            add(loader, pair->value, file_of(loader, own));
    }
    return ok;
}

static bool load_all(struct loader *loader, struct wd_scene *scene)
{
    struct wd_arena *arena = wd_keys_arena(loader->root);
    if (loader->count > MAX_SPECIES)
        return wd_keys_error(loader->root, "species", "the scene has %zu species; allowed are %d",
                             loader->count, MAX_SPECIES);
    size_t bytes = loader->count * sizeof *loader->files;
    scene->species_files = wd_arena_alloc(arena, bytes + 1);
    if (bytes)
        memcpy(scene->species_files, loader->files, bytes);
    scene->species_file_count = loader->count;
    scene->species = wd_arena_alloc(arena, loader->count * sizeof *scene->species + 1);
    bool ok = true;
    for (size_t i = 0; i < loader->count; i++)
        ok = wd_species_load(&scene->species[i], loader->files[i].value, arena,
                             wd_keys_log(loader->root)) && ok;
    return ok;
}

/* The mesh itself is read later, with the models. */
static bool cut_to_mesh(const struct wd_keys_place *map, struct wd_species *species,
                        const struct wd_scene_clip *clip)
{
    char *file = wd_path_beside(wd_keys_path(map), clip->mesh);
    bool ok = wd_species_is_model_file(file) ||
              wd_keys_error(map, clip->name, "found %.200s to cut to; allowed are .obj, .gltf, "
                            ".glb, .fbx and .dae", file);
    ok = ok && (wd_file_exists(file) ||
                wd_keys_error(map, clip->name, "there is no file %.200s", file));
    species->clip_file = wd_arena_strdup(wd_keys_arena(map), file);
    free(file);
    return ok;
}

/* Free-growing forms and artists' models cannot be cut. */
static bool cut_hedge(const struct wd_keys_place *map, struct wd_species *species,
                      const struct wd_scene_clip *clip)
{
    double height_m = (double)clip->box_m[2];
    if (species->model.file || species->order_count == 0)
        return wd_keys_error(map, clip->name, "%.60s %s; allowed are grown species with branches",
                             clip->name,
                             species->model.file ? "is an artist's model" : "has no branches");
    if ((clip->mesh != NULL) == (height_m > 0))
        return wd_keys_error(map, clip->name, "found %s; allowed is one of box_m and mesh",
                             clip->mesh ? "both box_m and mesh" : "neither box_m nor mesh");
    if (clip->mesh)
        return cut_to_mesh(map, species, clip);
    if (!(height_m >= (double)species->height_range_m[0] &&
          height_m <= (double)species->height_range_m[1]))
        return wd_keys_error(map, clip->name, "the box is %g m high; the species' file allows "
                             "%g to %g", height_m, (double)species->height_range_m[0],
                             (double)species->height_range_m[1]);
    memcpy(species->clip_box_m, clip->box_m, sizeof species->clip_box_m);
    return true;
}

/* By the scene's name, or a Latin one that a layer may have; -1: there is none. */
static int find_species(const struct wd_scene *scene, const char *name)
{
    int index = wd_scene_find_species(scene, name);
    for (size_t i = 0; i < scene->species_file_count && index < 0; i++)
        if (scene->species[i].latin && wd_name_is_latin(name, scene->species[i].latin))
            index = (int)i;
    return index;
}

static bool cut_hedges(const struct loader *loader, struct wd_scene *scene)
{
    struct wd_keys_place map = {loader->root->reader, loader->root, "clips", 0};
    bool ok = true;
    for (size_t i = 0; i < scene->clip_count; i++) {
        const struct wd_scene_clip *clip = &scene->clips[i];
        int index = find_species(scene, clip->name);
        if (index < 0) {
            ok = wd_keys_error(&map, clip->name, "no layer or inventory has the species \"%.60s\"",
                               clip->name);
            continue;
        }
        ok = cut_hedge(&map, &scene->species[index], clip) && ok;
    }
    return ok;
}

static bool has_own_openness(const struct wd_scene *scene, int species)
{
    for (size_t i = 0; i < scene->openness_count; i++)
        if (find_species(scene, scene->openness[i].name) == species)
            return true;
    return false;
}

static bool set_openness(const struct loader *loader, struct wd_scene *scene)
{
    struct wd_keys_place map = {loader->root->reader, loader->root, "openness", 0};
    bool ok = true;
    for (size_t i = 0; i < scene->openness_count; i++) {
        const struct wd_number_pair *given = &scene->openness[i];
        int index = find_species(scene, given->name);
        if (index < 0)
            ok = wd_keys_error(&map, given->name,
                               "no layer or inventory has the species \"%.60s\"", given->name);
        else
            scene->species[index].openness = (float)given->value;
    }
    return ok;
}

static bool is_cut(const struct wd_species *species)
{
    return species->clip_box_m[2] > 0 || species->clip_file;
}

/* Two that may stand for one another. */
static bool find_pair(const struct wd_scene *scene, const struct wd_string_pair *names, const struct wd_keys_place *map,
                      struct wd_species *pair[2], bool *own_openness)
{
    int from = find_species(scene, names->name), to = find_species(scene, names->value);
    pair[0] = &scene->species[from];
    pair[1] = &scene->species[to];
    *own_openness = has_own_openness(scene, to);
    if (from == to)
        return wd_keys_error(map, names->name, "stands for itself");
    return !(is_cut(pair[0]) || is_cut(pair[1])) ||
           wd_keys_error(map, names->name, "is cut to a shape, or \"%.60s\" is, wherever it stands; allowed are trees that "
                         "grow freely", names->value);
}

static bool check_opener(const struct wd_keys_place *map, const struct wd_string_pair *names, struct wd_species *const pair[2])
{
    return pair[1]->openness > pair[0]->openness ||
           wd_keys_error(map, names->name, "\"%.60s\" has an openness of %g, \"%.60s\" of %g; what stands in the open must "
                         "have more", names->value, (double)pair[1]->openness, names->name, (double)pair[0]->openness);
}

/* Young trees have grown as openly as those for which they stand, those in the open more so. */
static bool link_stand_ins(const struct loader *loader, struct wd_scene *scene, struct stand_ins of, bool young)
{
    struct wd_keys_place map = {loader->root->reader, loader->root, of.key, 0};
    bool ok = true;
    for (size_t i = 0; i < of.count; i++) {
        struct wd_species *pair[2];
        bool own;
        if (!of.pairs[i].value || !find_pair(scene, &of.pairs[i], &map, pair, &own)) {
            ok = false;
            continue;
        }
        uint32_t link = 1 + (uint32_t)(pair[1] - scene->species);
        if (link > loader->made_first && !own)
            pair[1]->openness = young ? pair[0]->openness : WD_OPEN_OPENNESS;
        *(young ? &pair[0]->when_young : &pair[0]->in_the_open) = link;
        ok = (young || check_opener(&map, &of.pairs[i], pair)) && ok;
    }
    return ok;
}

/* Canopies and inventories may hold any height. */
static void note_heights(struct wd_species *species, const struct wd_scene_layer *layer)
{
    bool any = layer->placement == WD_PLACE_CANOPY, first = !(species->planted_m[0] > 0);
    float high = any ? species->height_range_m[1] : layer->height_m[1];
    float low = fmaxf(layer->height_m[0], species->height_range_m[0]);
    if (!any && (first || low < species->planted_m[0]))
        species->planted_m[0] = low;
    species->planted_m[1] = fmaxf(species->planted_m[1], high);
}

/* Whether an inventory's trees are to be of the species: by the names that it maps, or where it maps none as the first
 * of its Latin name. */
static bool may_hold(const struct wd_scene_inventory *inventory, const struct wd_scene *scene, size_t species)
{
    const char *latin = scene->species[species].latin;
    bool first = inventory->species_count == 0;
    for (size_t i = 0; i < species && first; i++)
        first = !latin || !scene->species[i].latin || strcasecmp(latin, scene->species[i].latin) != 0;
    for (size_t i = 0; i < inventory->species_count && !first; i++) {
        const char *name = inventory->species[i].value; /* NULL: an error that has been reported */
        first = name && wd_scene_find_species(scene, name) == (int)species;
    }
    return first;
}

/* A layer of heather without heights of its own would be of 14 to 28 m. */
static void tell_strange_heights(const struct loader *loader, const struct wd_species *species,
                                 const struct wd_scene *scene, size_t layer)
{
    struct wd_keys_place list = {loader->root->reader, loader->root, "layers", 0};
    struct wd_keys_place place = {loader->root->reader, &list, NULL, layer};
    const float *wanted = scene->layers[layer].height_m, *range = species->height_range_m;
    float middle = 0.5f * (wanted[0] + wanted[1]);
    bool cut = species->clip_box_m[2] > 0, own = scene->layers[layer].placement == WD_PLACE_CANOPY;
    if (!cut && !own && !(middle >= range[0] && middle <= range[1]))
        wd_keys_warn(&place, "height_m", "trees of %g to %g m are planted; those of %.60s are %g to %g m high",
                     (double)wanted[0], (double)wanted[1], species->name, (double)range[0], (double)range[1]);
}

/* Its trees are some of the other's. */
static void note_in_the_open(struct wd_scene *scene, const struct wd_string_pair *pair)
{
    const float *closed_m = scene->species[find_species(scene, pair->name)].planted_m;
    float *open_m = scene->species[find_species(scene, pair->value)].planted_m;
    open_m[0] = open_m[0] > 0 ? fminf(open_m[0], closed_m[0]) : closed_m[0];
    open_m[1] = fmaxf(open_m[1], closed_m[1]);
}

/* Its trees are all that are lower than variants of the other, whose lowest an inventory may not tell. */
static void note_when_young(struct wd_scene *scene, const struct wd_string_pair *pair)
{
    static const float LOWEST = 0.06f, SURELY_LOW = 0.2f; /* of the typical height */
    const struct wd_species *grown = &scene->species[find_species(scene, pair->name)];
    struct wd_species *young = &scene->species[find_species(scene, pair->value)];
    bool any = !(grown->planted_m[0] > 0) || grown->planted_m[1] >= grown->height_range_m[1];
    float low = any ? 0 : grown->planted_m[0], typical_m = young->typical_height_m;
    low = fminf(fmaxf(low, LOWEST * typical_m), SURELY_LOW * typical_m);
    young->planted_m[0] = young->planted_m[0] > 0 ? fminf(young->planted_m[0], low) : low;
    young->planted_m[1] = fmaxf(young->planted_m[1], nextafterf(WD_HALF_GROWN * grown->typical_height_m, 0));
}

static void note_planted(const struct loader *loader, struct wd_scene *scene)
{
    for (size_t i = 0; i < scene->layer_count; i++)
        for (size_t j = 0; j < scene->layers[i].species_count; j++) {
            int index = wd_scene_find_species(scene, scene->layers[i].species[j].name);
            if (index < 0)
                continue;
            note_heights(&scene->species[index], &scene->layers[i]);
            tell_strange_heights(loader, &scene->species[index], scene, i);
        }
    for (size_t i = 0; i < scene->species_file_count; i++)
        for (size_t j = 0; j < scene->inventory_count; j++)
            if (scene->species[i].planted_m[1] > 0 && may_hold(&scene->inventories[j], scene, i))
                scene->species[i].planted_m[1] = scene->species[i].height_range_m[1];
    for (size_t i = 0; i < scene->when_young_count; i++)
        note_when_young(scene, &scene->when_young[i]);
    for (size_t i = 0; i < scene->in_the_open_count; i++)
        note_in_the_open(scene, &scene->in_the_open[i]);
}

bool wd_scene_load_species(struct wd_scene *scene, const struct wd_keys_place *place)
{
    struct loader loader = {.root = place, .scene = scene};
    wd_species_folders_init(&loader.folders, wd_keys_path(place));
    bool ok = take_entries(&loader, scene);
    ok = take_layers(&loader, scene) && ok;
    ok = take_inventories(&loader, scene) && ok;
    loader.made_first = loader.count;
    ok = take_stand_ins(&loader, young_ones(scene)) && ok;
    ok = take_stand_ins(&loader, open_ones(scene)) && ok;
    ok = load_all(&loader, scene) && ok;
    ok = ok && cut_hedges(&loader, scene);
    ok = ok && set_openness(&loader, scene);
    ok = ok && link_stand_ins(&loader, scene, young_ones(scene), true) &&
         link_stand_ins(&loader, scene, open_ones(scene), false);
    if (ok)
        note_planted(&loader, scene);
    free(loader.own_latin);
    wd_latin_names_finish(&loader.latin);
    wd_species_folders_finish(&loader.folders);
    free(loader.files);
    return ok;
}
