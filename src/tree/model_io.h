/* model_io.h: files as the importing library is to see them. */
#ifndef WD_TREE_MODEL_IO_H
#define WD_TREE_MODEL_IO_H

#include <stdbool.h>

struct aiFileIO;

struct wd_model_traits {
    bool skins;
    const char *whole_numbers; /* attribute of glTF that is stored as such; NULL: none */
    char *fault;               /* of glTF's JSON, as wd_gltf_fault has it; free() it */
    bool broken;               /* that is told only where assimp fails */
};

/* Reads files as they are, but OBJ files with the zeroes that they leave out before points, OBJ and MTL
 * files without a byte order mark, and glTF files without skins, in some of which assimp 5.2 fails; files that
 * they name as wd_model_find has them. NULL where nothing of the kind can be in the model at `path`. */
struct aiFileIO *wd_model_io(const char *path, struct wd_model_traits *traits);

/* Whether the file has the word in its first MiB, as extensions that a glTF file uses. */
bool wd_model_has_word(const char *path, const char *word);

#endif
