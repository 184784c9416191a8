#include "world/shoreline.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "world/placement.h"

/* Steps of the search along each direction. */
enum { STEPS = 8 };

bool wd_shoreline_init(struct wd_shoreline *shoreline, const struct wd_scene *scene,
                       const struct wd_terrain *terrain, const struct wd_log *log)
{
    const struct wd_scene_map *map = &scene->water.map;
    struct wd_raster raster;
    if (!wd_raster_load(&raster, scene, map, terrain,
                        map->class_count ? WD_RESAMPLE_NEAREST : WD_RESAMPLE_LINEAR,
                        UINT64_C(1) << 24, log))
        return false;
    *shoreline = (struct wd_shoreline){.width = raster.width, .height = raster.height,
                                       .cell_x_m = raster.cell_x_m, .cell_y_m = raster.cell_y_m,
                                       .share = raster.values, .lowest = INFINITY, .highest = -INFINITY};
    for (size_t i = 0; i < (size_t)raster.width * raster.height; i++) {
        shoreline->lowest = fminf(shoreline->lowest, raster.values[i]); /* passes over NaN */
        shoreline->highest = fmaxf(shoreline->highest, raster.values[i]);
        shoreline->share[i] = wd_map_probability(map, raster.values[i]);
    }
    return true;
}

void wd_shoreline_finish(struct wd_shoreline *shoreline)
{
    free(shoreline->share);
    *shoreline = (struct wd_shoreline){0};
}

/* Weights of the three cells about a place of a quadratic B-spline; its contours have no corners, even where cells are
 * but wet or dry. `cells[k]`: their indices, the first or last one's for those past the edge. */
static void spline(float weights[3], size_t cells[3], double at, uint32_t count)
{
    double middle = floor(fmin(fmax(at, 0), count - 0.001));
    float past = (float)(fmin(fmax(at, 0), count) - middle);
    weights[0] = 0.5f * (1 - past) * (1 - past);
    weights[2] = 0.5f * past * past;
    weights[1] = 1 - weights[0] - weights[2];
    for (int k = 0; k < 3; k++)
        cells[k] = (size_t)fmin(fmax(middle + k - 1, 0), count - 1.0);
}

float wd_shoreline_share(const struct wd_shoreline *shoreline, double x_m, double y_m)
{
    float east[3], north[3], sum = 0;
    size_t columns[3], rows[3];
    spline(east, columns, x_m / shoreline->cell_x_m, shoreline->width);
    spline(north, rows, y_m / shoreline->cell_y_m, shoreline->height);
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++)
            sum += north[j] * east[i] * shoreline->share[rows[j] * shoreline->width + columns[i]];
    return sum;
}

float wd_shoreline_way_m(const struct wd_shoreline *shoreline, double x_m, double y_m, double farthest_m)
{
    static const int ways[16][2] = {{1, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 1}, {-1, 2}, {-1, 1}, {-2, 1},
                                    {-1, 0}, {-2, -1}, {-1, -1}, {-1, -2}, {0, -1}, {1, -2}, {1, -1}, {2, -1}};
    double step_m = farthest_m / STEPS, nearest_m = farthest_m;
    float here = wd_shoreline_share(shoreline, x_m, y_m);
    for (int way = 0; way < 16; way++) {
        double length = sqrt(ways[way][0] * ways[way][0] + ways[way][1] * ways[way][1]);
        float before = here;
        for (double from_m = 0; from_m < nearest_m; from_m += step_m) {
            double to_m = from_m + step_m;
            float at = wd_shoreline_share(shoreline, x_m + ways[way][0] * to_m / length,
                                          y_m + ways[way][1] * to_m / length);
            if ((at >= 0.5f) != (here >= 0.5f)) {
                nearest_m = fmin(nearest_m, from_m + step_m * ((0.5 - before) / (at - before)));
                break;
            }
            before = at;
        }
    }
    return (float)nearest_m;
}
