#include "reference/ground.h"

#include <math.h>

enum { TILE_CELLS = 16, WALLS = 4 };

/* Bounds hold what rounding may move. */
static const double SLACK_M = 0.01;

/* --- a ray over the grid ------------------------------------------------------------------- */

/* A ray in units of cells (x, y) and metres (z). */
struct walk {
    const struct wd_terrain *terrain;
    double from[3], along[3];
    double at_m, above_m; /* where the walk has come to, and the ray's height over the ground there */
    bool begun;
};

struct triangle {
    double low, east, north; /* height at the south-western corner; rise a cell east, north */
    uint32_t id;
    bool hole;
};

static struct triangle triangle_of(const struct wd_terrain *terrain, uint32_t i, uint32_t j,
                                   bool upper)
{
    size_t sw = (size_t)j * terrain->width + i, nw = sw + terrain->width;
    const float *h = terrain->height_m;
    const uint8_t *hole = terrain->hole;
    struct triangle triangle = {.low = h[sw]};
    triangle.east = upper ? (double)h[nw + 1] - h[nw] : (double)h[sw + 1] - h[sw];
    triangle.north = upper ? (double)h[nw] - h[sw] : (double)h[nw + 1] - h[sw + 1];
    triangle.id = 2 * (j * (terrain->width - 1) + i) + upper;
    triangle.hole = hole && (hole[sw] || hole[nw + 1] || hole[upper ? nw : sw + 1]);
    return triangle;
}

/* The ray's height over the triangle's plane `at_m` along it. */
static double above(const struct walk *walk, const struct triangle *triangle, uint32_t i,
                    uint32_t j, double at_m)
{
    double u = walk->from[0] + walk->along[0] * at_m - i;
    double v = walk->from[1] + walk->along[1] * at_m - j;
    double z = walk->from[2] + walk->along[2] * at_m;
    return z - (triangle->low + u * triangle->east + v * triangle->north);
}

/* Goes on to `to_m` over one triangle; true where the ray passes through it. */
static bool step(struct walk *walk, uint32_t i, uint32_t j, bool upper, double to_m,
                 struct wd_ground_hit *hit)
{
    struct triangle triangle = triangle_of(walk->terrain, i, j, upper);
    double before_m = walk->begun ? walk->above_m : above(walk, &triangle, i, j, walk->at_m);
    double after_m = above(walk, &triangle, i, j, to_m), from_m = walk->at_m;
    /* the height is handed on, so that no rounding lets a ray slip between two triangles */
    walk->begun = true;
    walk->at_m = to_m;
    walk->above_m = after_m;
    if (triangle.hole || (before_m > 0) == (after_m > 0))
        return false;
    double share = before_m / (before_m - after_m);
    hit->at_m = (float)(from_m + (to_m - from_m) * share);
    hit->normal[0] = (float)(-triangle.east / walk->terrain->cell_m);
    hit->normal[1] = (float)(-triangle.north / walk->terrain->cell_m);
    hit->normal[2] = 1;
    hit->triangle = triangle.id;
    return true;
}

/* A cell's two triangles meet on its diagonal. */
static bool step_cell(struct walk *walk, uint32_t i, uint32_t j, double to_m,
                      struct wd_ground_hit *hit)
{
    double slope = walk->along[0] - walk->along[1];
    double here = walk->from[0] - i - (walk->from[1] - j) + slope * walk->at_m;
    double there = here + slope * (to_m - walk->at_m);
    if ((here > 0) != (there > 0)) {
        double middle = walk->at_m + (to_m - walk->at_m) * here / (here - there);
        if (step(walk, i, j, here <= 0, middle, hit))
            return true;
        return step(walk, i, j, there <= 0, to_m, hit);
    }
    return step(walk, i, j, 0.5 * (here + there) <= 0, to_m, hit);
}

/* Cuts [*near, *far] to where the ray is within [low, high] of an axis. */
static bool clip(double from, double along, double low, double high, double *near, double *far)
{
    if (fabs(along) < 1e-300)
        return from >= low && from <= high;
    double a = (low - from) / along, b = (high - from) / along;
    *near = fmax(*near, fmin(a, b));
    *far = fmin(*far, fmax(a, b));
    return *near <= *far;
}

static uint32_t cell_at(double x, uint32_t low, uint32_t high)
{
    return x <= low ? low : x >= high - 1 ? high - 1 : (uint32_t)x;
}

bool wd_trace_ground_hit(const struct wd_terrain *terrain, const double from_m[3],
                         const double direction[3], const uint32_t cells[4], double near_m,
                         double far_m, struct wd_ground_hit *hit)
{
    struct walk walk = {.terrain = terrain};
    for (int k = 0; k < 3; k++) {
        double scale = k < 2 ? 1 / terrain->cell_m : 1;
        walk.from[k] = from_m[k] * scale;
        walk.along[k] = direction[k] * scale;
    }
    for (int k = 0; k < 2; k++)
        if (!clip(walk.from[k], walk.along[k], cells[k], cells[2 + k], &near_m, &far_m))
            return false;
    if (!clip(walk.from[2], walk.along[2], terrain->min_m - 1.0, terrain->max_m + 1.0, &near_m,
              &far_m))
        return false;
    walk.at_m = near_m;
    uint32_t i = cell_at(walk.from[0] + walk.along[0] * near_m, cells[0], cells[2]);
    uint32_t j = cell_at(walk.from[1] + walk.along[1] * near_m, cells[1], cells[3]);
    for (;;) {
        uint32_t next[2] = {i + (walk.along[0] > 0), j + (walk.along[1] > 0)};
        double to[2];
        for (int k = 0; k < 2; k++)
            to[k] = walk.along[k] != 0 ? (next[k] - walk.from[k]) / walk.along[k] : INFINITY;
        int axis = to[0] <= to[1] ? 0 : 1;
        double to_m = fmax(fmin(to[axis], far_m), walk.at_m);
        if (step_cell(&walk, i, j, to_m, hit))
            return true;
        bool up = walk.along[axis] > 0;
        uint32_t *cell = axis == 0 ? &i : &j;
        if (to[axis] >= far_m || (up ? *cell + 1 >= cells[2 + axis] : *cell <= cells[axis]))
            return false;
        *cell += up ? 1 : UINT32_MAX;
    }
}

/* --- walls ------------------------------------------------------------------------------------- */

/* Sides 0 west, 1 east, 2 south, 3 north. A wall reaches from the terrain's foot up to its edge. */
static bool meet_wall(const struct wd_terrain *terrain, uint32_t side, const double from_m[3],
                      const double direction[3], struct wd_ground_hit *hit)
{
    const double extent_m[2] = {wd_terrain_extent_x_m(terrain), wd_terrain_extent_y_m(terrain)};
    uint32_t axis = side / 2;
    double at_m = ((side % 2 ? extent_m[axis] : 0) - from_m[axis]) / direction[axis], place_m[3];
    if (!isfinite(at_m))
        return false;
    for (int k = 0; k < 3; k++)
        place_m[k] = from_m[k] + direction[k] * at_m;
    if (place_m[1 - axis] < 0 || place_m[1 - axis] > extent_m[1 - axis] ||
        place_m[2] < (double)wd_terrain_foot_m(terrain) ||
        place_m[2] > (double)wd_terrain_height(terrain, place_m[0], place_m[1]))
        return false;
    *hit = (struct wd_ground_hit){.at_m = (float)at_m, .triangle = WD_TRACE_WALL + side};
    hit->normal[axis] = side % 2 ? 1.0f : -1.0f;
    return true;
}

static void bound_wall(const struct wd_trace_ground *ground, uint32_t side,
                       struct RTCBounds *bounds)
{
    const struct wd_terrain *terrain = ground->terrain;
    double low[3] = {0, 0, (double)wd_terrain_foot_m(terrain)};
    double high[3] = {wd_terrain_extent_x_m(terrain), wd_terrain_extent_y_m(terrain),
                      (double)terrain->max_m};
    if (side % 2)
        low[side / 2] = high[side / 2];
    else
        high[side / 2] = low[side / 2];
    for (int k = 0; k < 3; k++) {
        (&bounds->lower_x)[k] = (float)(low[k] - ground->origin_m[k] - SLACK_M);
        (&bounds->upper_x)[k] = (float)(high[k] - ground->origin_m[k] + SLACK_M);
    }
}

/* --- Embree's side --------------------------------------------------------------------------- */

static uint32_t tiles_across(uint32_t samples)
{
    return (samples - 2) / TILE_CELLS + 1;
}

static void tile_cells(const struct wd_terrain *terrain, uint32_t tile, uint32_t cells[4])
{
    uint32_t columns = tiles_across(terrain->width);
    cells[0] = tile % columns * TILE_CELLS;
    cells[1] = tile / columns * TILE_CELLS;
    for (int k = 0; k < 2; k++) {
        uint32_t last = (k == 0 ? terrain->width : terrain->height) - 1;
        cells[2 + k] = cells[k] + TILE_CELLS < last ? cells[k] + TILE_CELLS : last;
    }
}

static void bound_tile(const struct RTCBoundsFunctionArguments *args)
{
    const struct wd_trace_ground *ground = args->geometryUserPtr;
    const struct wd_terrain *terrain = ground->terrain;
    uint32_t cells[4], tiles = tiles_across(terrain->width) * tiles_across(terrain->height);
    if (args->primID >= tiles) {
        bound_wall(ground, args->primID - tiles, args->bounds_o);
        return;
    }
    tile_cells(terrain, args->primID, cells);
    float low = INFINITY, high = -INFINITY;
    for (uint32_t j = cells[1]; j <= cells[3]; j++) {
        for (uint32_t i = cells[0]; i <= cells[2]; i++) {
            float height_m = terrain->height_m[(size_t)j * terrain->width + i];
            low = fminf(low, height_m);
            high = fmaxf(high, height_m);
        }
    }
    struct RTCBounds *bounds = args->bounds_o;
    bounds->lower_x = (float)(cells[0] * terrain->cell_m - ground->origin_m[0] - SLACK_M);
    bounds->lower_y = (float)(cells[1] * terrain->cell_m - ground->origin_m[1] - SLACK_M);
    bounds->lower_z = (float)(low - ground->origin_m[2] - SLACK_M);
    bounds->upper_x = (float)(cells[2] * terrain->cell_m - ground->origin_m[0] + SLACK_M);
    bounds->upper_y = (float)(cells[3] * terrain->cell_m - ground->origin_m[1] + SLACK_M);
    bounds->upper_z = (float)(high - ground->origin_m[2] + SLACK_M);
}

static bool meet_tile(const struct wd_trace_ground *ground, uint32_t tile, const struct RTCRay *ray,
                      struct wd_ground_hit *hit)
{
    const double from_m[3] = {ray->org_x + ground->origin_m[0], ray->org_y + ground->origin_m[1],
                              ray->org_z + ground->origin_m[2]};
    const double direction[3] = {ray->dir_x, ray->dir_y, ray->dir_z};
    const struct wd_terrain *terrain = ground->terrain;
    uint32_t cells[4], tiles = tiles_across(terrain->width) * tiles_across(terrain->height);
    tile_cells(terrain, tile, cells);
    bool met = tile < tiles ? wd_trace_ground_hit(terrain, from_m, direction, cells, ray->tnear,
                                                  ray->tfar, hit)
                            : meet_wall(terrain, tile - tiles, from_m, direction, hit);
    return met && hit->at_m > ray->tnear && hit->at_m < ray->tfar;
}

static void intersect_tile(const struct RTCIntersectFunctionNArguments *args)
{
    struct RTCRayHit *rayhit = (struct RTCRayHit *)args->rayhit; /* single rays only */
    struct wd_ground_hit found;
    if (!args->valid[0] || !meet_tile(args->geometryUserPtr, args->primID, &rayhit->ray, &found))
        return;
    rayhit->ray.tfar = found.at_m;
    rayhit->hit.Ng_x = found.normal[0];
    rayhit->hit.Ng_y = found.normal[1];
    rayhit->hit.Ng_z = found.normal[2];
    rayhit->hit.u = rayhit->hit.v = 0;
    rayhit->hit.primID = found.triangle;
    rayhit->hit.geomID = args->geomID;
    rayhit->hit.instID[0] = args->context->instID[0];
}

static void occlude_tile(const struct RTCOccludedFunctionNArguments *args)
{
    struct RTCRay *ray = (struct RTCRay *)args->ray;
    struct wd_ground_hit found;
    if (args->valid[0] && meet_tile(args->geometryUserPtr, args->primID, ray, &found))
        ray->tfar = -INFINITY;
}

void wd_trace_ground_init(struct wd_trace_ground *ground, RTCDevice device,
                          const struct wd_terrain *terrain, const double origin_m[3])
{
    *ground = (struct wd_trace_ground){
        .terrain = terrain, .origin_m = {origin_m[0], origin_m[1], origin_m[2]}};
    ground->geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(ground->geometry, tiles_across(terrain->width) *
                                                           tiles_across(terrain->height) +
                                                           (terrain->hole ? 0 : WALLS));
    rtcSetGeometryUserData(ground->geometry, ground);
    rtcSetGeometryMask(ground->geometry, UINT32_MAX);
    rtcSetGeometryBoundsFunction(ground->geometry, bound_tile, NULL);
    rtcSetGeometryIntersectFunction(ground->geometry, intersect_tile);
    rtcSetGeometryOccludedFunction(ground->geometry, occlude_tile);
    rtcCommitGeometry(ground->geometry);
    ground->scene = rtcNewScene(device);
    rtcSetSceneBuildQuality(ground->scene, RTC_BUILD_QUALITY_MEDIUM);
    rtcAttachGeometry(ground->scene, ground->geometry);
    rtcCommitScene(ground->scene);
}

void wd_trace_ground_finish(struct wd_trace_ground *ground)
{
    if (ground->scene)
        rtcReleaseScene(ground->scene);
    if (ground->geometry)
        rtcReleaseGeometry(ground->geometry);
    *ground = (struct wd_trace_ground){0};
}
