/* Reflectance of a closed canopy over view angle in the sun's plane: rasterised and path-traced. */
#include "figures.h"

#include <math.h>
#include <stdio.h>

#include "painters.h"

enum { SIDE = 64, TRACED_SAMPLES = 24, DRAWN_SAMPLES = 8, ANGLES = 11 };

static const double PI = 3.14159265358979323846;

/* From the zenith, degrees; positive toward the sun, which stands at 40: the hotspot. */
static const double angles_deg[ANGLES] = {-65, -50, -35, -20, -5, 10, 25, 35, 40, 50, 65};
static const double DISTANCE_M = 250;

/* Looks at the canopy's middle from that angle; the sun stands in the south. */
static struct wd_camera camera_at(const struct wd_forest *forest, double angle_deg)
{
    struct wd_camera camera = {0};
    double angle = angle_deg * PI / 180;
    if (wd_forest_get_camera(forest, "over", &camera) != WD_OK)
        return camera;
    double ground_m = camera.position_m[2] - 60;
    camera.position_m[0] = 200;
    camera.position_m[1] = 200 - DISTANCE_M * sin(angle);
    camera.position_m[2] = ground_m + 17 + DISTANCE_M * cos(angle);
    camera.yaw_rad = angle >= 0 ? 0 : PI;
    camera.pitch_rad = fabs(angle) - PI / 2;
    camera.fov_rad = 0.16;
    return camera;
}

static double luminance(const struct wd_picture *picture)
{
    double sum = 0;
    size_t pixels = (size_t)picture->width * picture->height;
    for (size_t at = 0; at < pixels; at++)
        sum += 0.2126 * (double)picture->color[3 * at] +
               0.7152 * (double)picture->color[3 * at + 1] +
               0.0722 * (double)picture->color[3 * at + 2];
    return sum / (double)pixels;
}

static bool measure_angle(const struct painters *painters, double angle_deg, double *worst)
{
    struct wd_camera camera = camera_at(painters->forest, angle_deg);
    const struct wd_render_params draw = {.camera = camera,
                                          .width = SIDE,
                                          .height = SIDE,
                                          .samples = DRAWN_SAMPLES,
                                          .method = "octree",
                                          .layers = WD_LAYER_COLOR};
    const struct wd_reference_picture_params trace = {.camera = camera,
                                                      .width = SIDE,
                                                      .height = SIDE,
                                                      .samples = TRACED_SAMPLES,
                                                      .layers = WD_LAYER_COLOR};
    struct wd_picture drawn = {0}, traced = {0};
    bool ok = painters_paint(painters, &draw, &trace, &drawn, &traced);
    if (ok) {
        double a = luminance(&drawn), b = luminance(&traced), error = 100 * (a / b - 1);
        printf("%6.0f %9.5f %9.5f %+7.1f %%\n", angle_deg, a, b, error);
        *worst = fmax(*worst, fabs(error));
    }
    wd_picture_finish(&drawn);
    wd_picture_finish(&traced);
    return ok;
}

bool bench_reflectance(const char *gpu)
{
    struct painters painters;
    double worst = 0;
    bool ok = painters_init(&painters, "bench/canopy.json", NULL, gpu);
    if (ok)
        printf(
            "degrees from the zenith (sun at 40), luminance drawn and traced, drawn over traced\n");
    for (int i = 0; ok && i < ANGLES; i++)
        ok = measure_angle(&painters, angles_deg[i], &worst);
    if (ok)
        printf("brf-error-pct %.1f %%\n", worst);
    painters_finish(&painters);
    return ok;
}
