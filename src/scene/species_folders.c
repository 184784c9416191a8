#include "scene/species_folders.h"

#include <dlfcn.h>
#include <fnmatch.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"

#define SHARED "share/weald/species"

/* Where a program or library lies in a tree that is built or installed, the way up to the tree's root,
 * and where species lie from there. */
static const struct {
    const char *folder, *up, *species;
} trees[] = {
    {"*/cli", "../..", "species"}, {"*/src/api", "../../..", "species"}, {"*/bin", "..", SHARED},
    {"*/lib", "..", SHARED},       {"*/lib64", "..", SHARED},            {"*/lib/*-*", "../..", SHARED},
};

/* Takes the path. */
static void add(struct wd_species_folders *folders, char *path)
{
    for (size_t i = 0; i < folders->count; i++)
        if (strcmp(folders->paths[i], path) == 0) {
            free(path);
            return;
        }
    folders->paths[folders->count++] = path;
}

static void add_of_tree(struct wd_species_folders *folders, const char *file)
{
    char *whole = realpath(file, NULL), *folder = whole ? wd_path_beside(whole, ".") : NULL;
    if (folder)
        folder[strlen(folder) - 2] = 0; /* the slash and the point */
    for (size_t i = 0; folder && i < sizeof trees / sizeof *trees; i++) {
        if (fnmatch(trees[i].folder, folder, 0) != 0)
            continue;
        char *up = wd_path_beside(whole, trees[i].up), *root = realpath(up, NULL);
        if (root)
            add(folders, wd_format("%s/%s", strcmp(root, "/") == 0 ? "" : root, trees[i].species));
        free(root);
        free(up);
        break;
    }
    free(folder);
    free(whole);
}

void wd_species_folders_init(struct wd_species_folders *folders, const char *scene_path)
{
    static const char here = 0; /* in the library, or in the program that holds it */
    Dl_info library;
    *folders = (struct wd_species_folders){0};
    add(folders, wd_path_beside(scene_path, "species"));
    add(folders, wd_path_beside(scene_path, "../species"));
    add_of_tree(folders, "/proc/self/exe");
    if (dladdr(&here, &library) && library.dli_fname)
        add_of_tree(folders, library.dli_fname);
    add(folders, wd_strdup(WD_DATA_DIR "/species"));
}

void wd_species_folders_finish(struct wd_species_folders *folders)
{
    for (size_t i = 0; i < folders->count; i++)
        free(folders->paths[i]);
    *folders = (struct wd_species_folders){0};
}

char *wd_species_folders_find(const struct wd_species_folders *folders, const char *name)
{
    for (size_t i = 0; i < folders->count && !strchr(name, '/') && name[0] != '.'; i++) {
        char *path = wd_format("%s/%s.json", folders->paths[i], name);
        if (wd_file_exists(path))
            return path;
        free(path);
    }
    return NULL;
}

char *wd_species_folders_text(const struct wd_species_folders *folders)
{
    return wd_join((const char *const *)folders->paths, folders->count, ", ");
}
