/* model_gltf.h: what a glTF file says that the importing library takes for something else. */
#ifndef WD_TREE_MODEL_GLTF_H
#define WD_TREE_MODEL_GLTF_H

#include <stdbool.h>
#include <stddef.h>

/* The attribute ("POSITION", "NORMAL", "TEXCOORD_0") of some mesh in the JSON that is stored as whole numbers, whose
 * bits assimp 5.2 takes for floats; NULL: none, or no JSON. */
const char *wd_gltf_whole_numbers(const char *json, size_t size);

/* What is wrong with the JSON that assimp fails in, takes endless time and memory for, or gives no reason for: nesting,
 * nodes that hold one another again and again, sparse values that are more than there are. A few words; NULL: nothing.
 * `*broken`: it is no JSON, which assimp may bear. free() it. */
char *wd_gltf_fault(const char *json, size_t size, bool *broken);

#endif
