/* nearest.h: the name that was probably meant. */
#ifndef WD_SCENE_NEAREST_H
#define WD_SCENE_NEAREST_H

#include <stddef.h>

/* The name among `names` nearest to `wanted` by edit distance, or NULL when none is near. */
const char *wd_nearest_name(const char *wanted, const char *const *names, size_t count);

#endif
