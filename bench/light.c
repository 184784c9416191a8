/* Light: mean colours against the path tracer's, and what shadows and wind cost. */
#include "figures.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "painters.h"

static const char scene[] = "bench/light.json";

/* --- mean colours ---------------------------------------------------------------------------- */

enum { WIDTH = 128, HEIGHT = 96, TRACED_SAMPLES = 16, DRAWN_SAMPLES = 4 };
enum { SKY, GROUND, TREES, ALL, PARTS };

static const char *const part_names[PARTS] = {"sky", "ground", "trees", "frame"};

/* Leaves keep their size and number: what fewer and larger ones hide is measured elsewhere
 * (lod-coverage-bias-pct), and pictures as small as these would show little else. */
#define WHOLE_LEAVES "quality.leaf_px=0.3"
struct light {
    const char *name;
    const char *settings[4];
};
static const struct light lights[] = {
    {"noon", {"sun.elevation_deg=60", "sun.azimuth_deg=180", WHOLE_LEAVES}},
    {"low sun", {"sun.elevation_deg=12", "sun.azimuth_deg=250", WHOLE_LEAVES}},
    {"overcast", {"sky.cover=1", "sun.elevation_deg=40", WHOLE_LEAVES}},
};
static const char *const views[] = {"overview", "walk", "edge"};

struct sums {
    double rgb[PARTS][3], pixels[PARTS];
};

/* Parts by what the path tracer sees through each pixel's middle, in both pictures. */
static void add_picture(struct sums *sums, const struct wd_picture *picture,
                        const struct wd_picture *traced)
{
    for (size_t at = 0; at < (size_t)WIDTH * HEIGHT; at++) {
        int part = traced->tree_id[at] ? TREES : isinf(traced->depth_m[at]) ? SKY : GROUND;
        for (int k = 0; k < 3; k++) {
            sums->rgb[part][k] += (double)picture->color[3 * at + (size_t)k];
            sums->rgb[ALL][k] += (double)picture->color[3 * at + (size_t)k];
        }
        sums->pixels[part]++;
        sums->pixels[ALL]++;
    }
}

/* Largest error of a channel of the whole frame. */
static double print_view(const char *light, const char *view, const struct sums *drawn,
                         const struct sums *traced)
{
    double worst = 0;
    printf("%-9s %-9s", light, view);
    for (int part = 0; part < PARTS; part++) {
        double error[3];
        for (int k = 0; k < 3; k++) {
            error[k] = traced->rgb[part][k] > 0
                           ? 100 * (drawn->rgb[part][k] / traced->rgb[part][k] - 1)
                           : 0;
            worst = part == ALL ? fmax(worst, fabs(error[k])) : worst;
        }
        printf(" | %s %2.0f%%: %+6.1f %+6.1f %+6.1f", part_names[part],
               100 * traced->pixels[part] / traced->pixels[ALL], error[0], error[1], error[2]);
    }
    printf("\n");
    return worst;
}

static bool compare_view(const struct painters *painters, const char *light, const char *view,
                         double *worst)
{
    struct wd_reference_picture_params trace = {.width = WIDTH,
                                                .height = HEIGHT,
                                                .samples = TRACED_SAMPLES,
                                                .layers = WD_LAYER_COLOR | WD_LAYER_DEPTH |
                                                          WD_LAYER_TREE_ID};
    struct wd_render_params draw = {.width = WIDTH,
                                    .height = HEIGHT,
                                    .samples = DRAWN_SAMPLES,
                                    .method = "octree",
                                    .layers = WD_LAYER_COLOR};
    struct wd_picture drawn = {0}, traced = {0};
    struct sums drawn_sums = {0}, traced_sums = {0};
    bool ok = wd_forest_get_camera(painters->forest, view, &trace.camera) == WD_OK;
    draw.camera = trace.camera;
    ok = ok && painters_paint(painters, &draw, &trace, &drawn, &traced);
    if (ok) {
        add_picture(&drawn_sums, &drawn, &traced);
        add_picture(&traced_sums, &traced, &traced);
        *worst = fmax(*worst, print_view(light, view, &drawn_sums, &traced_sums));
    }
    wd_picture_finish(&drawn);
    wd_picture_finish(&traced);
    return ok;
}

static bool compare_light(const struct light *light, const char *gpu, double *worst)
{
    struct painters painters;
    bool ok = painters_init(&painters, scene, light->settings, gpu);
    for (size_t i = 0; ok && i < sizeof views / sizeof *views; i++)
        ok = compare_view(&painters, light->name, views[i], worst);
    painters_finish(&painters);
    return ok;
}

bool bench_mean_colour(const char *gpu)
{
    double worst = 0;
    printf("%d x %d, drawn with %d samples over traced with %d, less 100: red, green, blue, %%\n",
           WIDTH, HEIGHT, DRAWN_SAMPLES, TRACED_SAMPLES);
    for (size_t i = 0; i < sizeof lights / sizeof *lights; i++)
        if (!compare_light(&lights[i], gpu, &worst))
            return false;
    printf("mean-colour-error-pct %.2f %%\n", worst);
    return true;
}

/* --- costs ----------------------------------------------------------------------------------- */

enum { FRAMES = 7, CASES = 6, MAX_PASSES = 24 };

struct cost {
    const char *name, *shadow_taps, *wind;
    enum wd_view_mode view; /* WD_VIEW_ALBEDO: without light */
    struct wd_forest *forest;
    struct wd_renderer *renderer;
    double frame_ms[FRAMES];
    double pass_ms[MAX_PASSES][FRAMES];
    char names[MAX_PASSES][32];
    uint32_t pass_count;
};

static bool open_case(struct cost *cost, const char *gpu)
{
    const char *const settings[] = {cost->shadow_taps, cost->wind, NULL};
    const struct wd_forest_params forest = {.scene_path = scene, .settings = settings};
    const struct wd_renderer_params renderer = {.gpu = gpu};
    return wd_forest_create(&cost->forest, &forest) == WD_OK &&
           wd_renderer_create(&cost->renderer, &renderer) == WD_OK &&
           wd_renderer_set_forest(cost->renderer, cost->forest) == WD_OK;
}

static bool draw_case(struct cost *cost, enum wd_time_mode timing, struct wd_frame_stats *stats)
{
    struct wd_render_params params = {.time_s = 3,
                                      .width = 800,
                                      .height = 600,
                                      .samples = 1,
                                      .method = "octree",
                                      .view = cost->view,
                                      .timing = timing};
    struct wd_picture picture = {0};
    bool ok = wd_forest_get_camera(cost->forest, "overview", &params.camera) == WD_OK &&
              wd_renderer_render(cost->renderer, &params, &picture) == WD_OK;
    wd_picture_finish(&picture);
    wd_renderer_get_stats(cost->renderer, stats);
    return ok;
}

static bool time_case(struct cost *cost, int round)
{
    struct wd_frame_stats stats;
    if (!draw_case(cost, WD_TIME_OFF, &stats))
        return false;
    double frame_ms = stats.frame_ms;
    if (!draw_case(cost, WD_TIME_PASSES, &stats))
        return false;
    if (round < 0)
        return true;
    cost->frame_ms[round] = frame_ms;
    cost->pass_count = stats.pass_count < MAX_PASSES ? stats.pass_count : MAX_PASSES;
    for (uint32_t k = 0; k < cost->pass_count; k++) {
        cost->pass_ms[k][round] = stats.passes[k].gpu_ms + stats.passes[k].cpu_ms;
        snprintf(cost->names[k], sizeof cost->names[k], "%s", stats.passes[k].name);
    }
    return true;
}

static void print_case(struct cost *cost)
{
    printf("%-20s frame %7.1f ms:", cost->name, bench_median(cost->frame_ms, FRAMES));
    for (uint32_t k = 0; k < cost->pass_count; k++)
        printf(" %s %.1f", cost->names[k], bench_median(cost->pass_ms[k], FRAMES));
    printf("\n");
}

/* The cases take turns, so that other work on the machine falls on all alike. */
static bool time_cases(struct cost cases[CASES], const char *gpu)
{
    bool ok = true;
    for (int i = 0; ok && i < CASES; i++)
        ok = open_case(&cases[i], gpu);
    for (int round = -1; ok && round < FRAMES; round++)
        for (int i = 0; ok && i < CASES; i++)
            ok = time_case(&cases[i], round);
    for (int i = 0; ok && i < CASES; i++)
        print_case(&cases[i]);
    for (int i = 0; i < CASES; i++) {
        wd_renderer_destroy(&cases[i].renderer);
        wd_forest_destroy(&cases[i].forest);
    }
    return ok;
}

static bool measure_cost(const char *gpu, const char *figure, int with, int without)
{
    static const char off[] = "quality.shadow_taps=0", still[] = "wind.speed_mps=0";
    static const char on[] = "quality.shadow_taps=4", windy[] = "wind.speed_mps=6";
    struct cost cases[CASES] = {
        {"light", off, still, WD_VIEW_LIT},       {"light, shadow", on, still, WD_VIEW_LIT},
        {"light, sway", off, windy, WD_VIEW_LIT}, {"light, shadow, sway", on, windy, WD_VIEW_LIT},
        {"none", off, still, WD_VIEW_ALBEDO},     {"sway", off, windy, WD_VIEW_ALBEDO},
    };
    if (!time_cases(cases, gpu))
        return false;
    double added[FRAMES];
    for (int i = 0; i < FRAMES; i++)
        added[i] = 100 * (cases[with].frame_ms[i] / cases[without].frame_ms[i] - 1);
    printf("%s %.1f %%\n", figure, bench_median(added, FRAMES));
    return true;
}

bool bench_shadow_cost(const char *gpu)
{
    return measure_cost(gpu, "shadow-cost-pct", 1, 0);
}

bool bench_wind_cost(const char *gpu)
{
    return measure_cost(gpu, "wind-cost-pct", 3, 1);
}
