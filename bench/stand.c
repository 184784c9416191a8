/* Light within stands, at places of each, drawn over traced: of an even sky without a sun on their
 * floors, and of their own sun and sky on floors, stems and crowns. */
#include "figures.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "painters.h"

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

/* --- floors under an even sky --------------------------------------------------------------- */

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
    bool ok = painters_paint(painters, &draw, &trace, &drawn, &traced);
    if (ok) {
        sums[0] += luminance(&drawn);
        sums[1] += luminance(&traced);
    }
    wd_picture_finish(&drawn);
    wd_picture_finish(&traced);
    return ok;
}

static bool compare_stand(const struct stand *stand, const char *sky, const char *gpu,
                          double *worst)
{
    char file[256];
    snprintf(file, sizeof file, "sky.file=%s", sky);
    const char *const settings[] = {
        file, "sky.sun=scene", "sun.strength=0", "sun.elevation_deg=35", "fog.visibility_m=1000000",
        NULL};
    struct painters painters;
    double sums[2] = {0, 0};
    bool ok = painters_init(&painters, stand->scene, settings, gpu);
    for (int i = 0; ok && i < PLACES; i++)
        ok = add_place(&painters, stand, i, sums);
    painters_finish(&painters);
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

/* --- floors, stems and crowns under the stand's own sun ------------------------------------- */

enum { FLOOR, STEMS, CROWNS, PARTS };
static const char *const part_names[PARTS] = {"floor", "stems", "crowns"};
static const double UP_RAD = 0.15, STEMS_M = 3.5, FAR_M = 25;
enum { WIDE = 4 * WIDTH, HIGH = 4 * HEIGHT, PATHS = 3 }; /* many places tell more than many paths */

/* Sums of a part's light and its pixels. */
struct part {
    double light[3], pixels;
};

/* What a pixel of a tree or of the ground is a part of; PARTS: of none. Trees count where they are
 * looked at level. */
static int part_of(const struct wd_picture *picture, size_t pixel, bool down)
{
    double depth_m = (double)picture->depth_m[pixel];
    double y = 1 - 2 * ((double)(pixel / picture->width) + 0.5) / picture->height;
    double height_m = EYE_M + depth_m * (sin(UP_RAD) + y * tan(0.5 * FOV_RAD) * cos(UP_RAD));
    if (down)
        return picture->tree_id[pixel] == 0 ? FLOOR : PARTS;
    if (picture->tree_id[pixel] == 0 || depth_m > FAR_M)
        return PARTS;
    return height_m < STEMS_M ? STEMS : CROWNS;
}

static void add_parts(struct part parts[PARTS], const struct wd_picture *picture, bool down)
{
    for (size_t i = 0; i < (size_t)picture->width * picture->height; i++) {
        int part = part_of(picture, i, down);
        if (part == PARTS)
            continue;
        for (int k = 0; k < 3; k++)
            parts[part].light[k] += (double)picture->color[3 * i + k];
        parts[part].pixels++;
    }
}

/* Both by rays through the middles of pixels, so that what a pixel is called is what it shows. */
static bool add_view(const struct painters *painters, const struct stand *stand, int view,
                     struct part drawn[PARTS], struct part traced[PARTS])
{
    bool down = view < PLACES;
    struct wd_camera camera = camera_at(painters->forest, stand, view % PLACES);
    if (!down) {
        camera.pitch_rad = UP_RAD;
        camera.yaw_rad = 6.283185307179586 * fmod(0.6180339887 * view, 1);
    }
    const uint32_t layers = WD_LAYER_COLOR | WD_LAYER_DEPTH | WD_LAYER_TREE_ID;
    const struct wd_render_params draw = {.camera = camera,
                                          .width = WIDE,
                                          .height = HIGH,
                                          .samples = 1,
                                          .method = "continuum",
                                          .layers = layers};
    const struct wd_reference_picture_params trace = {.camera = camera,
                                                      .width = WIDE,
                                                      .height = HIGH,
                                                      .samples = PATHS,
                                                      .places = WD_REFERENCE_MIDDLES,
                                                      .layers = layers};
    struct wd_picture picture = {0}, truth = {0};
    bool ok = painters_paint(painters, &draw, &trace, &picture, &truth);
    if (ok) {
        add_parts(drawn, &picture, down);
        add_parts(traced, &truth, down);
    }
    wd_picture_finish(&picture);
    wd_picture_finish(&truth);
    return ok;
}

static bool compare_light(const struct stand *stand, const char *gpu, double *worst)
{
    const char *const settings[] = {"fog.visibility_m=1000000", "wind.speed_mps=0", NULL};
    struct painters painters;
    struct part drawn[PARTS] = {0}, traced[PARTS] = {0};
    bool ok = painters_init(&painters, stand->scene, settings, gpu);
    for (int view = 0; ok && view < 2 * PLACES; view++)
        ok = add_view(&painters, stand, view, drawn, traced);
    painters_finish(&painters);
    for (int i = 0; ok && i < PARTS; i++) {
        printf("%-32s %-7s", stand->scene, part_names[i]);
        for (int k = 0; k < 3; k++) {
            double ratio =
                drawn[i].light[k] / drawn[i].pixels * traced[i].pixels / traced[i].light[k];
            printf(" %.2f", ratio);
            *worst = fmax(*worst, 100 * fabs(ratio - 1));
        }
        printf("  pixels %.3f\n", drawn[i].pixels / traced[i].pixels);
    }
    fflush(stdout);
    return ok;
}

bool bench_stand_light(const char *gpu)
{
    double worst = 0;
    bool ok = true;
    printf("%d places, looked at from above and level: red, green, blue and pixels, drawn by "
           "continuum over traced\n"
           "with %d paths a pixel\n",
           PLACES, PATHS);
    for (size_t i = 0; ok && i < sizeof stands / sizeof *stands; i++)
        ok = compare_light(&stands[i], gpu, &worst);
    if (ok)
        printf("stand-light-error-pct %.1f %%\n", worst);
    return ok;
}
