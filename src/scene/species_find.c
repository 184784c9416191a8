#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "scene/nearest.h"
#include "scene/species.h"

static const char *const folders[] = {"species", "../species", WD_DATA_DIR "/species"};
enum { FOLDER_COUNT = sizeof folders / sizeof *folders, MAX_NAMES = 256 };

static int compare_names(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* Names of the species in the first folder that has any, sorted. */
static size_t list_names(const char **names, struct wd_arena *arena)
{
    size_t count = 0;
    for (size_t i = 0; i < FOLDER_COUNT && count == 0; i++) {
        DIR *folder = opendir(folders[i]);
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
    *names = wd_arena_alloc(arena, MAX_NAMES * sizeof **names);
    return list_names(*names, arena);
}

static void complain(const char *name, const struct wd_log *log)
{
    struct wd_arena arena = {0};
    const char **names;
    size_t count = wd_species_list(&names, &arena), used = 0;
    const char *near = wd_nearest_name(name, names, count);
    char list[1024] = "";
    for (size_t i = 0; i < count && used < sizeof list; i++)
        used += (size_t)snprintf(list + used, sizeof list - used, "%s%.40s", i ? ", " : "",
                                 names[i]);
    wd_error(log, "unknown species \"%.60s\"%s%.40s%s Known are: %s; or name a species file (.json) "
             "or a model (.obj, .gltf, .glb, .fbx, .dae)", name, near ? "; did you mean \"" : ".",
             near ? near : "", near ? "\"?" : "", count ? list : "none");
    wd_arena_finish(&arena);
}

char *wd_species_find_file(const char *name, const struct wd_log *log)
{
    for (size_t i = 0; i < FOLDER_COUNT && !strchr(name, '/') && name[0] != '.'; i++) {
        char *path = wd_format("%s/%s.json", folders[i], name);
        if (wd_file_exists(path))
            return path;
        free(path);
    }
    complain(name, log);
    return NULL;
}
