/* planted.h: a scene's forest on a software device with validation. */
#ifndef WD_TESTS_PLANTED_H
#define WD_TESTS_PLANTED_H

#include "forest/forest.h"
#include "gpu_test.h"

struct planted {
    struct gpu_test *test;
    struct wd_scene scene;
    struct wd_world world;
    struct wd_forest_device forest;
};

/* `cache_dir` may be NULL. Fails the test that calls it where something is wrong. */
void planted_init(struct planted *planted, struct gpu_test *test, const char *scene_path,
                  const char *cache_dir);
void planted_finish(struct planted *planted);

#endif
