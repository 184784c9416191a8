/* model_obj.h: OBJ files whose numbers leave out the zero before the point. */
#ifndef WD_TREE_MODEL_OBJ_H
#define WD_TREE_MODEL_OBJ_H

#include <stdbool.h>

struct aiFileIO;

/* Whether the file at `path` is an OBJ with numbers such as .5, which assimp 5.2 takes for words. */
bool wd_model_obj_is_short(const char *path);

/* Reads files as they are, but OBJ files with those zeroes. */
struct aiFileIO *wd_model_obj_io(void);

/* The file of materials that an OBJ file names, beside it; NULL: none, or no OBJ. free() it. */
char *wd_model_obj_library(const char *path);

#endif
