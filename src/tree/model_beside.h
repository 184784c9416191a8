/* model_beside.h: files that a model names, found beside it. */
#ifndef WD_TREE_MODEL_BESIDE_H
#define WD_TREE_MODEL_BESIDE_H

/* The plain file of that name; where there is none, the one whose name differs in upper and lower case alone,
 * or is meant by the escapes (%20) of a URI. NULL: none. free() it. */
char *wd_model_find(const char *path);

/* The file that a model names, as wd_model_find has it: beside the model; else, for paths of the artist's
 * own machine, its last part. Where there is none, the name beside the model. free() it. */
char *wd_model_beside(const char *model_path, const char *name);

#endif
