/* sky.h: the world's map of the sky as an image. */
#ifndef WD_FOREST_SKY_H
#define WD_FOREST_SKY_H

#include "gpu/memory.h"
#include "world/sky_map.h"

/* A single black texel where there is no map. */
bool wd_sky_upload(struct wd_image *image, struct wd_gpu *gpu, const struct wd_sky_map *map);

#endif
