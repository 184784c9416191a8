#include "frame/crown_sky.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "shared/light.h"
#include "shared/tree_pose.h"
#include "world/octree.h"

static const uint32_t crown_sky_comp[] =
#include "crown_sky.comp.inc"
    ;
static const uint32_t floor_sky_comp[] =
#include "floor_sky.comp.inc"
    ;

enum {
    SLOTS = WD_CROWN_SKY_SETS * WD_CROWN_SKY_SLOTS,
    FLOOR_TEXELS = WD_FLOOR_SKY_ACROSS * WD_FLOOR_SKY_ACROSS,
    TILE_SQUARES = WD_FLOOR_SKY_TILE * WD_FLOOR_SKY_TILE,
    THREADS = 64,
};

bool wd_crown_sky_init(struct wd_crown_sky *sky, struct wd_gpu *gpu)
{
    const VkDescriptorType buffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    struct wd_compute_params params = {
        .shader = WD_SPIRV(crown_sky_comp),
        .bindings = {5, {buffer, buffer, buffer, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, buffer, buffer}},
        .push_size = sizeof(struct wd_crown_sky_push),
    };
    *sky = (struct wd_crown_sky){0};
    if (!wd_pipeline_init_compute(&sky->crowns, gpu, &params))
        return false;
    params.shader = (struct wd_spirv)WD_SPIRV(floor_sky_comp);
    params.bindings.count = 6;
    return wd_pipeline_init_compute(&sky->floor, gpu, &params);
}

void wd_crown_sky_drop_forest(struct wd_crown_sky *sky, struct wd_gpu *gpu)
{
    wd_buffer_finish(&sky->table, gpu);
    free(sky->slots);
    *sky = (struct wd_crown_sky){.crowns = sky->crowns, .floor = sky->floor, .updates = sky->updates};
}

void wd_crown_sky_finish(struct wd_crown_sky *sky, struct wd_gpu *gpu)
{
    wd_crown_sky_drop_forest(sky, gpu);
    *sky = (struct wd_crown_sky){0};
}

void wd_crown_sky_forget(struct wd_crown_sky *sky)
{
    sky->told = false;
    memset(sky->tiles, 0, sizeof sky->tiles);
    if (sky->slots)
        memset(sky->slots, 0, SLOTS * sizeof *sky->slots);
}

static bool prepare(struct wd_crown_sky *sky, struct wd_cmd *cmd, const struct wd_forest_device *forest)
{
    uint64_t texels = forest->world->tree_count ? (uint64_t)SLOTS * WD_CROWN_SKY_TEXELS + FLOOR_TEXELS : 0;
    const struct wd_buffer_params params = {
        .name = "sky of crowns",
        .size = (WD_CROWN_SKY_SETS + texels) * 4 * sizeof(uint32_t),
        .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
        .texels = VK_FORMAT_R32G32B32A32_UINT,
    };
    if (sky->slots)
        return true;
    if (!wd_buffer_init(&sky->table, cmd->gpu, &params))
        return false;
    sky->slots = wd_alloc_array(SLOTS, sizeof *sky->slots);
    return true;
}

/* --- trees --------------------------------------------------------------------------------- */

struct work {
    struct wd_crown_sky *sky;
    const struct wd_forest_device *forest;
    const struct wd_view *view;
    struct new_tree {
        uint32_t record, slot;
    } *missing; /* by record */
    size_t missing_count, missing_capacity;
    struct tile {
        int32_t column, row;
    } tiles[WD_FLOOR_SKY_TILES * WD_FLOOR_SKY_TILES]; /* of the floor, that are missing, too */
    size_t tile_count;
    double low_m[2], high_m[2]; /* about all that are missing, as far as neighbours count */
    struct beside {
        uint32_t record;
        int32_t column, row;
    } *beside; /* trees in there, by record */
    size_t beside_count, beside_capacity;
};

static const struct wd_tree *tree_of(const struct work *work, uint32_t record)
{
    return &work->forest->world->trees[record];
}

static void place_of(const struct wd_tree *tree, double place_m[2])
{
    place_m[0] = tree->x_mm * 0.001;
    place_m[1] = tree->y_mm * 0.001;
}

static void widen(struct work *work, const double place_m[2], double by_m)
{
    for (int k = 0; k < 2; k++) {
        work->low_m[k] = fmin(work->low_m[k], place_m[k] - by_m);
        work->high_m[k] = fmax(work->high_m[k], place_m[k] + by_m);
    }
}

/* The tree's slot, or another of its set: the one that was not used for longest, if not by this very update. */
static void ask_for(struct work *work, uint32_t record)
{
    struct wd_crown_sky_slot *set = &work->sky->slots[wd_crown_sky_set(record) * WD_CROWN_SKY_SLOTS], *oldest = set;
    for (uint32_t i = 0; i < WD_CROWN_SKY_SLOTS; i++) {
        if (set[i].record == record + 1) {
            set[i].used = work->sky->updates;
            return;
        }
        oldest = set[i].used < oldest->used ? &set[i] : oldest;
    }
    if (oldest->used == work->sky->updates)
        return;
    *oldest = (struct wd_crown_sky_slot){record + 1, work->sky->updates};
    double place_m[2];
    place_of(tree_of(work, record), place_m);
    widen(work, place_m, (double)WD_CROWN_SKY_REACH_M);
    *wd_push(work->missing, work->missing_count, work->missing_capacity) =
        (struct new_tree){record, (uint32_t)(oldest - work->sky->slots)};
}

/* How far off a box of the local frame is that the view may see within `most_m`; infinite: it does not. */
static float seen_m(const struct work *work, const float min_m[3], const float max_m[3], float most_m)
{
    float min[3], max[3];
    for (int k = 0; k < 3; k++) {
        min[k] = (float)((double)min_m[k] - work->view->eye_m[k]);
        max[k] = (float)((double)max_m[k] - work->view->eye_m[k]);
    }
    float distance_m = wd_box_distance(min, max);
    bool out = distance_m > most_m || wd_frustum_box(&work->view->frustum, min, max) == WD_OUTSIDE;
    return out ? INFINITY : distance_m;
}

static void ask_if_large(struct work *work, uint32_t record)
{
    const struct wd_tree *tree = tree_of(work, record);
    float min_m[3], max_m[3], height_m = WD_TREE_HEIGHT_M(*tree);
    if (height_m < WD_HERB_M)
        return;
    wd_tree_bounds(tree, min_m, max_m);
    float away_m = seen_m(work, min_m, max_m, WD_CROWN_SKY_FAR_M);
    if (away_m < INFINITY && wd_crown_sky_share(height_m, away_m, work->view->pixels_per_radian) > 0)
        ask_for(work, record);
}

/* Trees of octants that are entered, by record. */
static void walk(struct work *work, uint32_t index, bool (*enters)(const struct work *, const struct wd_octant *),
                 void (*take)(struct work *, uint32_t))
{
    const struct wd_octant *octants = work->forest->world->octree.octants, *octant = &octants[index];
    if (!enters(work, octant))
        return;
    for (uint32_t i = octant->begin; i < octant->own_end; i++)
        take(work, i);
    uint32_t child = octant->first_child;
    for (uint32_t i = 0; i < octant->child_count; i++) {
        walk(work, child, enters, take);
        child = octants[child].next_sibling;
    }
}

static bool is_near(const struct work *work, const struct wd_octant *octant)
{
    return seen_m(work, octant->min_m, octant->max_m, WD_CROWN_SKY_FAR_M) < INFINITY;
}

static bool is_beside(const struct work *work, const struct wd_octant *octant)
{
    for (int k = 0; k < 2; k++)
        if ((double)octant->max_m[k] < work->low_m[k] || (double)octant->min_m[k] > work->high_m[k])
            return false;
    return true;
}

static void add_beside(struct work *work, uint32_t record)
{
    const struct wd_tree *tree = tree_of(work, record);
    double place_m[2];
    place_of(tree, place_m);
    for (int k = 0; k < 2; k++)
        if (place_m[k] < work->low_m[k] || place_m[k] > work->high_m[k])
            return;
    if (WD_TREE_HEIGHT_M(*tree) < WD_HERB_M)
        return;
    *wd_push(work->beside, work->beside_count, work->beside_capacity) =
        (struct beside){record, (int32_t)floor(place_m[0] / (double)WD_CROWN_SKY_CELL_M),
                        (int32_t)floor(place_m[1] / (double)WD_CROWN_SKY_CELL_M)};
}

static struct wd_sky_crown crown_of(const struct work *work, uint32_t record)
{
    const struct wd_tree *tree = tree_of(work, record);
    uint32_t index = wd_forest_model_of(work->forest, tree);
    const struct wd_crown_shade *shade = &work->forest->crown_shades[index];
    struct wd_tree_pose pose = wd_tree_pose_of(*tree, work->forest->host_models[index]);
    return (struct wd_sky_crown){.foot_mm = {tree->x_mm, tree->y_mm, tree->z_mm},
                                 .radius_m = fmaxf(shade->radius_m * pose.across, 0.1f),
                                 .half_m = fmaxf(shade->half_m * pose.up, 0.1f),
                                 .middle_m = shade->middle_m * pose.up,
                                 .per_m = shade->per_m / cbrtf(pose.across * pose.across * pose.up),
                                 .steeper = shade->steeper,
                                 .stem_radius_m = work->forest->stem_radii_m[index] * pose.across};
}

/* --- the floor ----------------------------------------------------------------------------- */

float wd_crown_sky_floor_m(const struct wd_forest_device *forest, const struct wd_view *view)
{
    if (!forest->world->octree.count || forest->world->demand.count)
        return 0;
    return fminf(WD_FLOOR_SKY_FAR_M, view->pixels_per_radian * (WD_FLOOR_SKY_M / WD_FLOOR_SKY_LEAST_PX));
}

static void middle_of(const struct tile *tile, double place_m[2])
{
    place_m[0] = (tile->column + 0.5) * (double)WD_FLOOR_SKY_TILE_M;
    place_m[1] = (tile->row + 0.5) * (double)WD_FLOOR_SKY_TILE_M;
}

static bool sees_tile(const struct work *work, const struct tile *tile)
{
    const struct wd_terrain *terrain = &work->forest->world->terrain;
    const double half_m = 0.5 * (double)WD_FLOOR_SKY_TILE_M, beside_m = (double)WD_FLOOR_SKY_M;
    const double extent_m[2] = {wd_terrain_extent_x_m(terrain), wd_terrain_extent_y_m(terrain)};
    double middle_m[2];
    float min_m[3], max_m[3];
    middle_of(tile, middle_m);
    for (int k = 0; k < 2; k++) {
        min_m[k] = (float)(middle_m[k] - half_m - beside_m); /* squares beside it are mixed with its */
        max_m[k] = (float)(middle_m[k] + half_m + beside_m);
        if (max_m[k] < 0 || (double)min_m[k] > extent_m[k])
            return false;
    }
    min_m[2] = max_m[2] = wd_terrain_height(terrain, middle_m[0], middle_m[1]);
    for (int corner = 0; corner < 4; corner++) {
        float x_m = corner & 1 ? min_m[0] : max_m[0], y_m = corner & 2 ? min_m[1] : max_m[1];
        float z_m = wd_terrain_height(terrain, (double)x_m, (double)y_m);
        min_m[2] = fminf(min_m[2], z_m);
        max_m[2] = fmaxf(max_m[2], z_m);
    }
    min_m[2] -= WD_FLOOR_SKY_TILE_M; /* between these places, and plants on it */
    max_m[2] += WD_FLOOR_SKY_TILE_M;
    return seen_m(work, min_m, max_m, wd_crown_sky_floor_m(work->forest, work->view)) < INFINITY;
}

/* Tiles about the eye that are not known yet. */
static void ask_for_floor(struct work *work)
{
    const int32_t half = WD_FLOOR_SKY_TILES / 2, last = WD_FLOOR_SKY_TILES - 1;
    const int32_t column = (int32_t)floor(work->view->eye_m[0] / (double)WD_FLOOR_SKY_TILE_M);
    const int32_t row = (int32_t)floor(work->view->eye_m[1] / (double)WD_FLOOR_SKY_TILE_M);
    for (int32_t j = row - half; j < row + half; j++)
        for (int32_t i = column - half; i < column + half; i++) {
            struct wd_floor_sky_tile *known = &work->sky->tiles[(j & last) * WD_FLOOR_SKY_TILES + (i & last)];
            const struct tile tile = {i, j};
            if ((known->known && known->column == i && known->row == j) || !sees_tile(work, &tile))
                continue;
            *known = (struct wd_floor_sky_tile){i, j, true};
            work->tiles[work->tile_count++] = tile;
            double middle_m[2];
            middle_of(&tile, middle_m);
            widen(work, middle_m, (double)(WD_CROWN_SKY_REACH_M + 0.5f * WD_FLOOR_SKY_TILE_M));
        }
}

/* --- recording ----------------------------------------------------------------------------- */

struct grid {
    struct wd_crown_sky_push push;
    struct wd_binding crowns, cells, jobs, rises;
};

static void lay_out(struct grid *grid, const struct work *work)
{
    double cell_m = (double)WD_CROWN_SKY_CELL_M;
    struct wd_crown_sky_push *push = &grid->push;
    *push = (struct wd_crown_sky_push){
        .job_count = (uint32_t)work->missing_count,
        .tile_count = (uint32_t)work->tile_count,
        .first_column = (int32_t)floor(work->low_m[0] / cell_m),
        .first_row = (int32_t)floor(work->low_m[1] / cell_m),
        .canopy_from_m = {work->forest->canopy_light_from_m[0], work->forest->canopy_light_from_m[1]},
        .canopy_scale = {work->forest->canopy_light_scale[0], work->forest->canopy_light_scale[1]},
    };
    push->columns = (uint32_t)((int32_t)floor(work->high_m[0] / cell_m) - push->first_column + 1);
    push->rows = (uint32_t)((int32_t)floor(work->high_m[1] / cell_m) - push->first_row + 1);
}

/* Height of the ground over the foot so far off to a side, a unit vector; where there is none as low as that. */
static double rise_m(const struct wd_terrain *terrain, const int32_t foot_mm[3], const double toward[2], double way_m)
{
    double x_m = foot_mm[0] * 0.001 + way_m * toward[0], y_m = foot_mm[1] * 0.001 + way_m * toward[1];
    bool out = !wd_terrain_contains(terrain, x_m, y_m);
    return out ? 0 : (double)wd_terrain_height(terrain, x_m, y_m) - foot_mm[2] * 0.001;
}

/* `over_m`: of the place that looks, over the foot. */
static float slope_of(const struct wd_terrain *terrain, const int32_t foot_mm[3], float over_m, const double toward[2])
{
    static const double FIRST_M = 15, FARTHEST_M = 4000, NEXT = 1.25;
    double most = -1;
    for (double way_m = FIRST_M; way_m < FARTHEST_M; way_m *= NEXT)
        most = fmax(most, (rise_m(terrain, foot_mm, toward, way_m) - (double)over_m) / way_m);
    return (float)most;
}

static void look_round(struct wd_crown_sky_job *job, const struct wd_terrain *terrain, float over_m)
{
    for (size_t i = 0; i < WD_CROWN_SKY_BEARINGS; i++) {
        double bearing = (double)WD_CROWN_SKY_BEARING((float)i), toward[2] = {cos(bearing), sin(bearing)};
        double way_m = 0.5 * (double)(job->reach_m * (1 + WD_CROWN_SKY_NEXT));
        (i < 4 ? job->ground : job->ground_across)[i & 3] = slope_of(terrain, job->foot_mm, over_m, toward);
        for (size_t k = 0; k < WD_CROWN_SKY_STEPS; k++, way_m *= (double)WD_CROWN_SKY_NEXT)
            job->rise_m[i * WD_CROWN_SKY_STEPS + k] = (float)rise_m(terrain, job->foot_mm, toward, way_m);
    }
}

/* Neighbours that a job goes through, about: in dense stands little light comes from beyond these. */
enum { MOST_NEIGHBOURS = 64 };

/* How far neighbours reach that count. */
static float reach_of(const struct grid *grid, const struct wd_sky_crown *crowns, const uint32_t *first_of,
                      const int32_t foot_mm[3])
{
    enum { STEPS = 16 };
    const float most_m = WD_CROWN_SKY_REACH_M;
    uint32_t within[STEPS] = {0}, count = 0;
    int32_t low[2], high[2];
    for (int k = 0; k < 2; k++) {
        int32_t first = k ? grid->push.first_row : grid->push.first_column;
        int32_t most = (int32_t)(k ? grid->push.rows : grid->push.columns) - 1;
        float place_m = (float)foot_mm[k] * 0.001f;
        low[k] = WD_MAX((int32_t)floorf((place_m - most_m) / WD_CROWN_SKY_CELL_M) - first, 0);
        high[k] = WD_MIN((int32_t)floorf((place_m + most_m) / WD_CROWN_SKY_CELL_M) - first, most);
    }
    for (int32_t row = low[1]; row <= high[1]; row++) {
        const uint32_t *cells = first_of + (size_t)row * grid->push.columns;
        for (uint32_t i = cells[low[0]]; i < cells[high[0] + 1]; i++) {
            float x_m = (float)(crowns[i].foot_mm[0] - foot_mm[0]) * 0.001f;
            float y_m = (float)(crowns[i].foot_mm[1] - foot_mm[1]) * 0.001f;
            float step = (x_m * x_m + y_m * y_m) * ((float)STEPS / (most_m * most_m));
            if (step < STEPS)
                within[(int)step]++;
        }
    }
    for (int step = 0; step < STEPS; step++) {
        count += within[step];
        if (count > MOST_NEIGHBOURS)
            return most_m * sqrtf(fmaxf((float)step, 1) / STEPS);
    }
    return most_m;
}

static size_t cell_of(const struct grid *grid, const struct beside *tree)
{
    return (size_t)(tree->row - grid->push.first_row) * grid->push.columns +
           (size_t)(tree->column - grid->push.first_column);
}

/* Sorts the crowns by cells, those of a cell by record, and tells jobs where theirs have come. */
static void fill(const struct grid *grid, const struct work *work, struct wd_sky_crown *crowns, uint32_t *first_of,
                 struct wd_crown_sky_job *jobs)
{
    size_t cells = (size_t)grid->push.columns * grid->push.rows, job = 0;
    uint32_t *next = wd_alloc_array(cells + 1, sizeof *next);
    for (size_t i = 0; i < work->beside_count; i++)
        next[cell_of(grid, &work->beside[i]) + 1]++;
    for (size_t cell = 0; cell < cells; cell++)
        next[cell + 1] += next[cell];
    memcpy(first_of, next, (cells + 1) * sizeof *first_of);
    for (size_t i = 0; i < work->beside_count; i++) {
        uint32_t record = work->beside[i].record, at = next[cell_of(grid, &work->beside[i])]++;
        crowns[at] = crown_of(work, record);
        if (job < work->missing_count && work->missing[job].record == record) {
            const struct wd_tree *tree = tree_of(work, record);
            jobs[job] = (struct wd_crown_sky_job){.foot_mm = {tree->x_mm, tree->y_mm, tree->z_mm}, .crown = at,
                                                  .slot = work->missing[job].slot,
                                                  .radius_m = fmaxf(0.5f * WD_TREE_CROWN_M(*tree), 0.1f),
                                                  .top_m = fmaxf(WD_TREE_HEIGHT_M(*tree), 0.1f)};
            job++;
        }
    }
    free(next);
}

/* Of tiles: their middles and, of each, what its squares' middles lie over that. */
static void fill_floor(const struct work *work, struct wd_crown_sky_job *jobs, float (*rises_m)[TILE_SQUARES])
{
    const struct wd_terrain *terrain = &work->forest->world->terrain;
    for (size_t i = 0; i < work->tile_count; i++) {
        double middle_m[2];
        middle_of(&work->tiles[i], middle_m);
        double foot_m = (double)wd_terrain_height(terrain, middle_m[0], middle_m[1]);
        jobs[i] = (struct wd_crown_sky_job){
            .foot_mm = {(int32_t)lround(middle_m[0] * 1e3), (int32_t)lround(middle_m[1] * 1e3), (int32_t)lround(foot_m * 1e3)},
            .crown = WD_CROWN_SKY_NONE};
        for (int square = 0; square < TILE_SQUARES; square++) {
            double x_m = ((square % WD_FLOOR_SKY_TILE) + 0.5 - 0.5 * WD_FLOOR_SKY_TILE) * (double)WD_FLOOR_SKY_M;
            double y_m = ((square / WD_FLOOR_SKY_TILE) + 0.5 - 0.5 * WD_FLOOR_SKY_TILE) * (double)WD_FLOOR_SKY_M;
            rises_m[i][square] = wd_terrain_height(terrain, middle_m[0] + x_m, middle_m[1] + y_m) - (float)foot_m;
        }
    }
}

static void tell_heads(struct wd_crown_sky *sky, struct wd_cmd *cmd)
{
    struct wd_binding from;
    uint32_t *heads = wd_cmd_upload(cmd, SLOTS * sizeof *heads, &from);
    if (!heads)
        return;
    for (uint32_t i = 0; i < SLOTS; i++)
        heads[i] = sky->slots[i].record;
    wd_cmd_use_buffer(cmd, &sky->table, WD_USE_TRANSFER_WRITE);
    const VkBufferCopy region = {.srcOffset = from.offset, .size = SLOTS * sizeof *heads};
    vkCmdCopyBuffer(cmd->vk, from.buffer->buffer, sky->table.buffer, 1, &region);
    sky->told = true;
}

static void dispatch(struct wd_cmd *cmd, const struct wd_pipeline *pipeline, const struct grid *grid,
                     const struct wd_binding *bindings, size_t groups)
{
    if (!groups)
        return;
    wd_cmd_bind(cmd, pipeline, bindings);
    wd_cmd_push(cmd, pipeline, &grid->push, sizeof grid->push);
    wd_cmd_dispatch_1d(cmd, groups);
}

static void find_missing(struct work *work, struct wd_cmd *cmd)
{
    struct grid grid;
    walk(work, 0, is_beside, add_beside);
    lay_out(&grid, work);
    size_t cells = (size_t)grid.push.columns * grid.push.rows;
    struct wd_sky_crown *crowns = wd_cmd_upload(cmd, (work->beside_count + 1) * sizeof *crowns, &grid.crowns);
    uint32_t *first_of = wd_cmd_upload(cmd, (cells + 1) * sizeof *first_of, &grid.cells);
    size_t job_count = work->missing_count + work->tile_count;
    struct wd_crown_sky_job *jobs = wd_cmd_upload(cmd, job_count * sizeof *jobs, &grid.jobs);
    float(*rises_m)[TILE_SQUARES] = wd_cmd_upload(cmd, (work->tile_count + 1) * sizeof *rises_m, &grid.rises);
    if (!crowns || !first_of || !jobs || !rises_m)
        return;
    fill(&grid, work, crowns, first_of, jobs);
    fill_floor(work, jobs + work->missing_count, rises_m);
    for (size_t job = 0; job < job_count; job++)
        jobs[job].reach_m = reach_of(&grid, crowns, first_of, jobs[job].foot_mm);
    for (size_t job = 0; job < work->missing_count; job++)
        look_round(&jobs[job], &work->forest->world->terrain, crowns[jobs[job].crown].middle_m);
    wd_cmd_scope_begin(cmd, "sky of crowns");
    wd_cmd_use_buffer(cmd, &work->sky->table, WD_USE_COMPUTE_WRITE);
    const struct wd_binding bindings[] = {
        grid.crowns, grid.cells, grid.jobs,
        WD_BIND_IMAGE(&work->forest->canopy_light, work->forest->ground.sampler),
        WD_BIND_BUFFER(&work->sky->table), grid.rises};
    dispatch(cmd, &work->sky->crowns, &grid, bindings, (work->missing_count * WD_CROWN_SKY_PLACES + THREADS - 1) / THREADS);
    dispatch(cmd, &work->sky->floor, &grid, bindings, work->tile_count);
    wd_cmd_scope_end(cmd);
}

void wd_crown_sky_update(struct wd_crown_sky *sky, struct wd_cmd *cmd, const struct wd_forest_device *forest,
                         const struct wd_view *view)
{
    struct work work = {.sky = sky, .forest = forest, .view = view, .low_m = {INFINITY, INFINITY},
                        .high_m = {-INFINITY, -INFINITY}};
    if (cmd->failed || !prepare(sky, cmd, forest)) {
        cmd->failed = true;
        return;
    }
    sky->updates++;
    if (forest->world->octree.count) {
        walk(&work, 0, is_near, ask_if_large);
        if (wd_crown_sky_floor_m(forest, view) > 0)
            ask_for_floor(&work);
    }
    if (work.missing_count || !sky->told)
        tell_heads(sky, cmd);
    if (work.missing_count || work.tile_count)
        find_missing(&work, cmd);
    free(work.missing);
    free(work.beside);
    wd_cmd_use_buffer(cmd, &sky->table, WD_USE_COMPUTE_READ);
}
