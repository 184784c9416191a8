/* layer_map.c: any raster as a grid of probabilities. */
#include "world/placement.h"

#include <math.h>

#include "base/log.h"
#include "base/memory.h"
#include "world/river.h"

static float class_probability(const struct wd_scene_map *map, float value)
{
    for (size_t i = 0; i < map->class_count; i++)
        if ((float)map->classes[i] == roundf(value))
            return map->class_density_count > i ? (float)map->class_density[i] : 1.0f;
    return 0.0f;
}

float wd_map_probability(const struct wd_scene_map *map, float value)
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

static void set_grid(struct wd_place_layer *to, uint32_t width, uint32_t height,
                     const double cell_m[2])
{
    to->map_width = width;
    to->map_height = height;
    for (int axis = 0; axis < 2; axis++) {
        to->map_axis[axis] = wd_axis_of(cell_m[axis] * 1000.0);
        to->map_half_mm[axis] = (uint32_t)(cell_m[axis] * 500.0);
    }
}

/* A raster without any data has been told of. */
static void warn_of_nothing(const struct wd_placement *placement, const struct wd_raster *raster,
                            const struct wd_log *log)
{
    const struct wd_scene_map *map = &placement->layer->map;
    size_t count = (size_t)raster->width * raster->height;
    float low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < count; i++) {
        if (placement->map[i] > 0.0f)
            return;
        low = fminf(low, raster->values[i]); /* passes over NaN */
        high = fmaxf(high, raster->values[i]);
    }
    if (low <= high)
        wd_warn(log, "%s: %s has no pixel on the terrain %s, but values of %g to %g: no tree can stand", placement->name,
                map->file, map->class_count > 0 ? "that is of its \"classes\"" : "beyond the first of its \"value_range\"",
                (double)low, (double)high);
}

static void take_raster(struct wd_placement *placement, const struct wd_raster *raster)
{
    const struct wd_scene_map *map = &placement->layer->map;
    struct wd_place_layer *to = &placement->input.layer;
    size_t count = (size_t)raster->width * raster->height;
    placement->map = wd_alloc_array(count, sizeof(float));
    for (size_t i = 0; i < count; i++)
        placement->map[i] = wd_map_probability(map, raster->values[i]);
    to->map_kind = map->class_count > 0 ? WD_PLACE_MAP_NEAREST : WD_PLACE_MAP_LINEAR;
    set_grid(to, raster->width, raster->height,
             (const double[2]){raster->cell_x_m, raster->cell_y_m});
}

/* Whether water covers a part of a cell: its middle or the middle of a quarter. */
static bool is_wet(const struct wd_terrain *terrain, double x_m, double y_m, const double cell_m[2])
{
    bool wet = wd_river_covers(terrain, x_m, y_m);
    for (int quarter = 0; quarter < 4 && !wet; quarter++)
        wet = wd_river_covers(terrain, x_m + (quarter & 1 ? 0.25 : -0.25) * cell_m[0],
                              y_m + (quarter & 2 ? 0.25 : -0.25) * cell_m[1]);
    return wet;
}

/* Nothing grows in waters of a map. A layer without a map of its own gets one with the terrain's
 * cells. */
static void keep_dry(struct wd_placement *placement, const struct wd_terrain *terrain)
{
    struct wd_place_layer *to = &placement->input.layer;
    double cell_m[2] = {terrain->cell_m, terrain->cell_m};
    if (!placement->map) {
        size_t count = (size_t)(terrain->width - 1) * (terrain->height - 1);
        placement->map = wd_alloc_array(count, sizeof(float));
        for (size_t i = 0; i < count; i++)
            placement->map[i] = 1.0f;
        to->map_kind = WD_PLACE_MAP_NEAREST;
        set_grid(to, terrain->width - 1, terrain->height - 1, cell_m);
    }
    cell_m[0] = wd_terrain_extent_x_m(terrain) / to->map_width;
    cell_m[1] = wd_terrain_extent_y_m(terrain) / to->map_height;
    for (size_t i = 0; i < (size_t)to->map_width * to->map_height; i++) {
        double x_m = ((double)(i % to->map_width) + 0.5) * cell_m[0];
        double y_m = ((double)(i / to->map_width) + 0.5) * cell_m[1];
        if (is_wet(terrain, x_m, y_m, cell_m))
            placement->map[i] = 0.0f;
    }
}

static bool load_own(struct wd_placement *placement, const struct wd_placement_params *params)
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
    if (ok) {
        take_raster(placement, &raster);
        warn_of_nothing(placement, &raster, params->log);
    } else {
        wd_error(params->log, "%s: cells of %g x %g m are too small", map->file, raster.cell_x_m,
                 raster.cell_y_m);
    }
    wd_raster_finish(&raster);
    return ok;
}

bool wd_layer_map_load(struct wd_placement *placement, const struct wd_placement_params *params)
{
    if (!load_own(placement, params))
        return false;
    if (params->terrain->water_m)
        keep_dry(placement, params->terrain);
    return true;
}
