/* continuum against the path-traced truth: its error where trees are 1 to 1,024 pixels tall, beside
 * that of the truth's own noise, of as many paths as it has samples and of four times as many, and how
 * much more its pictures change from frame to frame than the truth's. */
#include "figures.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "weald/compare.h"
#include "painters.h"

static const char *const SCENE = "scenes/bench75k.json";
enum { SAMPLES = 16, MORE = 4 * SAMPLES };

/* Drawn and traced, of one forest. */
struct pair {
    struct painters by;
    struct wd_picture drawn, traced, half;
};

static bool pair_open(struct pair *pair, const char *gpu)
{
    *pair = (struct pair){0};
    return painters_init(&pair->by, SCENE, NULL, gpu);
}

static void pair_close(struct pair *pair)
{
    wd_picture_finish(&pair->drawn);
    wd_picture_finish(&pair->traced);
    wd_picture_finish(&pair->half);
    painters_finish(&pair->by);
}

struct shot {
    struct wd_camera camera;
    uint32_t width, height, paths;
};

static const uint32_t LAYERS = WD_LAYER_COLOR | WD_LAYER_TREE_ID;

/* Streams of random numbers. */
enum { FIRST_HALF, OTHER_HALF, FEW };

static bool trace(struct pair *pair, const struct shot *shot, uint32_t paths, uint32_t stream,
                  struct wd_picture *picture)
{
    const struct wd_reference_picture_params params = {.camera = shot->camera,
                                                       .width = shot->width,
                                                       .height = shot->height,
                                                       .samples = paths,
                                                       .stream = stream,
                                                       .layers = LAYERS};
    wd_picture_finish(picture);
    return wd_reference_render(pair->by.reference, &params, picture) == WD_OK;
}

static bool shoot(struct pair *pair, const struct shot *shot)
{
    const struct wd_render_params draw = {.camera = shot->camera,
                                          .width = shot->width,
                                          .height = shot->height,
                                          .samples = SAMPLES,
                                          .method = "continuum",
                                          .layers = LAYERS};
    wd_picture_finish(&pair->drawn);
    return wd_renderer_render(pair->by.renderer, &draw, &pair->drawn) == WD_OK &&
           trace(pair, shot, shot->paths / 2, FIRST_HALF, &pair->traced) &&
           trace(pair, shot, shot->paths / 2, OTHER_HALF, &pair->half);
}

/* Makes `traced` the mean of both halves. `noise`: FLIP between the halves. What is left in
 * their mean is about half of it. */
static bool join_halves(struct pair *pair, double *noise)
{
    struct wd_comparison halves;
    if (wd_picture_compare(&halves, &pair->traced, &pair->half, NULL, NULL) != WD_OK)
        return false;
    *noise = halves.flip;
    for (size_t i = 0; i < (size_t)3 * pair->traced.width * pair->traced.height; i++)
        pair->traced.color[i] = 0.5f * (pair->traced.color[i] + pair->half.color[i]);
    return true;
}

/* --- error by height in pixels -----------------------------------------------------------------
 */

/* Pictures of trees this tall and less show dozens of them; of larger ones, parts of a crown, and
 * one place tells little of others. */
enum { MANY_TREES_PX = 64, PLACES = 4 };
static const double places_m[PLACES][2] = {{500, 500}, {400, 400}, {600, 600}, {400, 600}};

/* Toward a place of the square kilometre, 30 degrees down, so far off that trees of the mean height
 * have so many pixels. */
static struct shot shot_of_height(const struct wd_forest *forest, int tall_px,
                                  const double place_m[2])
{
    static const double TREE_M = 15.0, PIXELS_PER_RADIAN = 624.0, DOWN_RAD = 0.523598775598;
    struct shot shot = {.width = 64, .height = 48, .paths = 512};
    if (tall_px <= 2)
        shot = (struct shot){.width = 48, .height = 24, .paths = 1024};
    double distance_m = TREE_M * PIXELS_PER_RADIAN / tall_px;
    double middle_m = wd_forest_ground_m(forest, place_m[0], place_m[1]) + 0.5 * TREE_M;
    shot.camera = (struct wd_camera){
        .position_m = {place_m[0], place_m[1] - distance_m * cos(DOWN_RAD),
                       middle_m + distance_m * sin(DOWN_RAD)},
        .pitch_rad = -DOWN_RAD,
        .fov_rad = 2.0 * atan(0.5 * shot.height / PIXELS_PER_RADIAN),
    };
    return shot;
}

struct height_error {
    double flip, noise, coverage_pct, tree_pct;
    double traced[2]; /* FLIP of SAMPLES and MORE paths */
};

/* FLIP of so many paths; `half` is left with their picture. */
static bool measure_paths(struct pair *pair, const struct shot *shot, uint32_t paths, double *flip)
{
    struct wd_comparison found;
    if (!trace(pair, shot, paths, FEW, &pair->half) ||
        wd_picture_compare(&found, &pair->traced, &pair->half, NULL, NULL) != WD_OK)
        return false;
    *flip = found.flip;
    return true;
}

/* Means over the places. */
static bool measure_height(struct pair *pair, int tall_px, struct height_error *mean)
{
    int places = tall_px > MANY_TREES_PX ? PLACES : 1;
    *mean = (struct height_error){0};
    for (int i = 0; i < places; i++) {
        const struct shot shot = shot_of_height(pair->by.forest, tall_px, places_m[i]);
        struct wd_comparison found;
        double noise, traced[2];
        if (!shoot(pair, &shot) || !join_halves(pair, &noise) ||
            !measure_paths(pair, &shot, SAMPLES, &traced[0]) ||
            !measure_paths(pair, &shot, MORE, &traced[1]) ||
            wd_picture_compare(&found, &pair->traced, &pair->drawn, NULL, NULL) != WD_OK)
            return false;
        mean->flip += found.flip / places;
        mean->noise += noise / places;
        mean->traced[0] += traced[0] / places;
        mean->traced[1] += traced[1] / places;
        mean->coverage_pct += found.coverage_bias_pct / places;
        mean->tree_pct += found.tree_bias_pct / places;
    }
    return true;
}

bool bench_continuum_flip(const char *gpu)
{
    struct pair pair;
    double sum = 0.0, noises = 0.0, traced[2] = {0.0, 0.0};
    int count = 0;
    bool ok = pair_open(&pair, gpu);
    for (int tall_px = 1; ok && tall_px <= 1024; tall_px *= 2, count++) {
        struct height_error found;
        ok = measure_height(&pair, tall_px, &found);
        if (!ok)
            break;
        printf("trees of %4d px: FLIP %.3f (%d paths %.3f, %d paths %.3f, halves of the truth %.3f), "
               "coverage %+5.1f %%, radiance of trees %+5.1f %%\n",
               tall_px, found.flip, SAMPLES, found.traced[0], MORE, found.traced[1], found.noise,
               found.coverage_pct, found.tree_pct);
        fflush(stdout);
        sum += found.flip;
        noises += found.noise;
        traced[0] += found.traced[0];
        traced[1] += found.traced[1];
    }
    pair_close(&pair);
    if (ok)
        printf("mean FLIP between two halves of the truth %.3f, of %d paths %.3f, of %d %.3f\n"
               "continuum-flip %.3f FLIP\n",
               noises / count, SAMPLES, traced[0] / count, MORE, traced[1] / count, sum / count);
    return ok;
}

/* --- change from frame to frame ----------------------------------------------------------------
 */

enum { WIDTH = 96, HEIGHT = 56, BLOCK = 4, BLOCKS = WIDTH / BLOCK * (HEIGHT / BLOCK), STEPS = 5 };
static const double STEP_M = 0.25;

struct blocks {
    double luma[BLOCKS]; /* as shown, 0..1 */
};

static void fill_blocks(struct blocks *blocks, const struct wd_picture *picture)
{
    *blocks = (struct blocks){0};
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        const uint8_t *p = picture->display + 4 * i;
        uint32_t block = i / WIDTH / BLOCK * (WIDTH / BLOCK) + i % WIDTH / BLOCK;
        blocks->luma[block] +=
            (0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2]) / (255.0 * BLOCK * BLOCK);
    }
}

static double change_of(const struct blocks *before, const struct blocks *now)
{
    double sum = 0.0;
    for (int i = 0; i < BLOCKS; i++)
        sum += fabs(now->luma[i] - before->luma[i]);
    return sum / BLOCKS;
}

static bool add_view(struct pair *pair, const char *view, double changes[2])
{
    struct shot shot = {.width = WIDTH, .height = HEIGHT, .paths = 256};
    struct blocks drawn[2], traced[2];
    double own[2] = {0.0, 0.0};
    if (wd_forest_get_camera(pair->by.forest, view, &shot.camera) != WD_OK)
        return false;
    for (int step = 0; step < STEPS; step++) {
        int now = step % 2;
        double noise;
        if (!shoot(pair, &shot) || !join_halves(pair, &noise) ||
            wd_picture_expose_alike(&pair->traced, &pair->drawn, NULL) != WD_OK)
            return false;
        fill_blocks(&drawn[now], &pair->drawn);
        fill_blocks(&traced[now], &pair->traced);
        if (step > 0) {
            own[0] += change_of(&drawn[1 - now], &drawn[now]) / (STEPS - 1);
            own[1] += change_of(&traced[1 - now], &traced[now]) / (STEPS - 1);
        }
        shot.camera.position_m[0] += STEP_M * sin(shot.camera.yaw_rad);
        shot.camera.position_m[1] += STEP_M * cos(shot.camera.yaw_rad);
    }
    printf("%-9s change of blocks a frame: drawn %.5f, traced %.5f, ratio %.2f\n", view, own[0],
           own[1], own[0] / own[1]);
    fflush(stdout);
    for (int i = 0; i < 2; i++)
        changes[i] += own[i];
    return true;
}

/* A slow walk ahead, both exposed alike. Of both views together. */
bool bench_continuum_popping(const char *gpu)
{
    struct pair pair;
    double changes[2] = {0.0, 0.0};
    bool ok = pair_open(&pair, gpu) && add_view(&pair, "overview", changes) &&
              add_view(&pair, "walk", changes);
    pair_close(&pair);
    if (ok)
        printf("continuum-popping %.2f x\n", changes[0] / changes[1]);
    return ok;
}
