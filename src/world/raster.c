#include "world/raster.h"

#include <stdlib.h>

void wd_raster_finish(struct wd_raster *raster)
{
    free(raster->values);
    *raster = (struct wd_raster){0};
}
