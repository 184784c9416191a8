/* world_ground.c: which ground the inventories stand on. Made-up ground has no place on Earth of its
 * own: it is laid where the data are, so that their large coordinates become small local ones. */
#include "world/inventory.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "world/terrain_parts.h"

static const double margin_m = 50.0;

struct bounds {
    double min[2], max[2];
};

static bool add_points(struct bounds *bounds, const struct wd_inventory *inventory,
                       const char *crs, const struct wd_log *log)
{
    double *x, *y;
    if (!wd_inventory_points(inventory, crs, log, &x, &y))
        return false;
    for (size_t i = 0; i < inventory->count; i++) {
        bounds->min[0] = fmin(bounds->min[0], x[i]);
        bounds->min[1] = fmin(bounds->min[1], y[i]);
        bounds->max[0] = fmax(bounds->max[0], x[i]);
        bounds->max[1] = fmax(bounds->max[1], y[i]);
    }
    free(x);
    free(y);
    return true;
}

/* Local inventories count only where there are no others: their zero is then the ground's. */
static bool bound(struct bounds *bounds, const struct wd_inventory *inventories, size_t count,
                  bool locals, const char *crs, const struct wd_log *log)
{
    *bounds = (struct bounds){{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
    for (size_t i = 0; i < count; i++) {
        bool local = wd_inventory_frame(inventories[i].wanted) == WD_FRAME_LOCAL;
        if (local == locals && !add_points(bounds, &inventories[i], crs, log))
            return false;
    }
    return true;
}

/* The coordinate system of ground that has none: that of the first inventory that names one, or
 * the UTM zone of its first tree where it is in degrees or feet; NULL where none names one. */
static bool choose_crs(char **crs, const struct wd_inventory *inventories, size_t count,
                       const struct wd_log *log)
{
    *crs = NULL;
    for (size_t i = 0; i < count; i++) {
        if (wd_inventory_frame(inventories[i].wanted) != WD_FRAME_CRS)
            continue;
        const struct wd_inventory_tree *tree = &inventories[i].trees[0];
        char *subject = wd_format("%s: frame", inventories[i].path);
        *crs = wd_crs_in_metres_at(inventories[i].wanted->frame, tree->x, tree->y, subject, log);
        free(subject);
        return *crs != NULL;
    }
    return true;
}

static bool has_place(const struct wd_inventory *inventories, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (wd_inventory_frame(inventories[i].wanted) != WD_FRAME_LOCAL)
            return true;
    return false;
}

static void fit_flat(struct wd_scene *scene, double window_m[4], const struct bounds *bounds,
                     const struct wd_log *log)
{
    for (int axis = 0; axis < 2; axis++) {
        window_m[axis] = floor(bounds->min[axis] - margin_m);
        window_m[2 + axis] = ceil(bounds->max[axis] + margin_m);
    }
    /* one cell size for both sides: whole metres in tens divide well */
    for (int axis = 0; axis < 2; axis++)
        window_m[2 + axis] =
            window_m[axis] + 10.0 * ceil((window_m[2 + axis] - window_m[axis]) / 10.0);
    scene->terrain.window_m = window_m;
    scene->terrain.window_count = 4;
    wd_info(log, "terrain: flat ground fitted to the inventories: %.0f x %.0f m from (%.0f, %.0f)",
            window_m[2] - window_m[0], window_m[3] - window_m[1], window_m[0], window_m[1]);
}

/* Lays ground of a given size under the middle of the data. */
static void lay_under(struct wd_terrain *terrain, const struct bounds *bounds)
{
    const double extent_m[2] = {wd_terrain_extent_x_m(terrain), wd_terrain_extent_y_m(terrain)};
    for (int axis = 0; axis < 2; axis++)
        terrain->origin_m[axis] =
            floor(0.5 * (bounds->min[axis] + bounds->max[axis] - extent_m[axis]));
}

static bool make_up(struct wd_terrain *terrain, const struct wd_inventory *inventories,
                    const struct wd_placement_params *params, bool fit, const char *crs)
{
    struct wd_scene scene = *params->scene;
    size_t count = scene.inventory_count;
    bool placed = has_place(inventories, count);
    double window_m[4];
    struct bounds bounds;
    if (!bound(&bounds, inventories, count, !placed, crs, params->log))
        return false;
    scene.terrain.target_crs = crs;
    if (fit)
        fit_flat(&scene, window_m, &bounds, params->log);
    if (!wd_terrain_init(terrain, &scene, params->seed, 0, params->threads, params->progress, params->log))
        return false;
    if (!fit && placed)
        lay_under(terrain, &bounds);
    return true;
}

bool wd_world_make_terrain(struct wd_terrain *terrain, const struct wd_inventory *inventories,
                           const struct wd_placement_params *params, bool *fitted)
{
    const struct wd_scene_terrain *wanted = &params->scene->terrain;
    size_t count = params->scene->inventory_count;
    bool made_up = wanted->kind != WD_TERRAIN_RASTER && wanted->window_count == 0;
    bool fit = made_up && wanted->kind == WD_TERRAIN_FLAT && !(wanted->size_m[0] > 0.0) &&
               !(wanted->size_m[1] > 0.0) && count > 0;
    *fitted = fit && !has_place(inventories, count);
    if (!made_up || (!fit && !has_place(inventories, count)))
        return wd_terrain_init(terrain, params->scene, params->seed, 0, params->threads, params->progress,
                               params->log);
    char *chosen = NULL;
    bool ok = wanted->target_crs || choose_crs(&chosen, inventories, count, params->log);
    ok = ok && make_up(terrain, inventories, params, fit,
                       wanted->target_crs ? wanted->target_crs : chosen);
    free(chosen);
    return ok;
}
