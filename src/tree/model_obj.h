/* model_obj.h: what OBJ files leave out. */
#ifndef WD_TREE_MODEL_OBJ_H
#define WD_TREE_MODEL_OBJ_H

#include <stdbool.h>
#include <stddef.h>

bool wd_model_is_obj(const char *path);

/* Copies an OBJ file's text with a zero in each number that begins with its point, as .5 does, which
 * assimp 5.2 takes for words. Returns its length; `to` may be NULL. */
size_t wd_model_obj_add_zeroes(char *to, const char *from, size_t size);

/* The file of materials that an OBJ file names, beside it; NULL: none, or no OBJ. free() it. */
char *wd_model_obj_library(const char *path);
/* What materials an OBJ file names and lacks, in words that follow its name; NULL: none. free() it. */
char *wd_model_obj_lacks(const char *path);

#endif
