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

enum { SLOTS = WD_CROWN_SKY_SETS * WD_CROWN_SKY_SLOTS, THREADS = 64 };

bool wd_crown_sky_init(struct wd_crown_sky *sky, struct wd_gpu *gpu)
{
    const VkDescriptorType buffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    const struct wd_compute_params params = {
        .shader = {crown_sky_comp, sizeof crown_sky_comp, "crown_sky_comp"},
        .bindings = {5, {buffer, buffer, buffer, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, buffer}},
        .push_size = sizeof(struct wd_crown_sky_push),
    };
    *sky = (struct wd_crown_sky){0};
    return wd_pipeline_init_compute(&sky->pipeline, gpu, &params);
}

void wd_crown_sky_drop_forest(struct wd_crown_sky *sky, struct wd_gpu *gpu)
{
    wd_buffer_finish(&sky->table, gpu);
    free(sky->slots);
    free(sky->per_m);
    sky->slots = NULL;
    sky->per_m = NULL;
    sky->told = false;
}

void wd_crown_sky_finish(struct wd_crown_sky *sky, struct wd_gpu *gpu)
{
    wd_crown_sky_drop_forest(sky, gpu);
    *sky = (struct wd_crown_sky){0};
}

void wd_crown_sky_forget(struct wd_crown_sky *sky)
{
    sky->told = false;
    if (sky->slots)
        memset(sky->slots, 0, SLOTS * sizeof *sky->slots);
}

/* --- extinction ---------------------------------------------------------------------------- */

/* Share of an ellipsoid's outline that it covers where the way through its middle has an optical depth: ways that go by
 * it at the share r of the outline's radius are sqrt(1 - r^2) as long. */
static double covered(double depth)
{
    if (depth < 1e-3)
        return depth * 2 / 3;
    return 1 - 2 * (1 - (1 + depth) * exp(-depth)) / (depth * depth);
}

static double depth_that_covers(double share)
{
    double low = 0, high = 40;
    for (int i = 0; i < 40; i++) {
        double middle = 0.5 * (low + high);
        *(covered(middle) < share ? &low : &high) = middle;
    }
    return low;
}

/* What a crown covers, seen from six elevations, tells how dense its ellipsoid is. */
static float extinction_of(const struct wd_model *model)
{
    enum { SINES = 6 };
    static const double MOST_COVERED = 0.985;
    double radius_m = fmax(0.5 * (double)model->crown_m, 0.05);
    double half_m = fmax(0.5 * (double)(model->height_m - model->crown_base_m), 0.05), sum = 0;
    for (int i = 0; i < SINES; i++) {
        double up = (i + 0.5) / SINES, level = sqrt(1 - up * up);
        double seen_m2 = (double)wd_tree_seen_m2(*model, 1, 1, (float)up);
        double outline_m2 = 3.14159265358979 * radius_m * hypot(radius_m * up, half_m * level);
        double middle_m = 2 / hypot(level / radius_m, up / half_m);
        sum += depth_that_covers(fmin(seen_m2 / outline_m2, MOST_COVERED)) / middle_m;
    }
    return (float)(sum / SINES);
}

static bool prepare(struct wd_crown_sky *sky, struct wd_cmd *cmd, const struct wd_forest_device *forest)
{
    uint64_t texels = forest->world->tree_count ? (uint64_t)SLOTS * WD_CROWN_SKY_TEXELS : 0;
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
    sky->per_m = wd_alloc_array(forest->model_count + 1, sizeof *sky->per_m);
    for (uint32_t i = 0; i < forest->model_count; i++)
        sky->per_m[i] = extinction_of(&forest->host_models[i]);
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
    for (int k = 0; k < 2; k++) {
        work->low_m[k] = fmin(work->low_m[k], place_m[k] - (double)WD_CROWN_SKY_REACH_M);
        work->high_m[k] = fmax(work->high_m[k], place_m[k] + (double)WD_CROWN_SKY_REACH_M);
    }
    *wd_push(work->missing, work->missing_count, work->missing_capacity) =
        (struct new_tree){record, (uint32_t)(oldest - work->sky->slots)};
}

/* How far off a box of the local frame is that the view may see; infinite: it does not. */
static float seen_m(const struct work *work, const float min_m[3], const float max_m[3])
{
    float min[3], max[3];
    for (int k = 0; k < 3; k++) {
        min[k] = (float)((double)min_m[k] - work->view->eye_m[k]);
        max[k] = (float)((double)max_m[k] - work->view->eye_m[k]);
    }
    float distance_m = wd_box_distance(min, max);
    bool out = distance_m > WD_CROWN_SKY_FAR_M || wd_frustum_box(&work->view->frustum, min, max) == WD_OUTSIDE;
    return out ? INFINITY : distance_m;
}

static void ask_if_large(struct work *work, uint32_t record)
{
    const struct wd_tree *tree = tree_of(work, record);
    float min_m[3], max_m[3], height_m = WD_TREE_HEIGHT_M(*tree);
    if (height_m < WD_HERB_M)
        return;
    wd_tree_bounds(tree, min_m, max_m);
    float away_m = seen_m(work, min_m, max_m);
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
    return seen_m(work, octant->min_m, octant->max_m) < INFINITY;
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
    const struct wd_model *model = &work->forest->host_models[index];
    struct wd_tree_pose pose = wd_tree_pose_of(*tree, *model);
    float base_m = model->crown_base_m * pose.up, height_m = WD_TREE_HEIGHT_M(*tree);
    return (struct wd_sky_crown){.foot_mm = {tree->x_mm, tree->y_mm, tree->z_mm},
                                 .radius_m = fmaxf(0.5f * WD_TREE_CROWN_M(*tree), 0.1f),
                                 .half_m = fmaxf(0.5f * (height_m - base_m), 0.1f),
                                 .middle_m = 0.5f * (height_m + base_m),
                                 .per_m = work->sky->per_m[index] / cbrtf(pose.across * pose.across * pose.up)};
}

/* --- recording ----------------------------------------------------------------------------- */

struct grid {
    struct wd_crown_sky_push push;
    struct wd_binding crowns, cells, jobs;
};

static void lay_out(struct grid *grid, const struct work *work)
{
    double cell_m = (double)WD_CROWN_SKY_CELL_M;
    struct wd_crown_sky_push *push = &grid->push;
    *push = (struct wd_crown_sky_push){
        .job_count = (uint32_t)work->missing_count,
        .first_column = (int32_t)floor(work->low_m[0] / cell_m),
        .first_row = (int32_t)floor(work->low_m[1] / cell_m),
        .canopy_from_m = {work->forest->canopy_light_from_m[0], work->forest->canopy_light_from_m[1]},
        .canopy_scale = {work->forest->canopy_light_scale[0], work->forest->canopy_light_scale[1]},
    };
    push->columns = (uint32_t)((int32_t)floor(work->high_m[0] / cell_m) - push->first_column + 1);
    push->rows = (uint32_t)((int32_t)floor(work->high_m[1] / cell_m) - push->first_row + 1);
}

/* Height of the ground over the foot so far off to a side, a unit vector; where there is none as low as that. */
static double rise_m(const struct wd_terrain *terrain, const struct wd_sky_crown *own, const double toward[2], double way_m)
{
    double x_m = own->foot_mm[0] * 0.001 + way_m * toward[0], y_m = own->foot_mm[1] * 0.001 + way_m * toward[1];
    bool out = !wd_terrain_contains(terrain, x_m, y_m);
    return out ? 0 : (double)wd_terrain_height(terrain, x_m, y_m) - own->foot_mm[2] * 0.001;
}

static float slope_of(const struct wd_terrain *terrain, const struct wd_sky_crown *own, const double toward[2])
{
    static const double FIRST_M = 15, FARTHEST_M = 4000, NEXT = 1.25;
    double most = -1;
    for (double way_m = FIRST_M; way_m < FARTHEST_M; way_m *= NEXT)
        most = fmax(most, (rise_m(terrain, own, toward, way_m) - (double)own->middle_m) / way_m);
    return (float)most;
}

static void look_round(struct wd_crown_sky_job *job, const struct wd_terrain *terrain, const struct wd_sky_crown *own)
{
    for (size_t i = 0; i < WD_CROWN_SKY_BEARINGS; i++) {
        double bearing = (double)WD_CROWN_SKY_BEARING((float)i), toward[2] = {cos(bearing), sin(bearing)};
        double way_m = 0.5 * (double)(job->reach_m * (1 + WD_CROWN_SKY_NEXT));
        (i < 4 ? job->ground : job->ground_across)[i & 3] = slope_of(terrain, own, toward);
        for (size_t k = 0; k < WD_CROWN_SKY_STEPS; k++, way_m *= (double)WD_CROWN_SKY_NEXT)
            job->rise_m[i * WD_CROWN_SKY_STEPS + k] = (float)rise_m(terrain, own, toward, way_m);
    }
}

/* Neighbours that a job goes through, about: in dense stands little light comes from beyond these. */
enum { MOST_NEIGHBOURS = 64 };

/* How far the neighbours of a crown reach that count. */
static float reach_of(const struct grid *grid, const struct wd_sky_crown *crowns, const uint32_t *first_of,
                      const struct wd_sky_crown *own)
{
    enum { STEPS = 16 };
    const float most_m = WD_CROWN_SKY_REACH_M;
    uint32_t within[STEPS] = {0}, count = 0;
    int32_t low[2], high[2];
    for (int k = 0; k < 2; k++) {
        int32_t first = k ? grid->push.first_row : grid->push.first_column;
        int32_t most = (int32_t)(k ? grid->push.rows : grid->push.columns) - 1;
        float place_m = (float)own->foot_mm[k] * 0.001f;
        low[k] = WD_MAX((int32_t)floorf((place_m - most_m) / WD_CROWN_SKY_CELL_M) - first, 0);
        high[k] = WD_MIN((int32_t)floorf((place_m + most_m) / WD_CROWN_SKY_CELL_M) - first, most);
    }
    for (int32_t row = low[1]; row <= high[1]; row++) {
        const uint32_t *cells = first_of + (size_t)row * grid->push.columns;
        for (uint32_t i = cells[low[0]]; i < cells[high[0] + 1]; i++) {
            float x_m = (float)(crowns[i].foot_mm[0] - own->foot_mm[0]) * 0.001f;
            float y_m = (float)(crowns[i].foot_mm[1] - own->foot_mm[1]) * 0.001f;
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
            jobs[job] = (struct wd_crown_sky_job){.crown = at, .slot = work->missing[job].slot};
            job++;
        }
    }
    for (job = 0; job < work->missing_count; job++) {
        const struct wd_sky_crown *own = &crowns[jobs[job].crown];
        jobs[job].reach_m = reach_of(grid, crowns, first_of, own);
        look_round(&jobs[job], &work->forest->world->terrain, own);
    }
    free(next);
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

static void find_missing(struct work *work, struct wd_cmd *cmd)
{
    struct grid grid;
    walk(work, 0, is_beside, add_beside);
    lay_out(&grid, work);
    size_t cells = (size_t)grid.push.columns * grid.push.rows;
    struct wd_sky_crown *crowns = wd_cmd_upload(cmd, work->beside_count * sizeof *crowns, &grid.crowns);
    uint32_t *first_of = wd_cmd_upload(cmd, (cells + 1) * sizeof *first_of, &grid.cells);
    struct wd_crown_sky_job *jobs = wd_cmd_upload(cmd, work->missing_count * sizeof *jobs, &grid.jobs);
    if (!crowns || !first_of || !jobs)
        return;
    fill(&grid, work, crowns, first_of, jobs);
    wd_cmd_scope_begin(cmd, "sky of crowns");
    wd_cmd_use_buffer(cmd, &work->sky->table, WD_USE_COMPUTE_WRITE);
    const struct wd_binding bindings[] = {
        grid.crowns, grid.cells, grid.jobs,
        WD_BIND_IMAGE(&work->forest->canopy_light, work->forest->ground.sampler),
        WD_BIND_BUFFER(&work->sky->table)};
    wd_cmd_bind(cmd, &work->sky->pipeline, bindings);
    wd_cmd_push(cmd, &work->sky->pipeline, &grid.push, sizeof grid.push);
    wd_cmd_dispatch_1d(cmd, (work->missing_count * WD_CROWN_SKY_PLACES + THREADS - 1) / THREADS);
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
    if (forest->world->octree.count)
        walk(&work, 0, is_near, ask_if_large);
    if (work.missing_count || !sky->told)
        tell_heads(sky, cmd);
    if (work.missing_count)
        find_missing(&work, cmd);
    free(work.missing);
    free(work.beside);
    wd_cmd_use_buffer(cmd, &sky->table, WD_USE_COMPUTE_READ);
}
