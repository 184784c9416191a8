/* still.c: draws a picture of a scene and saves it as PNG; the library opens the Vulkan device.
 *     cc still.c $(pkg-config --cflags --libs weald) -o still && ./still SCENE OUT.png */
#include <stdio.h>

#include <weald/renderer.h>

/* What fails has said so on standard error: a log without a sink, or none (NULL), goes there. */
static enum wd_result draw(const char *scene, const char *path)
{
    struct wd_forest *forest = NULL;
    struct wd_renderer *renderer = NULL;
    struct wd_picture picture = {0};
    struct wd_render_params params = {.width = 640, .height = 360, .samples = 4};
    enum wd_result result =
        wd_forest_create(&forest, &(struct wd_forest_params){.scene_path = scene});
    if (result == WD_OK)
        result = wd_forest_get_camera(forest, NULL, &params.camera); /* the scene's first */
    if (result == WD_OK)
        result = wd_renderer_create(&renderer, &(struct wd_renderer_params){0});
    if (result == WD_OK)
        result = wd_renderer_set_forest(renderer, forest);
    if (result == WD_OK)
        result = wd_renderer_render(renderer, &params, &picture);
    if (result == WD_OK)
        result = wd_picture_write(&picture, path, NULL);
    wd_picture_finish(&picture);
    wd_renderer_destroy(&renderer);
    wd_forest_destroy(&forest);
    return result;
}

int main(int argc, char **argv)
{
    if (argc != 3) {
        fprintf(stderr, "usage: still SCENE OUT.png\n");
        return 2;
    }
    return draw(argv[1], argv[2]) == WD_OK ? 0 : 1;
}
