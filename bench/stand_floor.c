/* What stands let down to their floors: light of an even sky without a sun, looked down upon at places of
 * each stand, drawn over traced. */
#include "figures.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "weald/reference.h"

enum { WIDTH = 64, HEIGHT = 48, TRACED_SAMPLES = 64, DRAWN_SAMPLES = 4, PLACES = 12 };
static const double EYE_M = 1.7, DOWN_RAD = 1.309, FOV_RAD = 1.222;

static const struct stand {
    const char *scene;
    double from_m[2], size_m; /* square of the places */
} stands[] = {
    {"scenes/bench75k.json", {300, 300}, 400},
    {"bench/light.json", {460, 250}, 180},
    {"scenes/gallery/beech-hall.json", {250, 250}, 100},
};

static double luminance(const struct wd_picture *picture)
{
    double sum = 0;
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++)
        sum += 0.2126 * (double)picture->color[3 * i] + 0.7152 * (double)picture->color[3 * i + 1] +
               0.0722 * (double)picture->color[3 * i + 2];
    return sum;
}

/* Place `i` of a stand, spread evenly (Roberts 2018), looking down. */
static struct wd_camera camera_at(const struct wd_forest *forest, const struct stand *stand, int i)
{
    double x = stand->from_m[0] + stand->size_m * fmod(0.5 + 0.7548776662 * i, 1);
    double y = stand->from_m[1] + stand->size_m * fmod(0.5 + 0.5698402910 * i, 1);
    return (struct wd_camera){.position_m = {x, y, wd_forest_ground_m(forest, x, y) + EYE_M},
                              .pitch_rad = -DOWN_RAD,
                              .fov_rad = FOV_RAD};
}

struct painters {
    struct wd_forest *forest;
    struct wd_renderer *renderer;
    struct wd_reference *reference;
};

static bool add_place(const struct painters *painters, const struct stand *stand, int place,
                      double sums[2])
{
    const struct wd_render_params draw = {.camera = camera_at(painters->forest, stand, place),
                                          .width = WIDTH,
                                          .height = HEIGHT,
                                          .samples = DRAWN_SAMPLES,
                                          .method = "octree",
                                          .layers = WD_LAYER_COLOR};
    const struct wd_reference_picture_params trace = {.camera = draw.camera,
                                                      .width = WIDTH,
                                                      .height = HEIGHT,
                                                      .samples = TRACED_SAMPLES,
                                                      .layers = WD_LAYER_COLOR};
    struct wd_picture drawn = {0}, traced = {0};
    bool ok = wd_renderer_render(painters->renderer, &draw, &drawn) == WD_OK &&
              wd_reference_render(painters->reference, &trace, &traced) == WD_OK;
    if (ok) {
        sums[0] += luminance(&drawn);
        sums[1] += luminance(&traced);
    }
    wd_picture_finish(&drawn);
    wd_picture_finish(&traced);
    return ok;
}

static bool compare_stand(const struct stand *stand, const char *sky, const char *gpu, double *worst)
{
    char file[256];
    snprintf(file, sizeof file, "sky.file=%s", sky);
    const char *const settings[] = {file, "sky.sun=scene", "sun.strength=0", "sun.elevation_deg=35",
                                    "fog.visibility_m=1000000", NULL};
    const struct wd_forest_params forest_params = {.scene_path = stand->scene, .settings = settings};
    const struct wd_renderer_params renderer_params = {.gpu = gpu};
    const struct wd_reference_params reference_params = {0};
    struct painters painters = {0};
    double sums[2] = {0, 0};
    bool ok = wd_forest_create(&painters.forest, &forest_params) == WD_OK &&
              wd_renderer_create(&painters.renderer, &renderer_params) == WD_OK &&
              wd_renderer_set_forest(painters.renderer, painters.forest) == WD_OK &&
              wd_reference_create(&painters.reference, painters.forest, &reference_params) == WD_OK;
    for (int i = 0; ok && i < PLACES; i++)
        ok = add_place(&painters, stand, i, sums);
    wd_renderer_destroy(&painters.renderer);
    wd_reference_destroy(&painters.reference);
    wd_forest_destroy(&painters.forest);
    if (!ok)
        return false;
    double error = 100 * (sums[0] / sums[1] - 1);
    printf("%-32s %+6.1f %%\n", stand->scene, error);
    fflush(stdout);
    *worst = fmax(*worst, fabs(error));
    return true;
}

static bool write_even_sky(const char *path)
{
    enum { SKY_WIDTH = 16, SKY_HEIGHT = 8 };
    float color[3 * SKY_WIDTH * SKY_HEIGHT];
    for (size_t i = 0; i < sizeof color / sizeof *color; i++)
        color[i] = 1.0f;
    const struct wd_picture sky = {.width = SKY_WIDTH, .height = SKY_HEIGHT, .color = color};
    return wd_picture_write(&sky, path, NULL) == WD_OK;
}

bool bench_stand_floor(const char *gpu)
{
    char directory[] = "/tmp/weald-sky-XXXXXX", path[64];
    double worst = 0;
    if (!mkdtemp(directory)) {
        fprintf(stderr, "stand-floor: no directory for a sky in /tmp\n");
        return false;
    }
    snprintf(path, sizeof path, "%s/even.exr", directory);
    printf("%d places of %d x %d, drawn with %d samples over traced with %d, less 100\n", PLACES,
           WIDTH, HEIGHT, DRAWN_SAMPLES, TRACED_SAMPLES);
    bool ok = write_even_sky(path);
    for (size_t i = 0; ok && i < sizeof stands / sizeof *stands; i++)
        ok = compare_stand(&stands[i], path, gpu, &worst);
    bench_remove_directory(directory);
    if (ok)
        printf("stand-floor-error-pct %.1f %%\n", worst);
    return ok;
}
