#include "planted.h"


void planted_init(struct planted *planted, struct gpu_test *test, const char *scene_path,
                  const char *cache_dir)
{
    *planted = (struct planted){.test = test};
    const struct wd_scene_params scene = {0};
    const struct wd_world_params world = {.log = &test->log};
    assert_true(wd_scene_load_with(&planted->scene, scene_path, &scene, &test->log));
    assert_true(wd_world_init(&planted->world, &planted->scene, &world));
    clear_log(test); /* what is planted is told as a warning or not: here it does not matter */
    const struct wd_forest_device_params forest = {
        .scene = &planted->scene,
        .world = &planted->world,
        .cache_dir = cache_dir,
        .log = &test->log,
    };
    assert_true(wd_forest_device_init(&planted->forest, &test->gpu, &forest));
}

void planted_finish(struct planted *planted)
{
    wd_forest_device_finish(&planted->forest, &planted->test->gpu);
    wd_world_finish(&planted->world);
    wd_scene_finish(&planted->scene);
}
