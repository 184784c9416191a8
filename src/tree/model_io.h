/* model_io.h: files as the importing library is to see them. */
#ifndef WD_TREE_MODEL_IO_H
#define WD_TREE_MODEL_IO_H

#include <stdbool.h>

struct aiFileIO;

/* Reads files as they are, but OBJ files with the zeroes that they leave out before points, OBJ and MTL
 * files without a byte order mark, and glTF files without skins, in some of which assimp 5.2 fails. NULL where
 * nothing of the kind can be in the model at `path`. `*skins`: whether it has any. */
struct aiFileIO *wd_model_io(const char *path, bool *skins);

#endif
