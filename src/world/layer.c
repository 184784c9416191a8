/* layer.c: a layer of the scene as the numbers that shaders/shared/placement.h wants. */
#include "world/placement.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/dmath.h"
#include "base/memory.h"

static const struct wd_ramp always = {.from = -1e9f, .scale = 1.0f};

/* 0 at `from`, 1 at `to`. */
static struct wd_ramp ramp_between(double from, double to)
{
    double span = to - from;
    if (fabs(span) < 1e-6)
        span = span < 0.0 ? -1e-6 : 1e-6;
    return (struct wd_ramp){.from = (float)from, .scale = (float)(1.0 / span)};
}

static double tangent_squared(double degrees)
{
    double clamped = fmin(fmax(degrees, 0.0), 89.9) * (WD_PI / 180.0);
    double tangent = wd_dsin(clamped) / wd_dcos(clamped);
    return tangent * tangent;
}

/* The soft edges lie within the range: nothing grows outside. A range that starts at level ground
 * or ends at the vertical has no edge there. */
static void set_slope(struct wd_place_layer *to, const struct wd_scene_layer *from)
{
    double low = from->slope_deg[0], high = from->slope_deg[1], fade = from->slope_fade_deg;
    bool open_low = !(low > 0.0), open_high = !(high < 90.0) || (low == 0.0 && high == 0.0);
    to->slope[0] = to->slope[1] = always;
    to->has_slope = !open_low || !open_high;
    if (!open_low)
        to->slope[0] = ramp_between(tangent_squared(low), tangent_squared(low + fade) + 1e-6);
    if (!open_high)
        to->slope[1] = ramp_between(tangent_squared(high), tangent_squared(high - fade) - 1e-6);
}

static void set_altitude(struct wd_place_layer *to, const struct wd_scene_layer *from,
                         const struct wd_terrain *terrain)
{
    double low = from->altitude_m[0], high = from->altitude_m[1], fade = from->altitude_fade_m;
    bool unset = low == 0.0 && high == 0.0;
    bool open_low = unset || !(low + fade > (double)terrain->min_m);
    bool open_high = unset || !(high - fade < (double)terrain->max_m);
    to->altitude[0] = to->altitude[1] = always;
    to->has_altitude = !open_low || !open_high;
    if (!open_low)
        to->altitude[0] = ramp_between(low, low + fade + 1e-3);
    if (!open_high)
        to->altitude[1] = ramp_between(high, high - fade - 1e-3);
}

static bool set_patches(struct wd_placement *placement, const struct wd_log *log)
{
    struct wd_place_layer *to = &placement->input.layer;
    const struct wd_scene_layer *from = placement->layer;
    to->has_patches = from->patchiness > 0.0;
    if (!to->has_patches)
        return true;
    if (!(from->patch_size_m >= 0.1 && from->patch_size_m <= 1e6))
        return wd_error(log, "%s: patch_size_m: %g, 0.1 .. 1000000 is allowed",
                        placement->name, from->patch_size_m);
    to->patchiness = (float)from->patchiness;
    to->patch_axis[0] = wd_axis_of(from->patch_size_m * 1000.0);
    to->patch_axis[1] = wd_axis_of(from->patch_size_m * 500.0);
    return true;
}

static uint32_t clamp_cm(double height_m)
{
    double cm = floor(height_m * 100.0 + 0.5);
    return cm < 1.0 ? 1 : cm > WD_TREE_HEIGHT_MOST_CM ? WD_TREE_HEIGHT_MOST_CM : (uint32_t)cm;
}

static uint32_t turn_of(const struct wd_scene_layer *from)
{
    if (!from->yaw_count)
        return WD_PLACE_ANY_TURN;
    double turns = (double)from->yaw_deg[0] / 360.0;
    return (uint32_t)((turns - floor(turns)) * 65536.0) & 0xffffu;
}

static void set_sizes(struct wd_place_layer *to, const struct wd_scene_layer *from)
{
    to->height_min_cm = clamp_cm(from->height_m[0]);
    uint32_t max_cm = clamp_cm(from->height_m[1]);
    to->height_span_cm = max_cm > to->height_min_cm ? max_cm - to->height_min_cm + 1 : 1;
    double low = from->aspect[0] > 0.0f ? from->aspect[0] : 1.0;
    double high = from->aspect[1] > 0.0f ? from->aspect[1] : low;
    to->aspect_min = (uint32_t)(fmin(low, 15.0) * 1024.0 + 0.5);
    uint32_t aspect_max = (uint32_t)(fmin(high, 15.0) * 1024.0 + 0.5);
    to->aspect_span = aspect_max > to->aspect_min ? aspect_max - to->aspect_min + 1 : 1;
    to->tint = (uint32_t)(fmin(fmax(from->tint, 0.0), 1.0) * 127.0 + 0.5);
    to->turn = turn_of(from);
}

static bool set_cells(struct wd_placement *placement, const struct wd_log *log)
{
    struct wd_place_layer *to = &placement->input.layer;
    const struct wd_scene_layer *from = placement->layer;
    const struct wd_place_ground *ground = &placement->input.ground.ground;
    if (from->placement == WD_PLACE_CANOPY)
        return true;
    if (!(from->spacing_m >= 0.01 && from->spacing_m <= 100000.0))
        return wd_error(log, "%s: spacing_m: %g, 0.01 .. 100000 is allowed", placement->name,
                        from->spacing_m);
    to->cell_mm = (uint32_t)(from->spacing_m * 1000.0 + 0.5);
    to->columns = ((uint32_t)ground->extent_mm[0] + to->cell_mm - 1) / to->cell_mm;
    to->rows = ((uint32_t)ground->extent_mm[1] + to->cell_mm - 1) / to->cell_mm;
    to->jitter = (uint32_t)(fmin(fmax(from->jitter, 0.0), 1.0) * 2147483648.0);
    return true;
}

static bool set_layer(struct wd_placement *placement, const struct wd_placement_params *params,
                      size_t index)
{
    struct wd_place_layer *to = &placement->input.layer;
    const struct wd_scene_layer *from = placement->layer;
    const struct wd_place_ground *ground = &placement->input.ground.ground;
    to->key = wd_hash2(params->seed, (uint32_t)index);
    to->extent_mm[0] = ground->extent_mm[0];
    to->extent_mm[1] = ground->extent_mm[1];
    int64_t variants = params->scene->variants;
    to->variants = variants < 1 ? 1 : variants > 256 ? 256 : (uint32_t)variants;
    to->has_water = params->scene->water.enabled;
    to->water_m = (float)params->scene->water.level_m;
    set_slope(to, from);
    set_altitude(to, from, params->terrain);
    set_sizes(to, from);
    return set_patches(placement, params->log) && set_cells(placement, params->log);
}

/* One without a name is called "layer N" by the scene. */
static void set_name(struct wd_placement *placement, size_t index)
{
    const char *given = placement->layer->name;
    size_t size = sizeof placement->name;
    snprintf(placement->name, size, "layer %zu", index + 1);
    if (given && strcmp(given, placement->name) != 0)
        snprintf(placement->name, size, "layer %s", given);
}

bool wd_placement_init(struct wd_placement *placement, const struct wd_placement_params *params,
                       size_t layer_index)
{
    *placement = (struct wd_placement){.layer = &params->scene->layers[layer_index]};
    set_name(placement, layer_index);
    if (wd_ground_input_init(&placement->input.ground, params) &&
        set_layer(placement, params, layer_index) && wd_layer_tables_init(placement, params) &&
        wd_layer_map_load(placement, params)) {
        placement->input.map = placement->map;
        placement->input.table = placement->table;
        return true;
    }
    wd_placement_finish(placement);
    return false;
}

void wd_placement_finish(struct wd_placement *placement)
{
    free(placement->map);
    free(placement->table);
    *placement = (struct wd_placement){0};
}
