/* layer_map.c: any raster as a grid of probabilities. */
#include "world/placement.h"

#include <math.h>

#include "base/memory.h"

static float class_probability(const struct wd_scene_map *map, float value)
{
    for (size_t i = 0; i < map->class_count; i++)
        if ((float)map->classes[i] == roundf(value))
            return map->class_density_count > i ? (float)map->class_density[i] : 1.0f;
    return 0.0f;
}

static float probability(const struct wd_scene_map *map, float value)
{
    if (isnan(value))
        return 0.0f;
    if (map->class_count > 0)
        return class_probability(map, value);
    double low = map->value_range[0], high = map->value_range[1];
    if (low == 0.0 && high == 0.0)
        high = 1.0; /* not given */
    if (low == high)
        return value >= map->value_range[0] ? 1.0f : 0.0f;
    return (float)fmin(fmax(((double)value - low) / (high - low), 0.0), 1.0);
}

static void take_raster(struct wd_placement *placement, const struct wd_raster *raster)
{
    const struct wd_scene_map *map = &placement->layer->map;
    struct wd_place_layer *to = &placement->input.layer;
    size_t count = (size_t)raster->width * raster->height;
    placement->map = wd_alloc_array(count, sizeof(float));
    for (size_t i = 0; i < count; i++)
        placement->map[i] = probability(map, raster->values[i]);
    to->map_kind = map->class_count > 0 ? WD_PLACE_MAP_NEAREST : WD_PLACE_MAP_LINEAR;
    to->map_width = raster->width;
    to->map_height = raster->height;
    const double cell_mm[2] = {raster->cell_x_m * 1000.0, raster->cell_y_m * 1000.0};
    for (int axis = 0; axis < 2; axis++) {
        to->map_axis[axis] = wd_axis_of(cell_mm[axis]);
        to->map_half_mm[axis] = (uint32_t)(cell_mm[axis] * 0.5);
    }
}

bool wd_layer_map_load(struct wd_placement *placement, const struct wd_placement_params *params)
{
    const struct wd_scene_map *map = &placement->layer->map;
    if (map->file == NULL)
        return true;
    struct wd_raster raster;
    enum wd_resampling resampling = map->class_count > 0 ? WD_RESAMPLE_NEAREST : WD_RESAMPLE_LINEAR;
    if (!wd_raster_load(&raster, params->scene, map, params->terrain, resampling, UINT64_C(1) << 24,
                        params->log))
        return false;
    bool ok = raster.cell_x_m >= 0.002 && raster.cell_y_m >= 0.002;
    if (ok)
        take_raster(placement, &raster);
    else
        wd_error(params->log, "%s: cells of %g x %g m are too small", map->file, raster.cell_x_m,
                 raster.cell_y_m);
    wd_raster_finish(&raster);
    return ok;
}
