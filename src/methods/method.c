#include "methods/method.h"

#include <string.h>

#include "weald/renderer.h"

static const struct wd_method *const methods[] = {&wd_method_octree, &wd_method_separate};
static const char *const names[] = {"octree", "separate", NULL};

const char *const *wd_method_names(void)
{
    return names;
}

const struct wd_method *wd_method_find(const char *name)
{
    for (size_t i = 0; names[i]; i++) {
        if (strcmp(names[i], name) == 0)
            return methods[i];
    }
    return NULL;
}
