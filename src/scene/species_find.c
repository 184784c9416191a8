#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/latin_names.h"
#include "scene/nearest.h"
#include "scene/species.h"
#include "scene/species_folders.h"

enum { MAX_NAMES = 256 };

static int compare_names(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* Names of the species in the first folder that has any, sorted. */
static size_t list_names(const struct wd_species_folders *folders, const char **names,
                         struct wd_arena *arena)
{
    size_t count = 0;
    for (size_t i = 0; i < folders->count && count == 0; i++) {
        DIR *folder = opendir(folders->paths[i]);
        for (struct dirent *entry; folder && count < MAX_NAMES && (entry = readdir(folder));) {
            size_t length = strlen(entry->d_name);
            if (length <= 5 || strcmp(entry->d_name + length - 5, ".json") != 0)
                continue;
            char *name = wd_arena_strdup(arena, entry->d_name);
            name[length - 5] = '\0';
            names[count++] = name;
        }
        if (folder)
            closedir(folder);
    }
    qsort(names, count, sizeof *names, compare_names);
    return count;
}

size_t wd_species_list(const char ***names, struct wd_arena *arena)
{
    struct wd_species_folders folders;
    wd_species_folders_init(&folders, NULL);
    *names = wd_arena_alloc(arena, MAX_NAMES * sizeof **names);
    size_t count = list_names(&folders, *names, arena);
    wd_species_folders_finish(&folders);
    return count;
}

static void complain_of_folders(const char *name, const struct wd_species_folders *folders,
                                const struct wd_log *log)
{
    char *text = wd_species_folders_text(folders);
    wd_error(log, "unknown species \"%.60s\"; name a species file (.json) or a model (.obj, .gltf, .glb, "
             ".fbx, .dae) by its path; it was looked for in %s", name, text);
    free(text);
}

static void complain(const char *name, const struct wd_species_folders *folders,
                     const struct wd_log *log)
{
    struct wd_arena arena = {0};
    const char *names[MAX_NAMES];
    size_t count = list_names(folders, names, &arena), used = 0;
    if (count == 0) {
        complain_of_folders(name, folders, log);
        return;
    }
    const char *near = wd_nearest_name(name, names, count);
    char list[1024] = "";
    for (size_t i = 0; i < count && used < sizeof list; i++)
        used += (size_t)snprintf(list + used, sizeof list - used, "%s%.40s", i ? ", " : "",
                                 names[i]);
    wd_error(log, "unknown species \"%.60s\"%s%.40s%s Known are: %s; or name a species file (.json) "
             "or a model (.obj, .gltf, .glb, .fbx, .dae)", name, near ? "; did you mean \"" : ".",
             near ? near : "", near ? "\"?" : "", list);
    wd_arena_finish(&arena);
}

static char *find_latin(const char *name, const struct wd_species_folders *folders)
{
    struct wd_latin_names latin;
    wd_latin_names_init(&latin, folders);
    const struct wd_latin_name *found = wd_latin_names_find(&latin, name);
    char *path = found ? wd_strdup(found->file) : NULL;
    wd_latin_names_finish(&latin);
    return path;
}

char *wd_species_find_file(const char *name, const struct wd_log *log)
{
    struct wd_species_folders folders;
    wd_species_folders_init(&folders, NULL);
    char *path = wd_species_folders_find(&folders, name);
    if (!path && wd_name_has_words(name))
        path = find_latin(name, &folders);
    if (!path)
        complain(name, &folders, log);
    wd_species_folders_finish(&folders);
    return path;
}
