/* species_folders.h: where species lie that are called by name alone. */
#ifndef WD_SCENE_SPECIES_FOLDERS_H
#define WD_SCENE_SPECIES_FOLDERS_H

#include <stddef.h>

enum { WD_SPECIES_FOLDERS_MOST = 5 };

/* In the order they are looked through. */
struct wd_species_folders {
    char *paths[WD_SPECIES_FOLDERS_MOST];
    size_t count;
};

/* species/ and ../species/ beside the scene (NULL: of the working directory), then those of the tree
 * that the program and the library were built or installed in, then those of the install prefix. */
void wd_species_folders_init(struct wd_species_folders *folders, const char *scene_path);
void wd_species_folders_finish(struct wd_species_folders *folders);

/* The first file of that name; NULL: none, or the name is a path. free() it. */
char *wd_species_folders_find(const struct wd_species_folders *folders, const char *name);

/* "A, B, C" for messages; free() it. */
char *wd_species_folders_text(const struct wd_species_folders *folders);

#endif
