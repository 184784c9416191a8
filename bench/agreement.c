#include "agreement.h"

#include <math.h>
#include <stdlib.h>

enum { WIDTH = 480, HEIGHT = 360 };

static const uint32_t LAYERS = WD_LAYER_DEPTH | WD_LAYER_NORMAL | WD_LAYER_ALBEDO | WD_LAYER_TREE_ID;

/* --- both pictures --------------------------------------------------------------------------- */

static bool draw_both(const struct wd_forest *forest, const struct wd_camera *camera,
                      const char *gpu, struct wd_picture *drawn, struct wd_picture *traced)
{
    const struct wd_renderer_params renderer_params = {.gpu = gpu};
    const struct wd_reference_params reference_params = {0};
    struct wd_renderer *renderer = NULL;
    struct wd_reference *reference = NULL;
    const struct wd_render_params draw = {.camera = *camera,
                                          .width = WIDTH,
                                          .height = HEIGHT,
                                          .method = "separate",
                                          .layers = LAYERS};
    const struct wd_reference_picture_params trace = {
        .camera = *camera, .width = WIDTH, .height = HEIGHT, .samples = 1, .layers = LAYERS};
    bool ok = wd_renderer_create(&renderer, &renderer_params) == WD_OK &&
              wd_renderer_set_forest(renderer, forest) == WD_OK &&
              wd_renderer_render(renderer, &draw, drawn) == WD_OK &&
              wd_reference_create(&reference, forest, &reference_params) == WD_OK &&
              wd_reference_render(reference, &trace, traced) == WD_OK;
    wd_renderer_destroy(&renderer);
    wd_reference_destroy(&reference);
    return ok;
}

/* --- comparing ------------------------------------------------------------------------------- */

/* Same tree all around, or no tree, and then the same of ground and sky. */
static bool is_inner(const struct wd_picture *picture, uint32_t x, uint32_t y)
{
    size_t middle = (size_t)y * picture->width + x;
    for (uint32_t j = y - 1; j <= y + 1; j++)
        for (uint32_t i = x - 1; i <= x + 1; i++) {
            size_t at = (size_t)j * picture->width + i;
            if (picture->tree_id[at] != picture->tree_id[middle] ||
                isinf(picture->depth_m[at]) != isinf(picture->depth_m[middle]))
                return false;
        }
    return true;
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

static double median(double *values, size_t count)
{
    qsort(values, count, sizeof *values, compare);
    return count ? values[count / 2] : 0.0;
}

static double normal_angle_deg(const float a[3], const float b[3])
{
    double dot = 0;
    for (int k = 0; k < 3; k++)
        dot += (double)a[k] * (double)b[k];
    return acos(fmin(fabs(dot), 1.0)) * (180 / 3.14159265358979323846); /* sheets have no outside */
}

/* What inner pixels add up to. */
struct sums {
    double *angles, *depths;
    size_t same, inner, equal;
    double albedo[2][2]; /* [ground, trees][drawn, traced] */
};

static void add_pixel(struct sums *sums, const struct wd_picture *drawn,
                      const struct wd_picture *traced, size_t at)
{
    bool sky = isinf(traced->depth_m[at]), same = drawn->tree_id[at] == traced->tree_id[at];
    sums->inner++;
    sums->equal += same;
    if (!same || sky || isinf(drawn->depth_m[at]))
        return;
    bool tree = traced->tree_id[at] != 0;
    for (int k = 0; k < 3; k++) {
        sums->albedo[tree][0] += (double)drawn->albedo[3 * at + (size_t)k];
        sums->albedo[tree][1] += (double)traced->albedo[3 * at + (size_t)k];
    }
    sums->angles[sums->same] = normal_angle_deg(drawn->normal + 3 * at, traced->normal + 3 * at);
    sums->depths[sums->same++] =
        1e3 * fabs((double)drawn->depth_m[at] - (double)traced->depth_m[at]);
}

static double excess_pct(const double albedo[2])
{
    return albedo[1] > 0 ? 100 * (albedo[0] / albedo[1] - 1) : 0.0;
}

static void compare_layers(struct bench_agreement *agreement, const struct wd_picture *drawn,
                           const struct wd_picture *traced)
{
    size_t pixels = (size_t)WIDTH * HEIGHT;
    struct sums sums = {.angles = calloc(pixels, sizeof(double)),
                        .depths = calloc(pixels, sizeof(double))};
    for (uint32_t y = 1; y + 1 < HEIGHT && sums.angles && sums.depths; y++)
        for (uint32_t x = 1; x + 1 < WIDTH; x++)
            if (is_inner(traced, x, y))
                add_pixel(&sums, drawn, traced, (size_t)y * WIDTH + x);
    *agreement = (struct bench_agreement){
        .width = WIDTH,
        .height = HEIGHT,
        .inner_pixels = sums.inner,
        .id_pct = sums.inner ? 100.0 * (double)sums.equal / (double)sums.inner : 0.0,
        .normal_deg = median(sums.angles, sums.same),
        .depth_mm = median(sums.depths, sums.same),
        .albedo_pct = excess_pct(sums.albedo[1]),
        .ground_albedo_pct = excess_pct(sums.albedo[0]),
    };
    free(sums.angles);
    free(sums.depths);
}

bool bench_agreement_measure(struct bench_agreement *agreement, const char *scene_path,
                             const char *camera_name, const char *gpu)
{
    /* A ninth of the trees: software devices shade the vertices of all their leaves on one thread. */
    static const char *const settings[] = {"wind.speed_mps=0", "quality.mesh_distance_m=100000",
                                           "quality.reduced_distance_m=200000", "quality.leaf_px=0",
                                           "layers.0.spacing_m=30", "layers.1.spacing_m=33",
                                           NULL};
    const struct wd_forest_params params = {.scene_path = scene_path, .settings = settings};
    struct wd_forest *forest = NULL;
    struct wd_camera camera;
    struct wd_picture drawn = {0}, traced = {0};
    bool ok = wd_forest_create(&forest, &params) == WD_OK &&
              wd_forest_get_camera(forest, camera_name, &camera) == WD_OK &&
              draw_both(forest, &camera, gpu, &drawn, &traced);
    if (ok)
        compare_layers(agreement, &drawn, &traced);
    wd_picture_finish(&drawn);
    wd_picture_finish(&traced);
    wd_forest_destroy(&forest);
    return ok;
}
