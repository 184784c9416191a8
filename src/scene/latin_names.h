/* latin_names.h: species by the names that botanists give them, as people write these. */
#ifndef WD_SCENE_LATIN_NAMES_H
#define WD_SCENE_LATIN_NAMES_H

#include <stdbool.h>
#include <stddef.h>

#include "base/memory.h"
#include "scene/species_folders.h"

/* Whether two names are one but for capitals, accents, underscores for blanks, and how many of these. */
bool wd_names_alike(const char *a, const char *b);
/* Whether `name` is alike to `latin`, or has but its authors behind it: "Picea abies (L.) H.Karst." is Picea abies.
 * Authors follow names of two words or more, and begin with a capital or a bracket. */
bool wd_name_is_latin(const char *name, const char *latin);

/* Whether it has two words or more, as such names have. */
bool wd_name_has_words(const char *name);

/* Species that lie in the folders. */
struct wd_latin_names {
    struct wd_latin_name {
        const char *name, *latin, *file;
    } *names;
    size_t count, capacity;
    struct wd_arena arena; /* owns the texts */
};
/* Reads every species file there; those that cannot be read are passed over. Of several with the same name the first
 * folder's counts, as ever; of several with the same Latin name the first by name. */
void wd_latin_names_init(struct wd_latin_names *latin, const struct wd_species_folders *folders);
void wd_latin_names_finish(struct wd_latin_names *latin);
/* NULL: none is called so. */
const struct wd_latin_name *wd_latin_names_find(const struct wd_latin_names *latin, const char *name);

#endif
