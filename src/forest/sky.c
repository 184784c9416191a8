#include "forest/sky.h"

#include <stdlib.h>

#include "base/half.h"
#include "base/memory.h"

bool wd_sky_upload(struct wd_image *image, struct wd_gpu *gpu, const struct wd_sky_map *map)
{
    const struct wd_image_params params = {.name = "sky map",
                                           .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                           .width = map->width ? map->width : 1,
                                           .height = map->width ? map->height : 1,
                                           .usage = VK_IMAGE_USAGE_SAMPLED_BIT};
    size_t count = (size_t)map->width * map->height, texels = count ? count : 1;
    uint16_t(*values)[4] = wd_alloc_array(texels, sizeof *values);
    for (size_t at = 0; at < count; at++)
        for (size_t k = 0; k < 3; k++)
            values[at][k] = wd_half_of(map->rgb[3 * at + k]);
    bool ok = wd_image_init(image, gpu, &params) &&
              wd_image_upload(gpu, image, 0, 0, values, texels * sizeof *values);
    free(values);
    return ok;
}
