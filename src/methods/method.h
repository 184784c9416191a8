/* method.h: a method is only how trees get into the buffers; all else is shared. */
#ifndef WD_METHODS_METHOD_H
#define WD_METHODS_METHOD_H

#include "methods/tree_draw.h"

struct wd_method {
    const char *name;
    /* Chooses what `draw->view` shows of the forest and records it, for the camera or a cascade. */
    void (*record)(const struct wd_tree_draw *draw, struct wd_selection *scratch);
};

extern const struct wd_method wd_method_separate; /* every tree by itself (row G9) */
extern const struct wd_method wd_method_octree;   /* static geometry in octree order (row G5) */

/* The method of that name, or NULL. Names are in wd_method_names(), weald/renderer.h. */
const struct wd_method *wd_method_find(const char *name);

#endif
