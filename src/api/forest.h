/* forest.h: what stands behind the public struct wd_forest. */
#ifndef WD_API_FOREST_H
#define WD_API_FOREST_H

#include "weald/forest.h"
#include "world/world.h"

struct wd_forest {
    struct wd_scene scene;
    struct wd_world world;
    struct wd_log log;
};

#endif
