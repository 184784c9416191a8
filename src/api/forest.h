/* forest.h: what stands behind the public struct wd_forest. */
#ifndef WD_API_FOREST_H
#define WD_API_FOREST_H

#include "weald/forest.h"
#include "world/world.h"

struct wd_forest {
    struct wd_scene scene;
    struct wd_world world;
    struct wd_log log;
    uint64_t key; /* of scene and species files and settings, as they were when they were read */
    uint64_t methods_key; /* of settings of methods, which are not in `key` */
};

/* A number for weald's own sources. */
uint64_t wd_code_key(void);
/* Sets the forest's keys from the files that its scene was just loaded from. */
bool wd_forest_key_files(struct wd_forest *forest, const struct wd_forest_params *params);

/* False, logged, where cameras or keys of paths are too far from the ground that was made for the scene. Warns of those
 * below it, and of those farther outside than it is large and than a kilometre. */
bool wd_scene_check_places(const struct wd_scene *scene, const struct wd_terrain *terrain,
                           const struct wd_log *log);

#endif
