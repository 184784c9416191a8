#include "world/raster.h"

#include <math.h>
#include <stdlib.h>

void wd_raster_finish(struct wd_raster *raster)
{
    free(raster->values);
    *raster = (struct wd_raster){0};
}

float wd_raster_at(const struct wd_raster *raster, double x_m, double y_m)
{
    double u = x_m / raster->cell_x_m, v = y_m / raster->cell_y_m;
    if (!(u >= 0 && v >= 0 && u <= raster->width && v <= raster->height))
        return NAN;
    /* The far edges belong to the last cells: trees may stand exactly there. */
    uint32_t i = u < raster->width ? (uint32_t)u : raster->width - 1;
    uint32_t j = v < raster->height ? (uint32_t)v : raster->height - 1;
    return raster->values[(size_t)j * raster->width + i];
}
