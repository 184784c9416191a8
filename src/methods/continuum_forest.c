#include "methods/continuum_forest.h"

#include <assert.h>
#include <math.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "bake/splats.h"
#include "base/jobs.h"
#include "base/memory.h"
#include "forest/looks.h"
#include "forest/model_bakes.h"

#define WORD_IS(member, word)                                                                      \
    static_assert(offsetof(struct wd_splat_model, member) == sizeof(uint32_t) * (word), #member)
WORD_IS(wood, WD_WORD_WOOD_GAINS);
WORD_IS(leaf, WD_WORD_LEAF_GAINS);
WORD_IS(light, WD_WORD_LIGHT_GAINS);
WORD_IS(wood_light, WD_WORD_WOOD_LIGHT_GAINS);
WORD_IS(min_m, WD_WORD_MIN_M);
WORD_IS(extent_m, WD_WORD_EXTENT_M);
WORD_IS(leaf_area_m2, WD_WORD_LEAF_AREA_M2);
WORD_IS(wood_area_m2, WD_WORD_WOOD_AREA_M2);
WORD_IS(strata_top_m, WD_WORD_STRATA_TOP_M);
WORD_IS(lower_over_upper, WD_WORD_LOWER_OVER_UPPER);
WORD_IS(wood_falls, WD_WORD_WOOD_FALLS);
WORD_IS(grain, WD_WORD_GRAIN);
WORD_IS(finer, WD_WORD_FINER);
WORD_IS(wood_first, WD_WORD_WOOD_FIRST);
WORD_IS(wood_count, WD_WORD_WOOD_COUNT);
WORD_IS(wood_stem, WD_WORD_WOOD_STEM);
WORD_IS(wood_far_stem, WD_WORD_WOOD_FAR_STEM);
WORD_IS(leaf_past_bark, WD_WORD_LEAF_PAST_BARK);
WORD_IS(thin_share, WD_WORD_THIN_SHARE);
WORD_IS(thin_wood, WD_WORD_THIN_WOOD);
WORD_IS(bare_thin, WD_WORD_BARE_THIN);

/* --- clusters ---------------------------------------------------------------------------- */

struct gathering {
    const struct wd_octree *octree;
    const struct wd_tree *trees;
    struct wd_cluster *clusters;
    size_t count, capacity;
};

static int32_t mm_of(float m)
{
    return (int32_t)ceilf(1000 * m);
}

static void add_bounds(struct wd_cluster *cluster, const struct wd_tree *tree)
{
    const float height_m = WD_TREE_HEIGHT_M(*tree);
    const int32_t reach_mm = mm_of(WD_TREE_REACH_M(WD_TREE_CROWN_M(*tree), height_m));
    const int32_t low[3] = {tree->x_mm - reach_mm, tree->y_mm - reach_mm, tree->z_mm - mm_of(WD_TREE_BELOW_M)};
    const int32_t high[3] = {tree->x_mm + reach_mm, tree->y_mm + reach_mm, tree->z_mm + mm_of(WD_TREE_ABOVE_M(height_m))};
    for (int k = 0; k < 3; k++) {
        cluster->min_mm[k] = low[k] < cluster->min_mm[k] ? low[k] : cluster->min_mm[k];
        cluster->max_mm[k] = high[k] > cluster->max_mm[k] ? high[k] : cluster->max_mm[k];
    }
}

static void add_run(struct gathering *g, uint32_t begin, uint32_t end)
{
    for (uint32_t first = begin; first < end; first += WD_CLUSTER_TREES) {
        struct wd_cluster *cluster = wd_push(g->clusters, g->count, g->capacity);
        uint32_t left = end - first;
        cluster->first = first;
        cluster->count = left < WD_CLUSTER_TREES ? left : WD_CLUSTER_TREES;
        for (int k = 0; k < 3; k++) {
            cluster->min_mm[k] = INT32_MAX;
            cluster->max_mm[k] = INT32_MIN;
        }
        for (uint32_t i = 0; i < cluster->count; i++)
            add_bounds(cluster, &g->trees[first + i]);
    }
}

/* Small neighbours in the order share clusters. */
static void gather(struct gathering *g, uint32_t index)
{
    const struct wd_octant *octant = &g->octree->octants[index];
    if (octant->end - octant->begin <= WD_CLUSTER_TREES || octant->child_count == 0) {
        add_run(g, octant->begin, octant->end);
        return;
    }
    uint32_t begin = octant->begin, end = octant->own_end;
    for (uint32_t i = 0, child = octant->first_child; i < octant->child_count; i++) {
        const struct wd_octant *part = &g->octree->octants[child];
        if (part->end - begin > WD_CLUSTER_TREES) {
            add_run(g, begin, end);
            begin = part->begin;
            if (part->end - begin > WD_CLUSTER_TREES) {
                gather(g, child);
                begin = part->end;
            }
        }
        end = part->end;
        child = part->next_sibling;
    }
    add_run(g, begin, end);
}

uint32_t wd_clusters_make(struct wd_cluster **clusters, const struct wd_octree *octree,
                          const struct wd_tree *trees)
{
    struct gathering g = {.octree = octree, .trees = trees};
    if (octree->count)
        gather(&g, 0);
    *clusters = g.clusters;
    return (uint32_t)g.count;
}

/* --- splats ------------------------------------------------------------------------------ */

struct sampling {
    struct wd_forest_device *forest;
    const struct wd_log *log;
    struct wd_splats *splats; /* [model]; {0} until there */
    uint8_t *looks;           /* WD_LOOK_BYTES a species, where one of its models needs them */
    atomic_bool failed;
};

static void load_splats(void *user, size_t index)
{
    struct sampling *work = user;
    wd_splats_load(&work->splats[index], &work->forest->cache, work->forest->model_keys[index]);
}

static void make_look(void *user, size_t index)
{
    struct sampling *work = user;
    const struct wd_splats *models = work->splats + index * work->forest->variants;
    bool needed = false;
    for (uint32_t i = 0; i < work->forest->variants; i++)
        needed |= !models[i].splats;
    if (needed)
        wd_look_get(work->looks + index * WD_LOOK_BYTES, &work->forest->cache,
                    &work->forest->scene->species[index]);
}

static void sample_model(void *user, size_t index)
{
    struct sampling *work = user;
    struct wd_splats *splats = &work->splats[index];
    struct wd_tree_model model;
    if (splats->splats)
        return;
    if (!wd_forest_grow_model(&model, work->forest, (uint32_t)index, work->log)) {
        atomic_store(&work->failed, true);
        return;
    }
    const struct wd_point_look look = {
        work->looks + index / work->forest->variants * WD_LOOK_BYTES, WD_LOOK_SIZE};
    if (wd_splats_init(splats, &model, &look, work->log))
        wd_splats_store(splats, &work->forest->cache, work->forest->model_keys[index]);
    else
        atomic_store(&work->failed, true);
    wd_tree_model_finish(&model);
}

static bool make_buffer(struct wd_buffer *buffer, struct wd_gpu *gpu, const char *name,
                        const void *data, size_t size, VkFormat texels)
{
    const struct wd_buffer_params params = {name, size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                            WD_MEMORY_DEVICE, texels};
    return wd_buffer_init(buffer, gpu, &params) && wd_buffer_upload(gpu, buffer, 0, data, size);
}

/* A mesh of more triangles is worth its cost only where they are large on screen; that of a fern (some
 * 13,000) or a herb costs little by itself. */
static const float LARGE_MESH = 50000.0f, FINEST = 4.0f;

/* Of the full mesh: wood, leaves and flowers. Leaves in the air are no surface that discs could stand
 * for: as if each were a triangle twice as wide, they are drawn one by one up to twice as far. */
static void measure_grain(struct wd_splat_model *model, const struct wd_forest_device *forest,
                          uint32_t index)
{
    const struct wd_mesh_range *range = &forest->meshes.ranges[index][WD_LEVEL_MESH];
    size_t triangles = range->index_count / 3;
    for (int kind = 0; kind < WD_LEAF_SETS; kind++)
        triangles += (size_t)range->sets[kind].leaf_count * range->sets[kind].index_count / 3;
    float area_m2 = model->leaf_area_m2 + model->wood_area_m2;
    model->finer = fminf(fmaxf(LARGE_MESH / (float)(triangles ? triangles : 1), 1.0f), FINEST);
    if (forest->host_models[index].fall_mps > 0.0f) {
        area_m2 = 4.0f * model->leaf_area_m2;
        triangles = range->sets[WD_SET_LEAVES].leaf_count;
    }
    float side_m = sqrtf(area_m2 / (float)(triangles ? triangles : 1));
    model->grain = model->finer * side_m / forest->host_models[index].crown_m;
}

/* One of each stratum in turn, so that a window of all strata is one run of memory. */
static void deal_strata(void *to, const void *from, size_t size)
{
    for (size_t stratum = 0; stratum < WD_SPLAT_STRATA; stratum++) {
        for (size_t at = 0; at < WD_STRATUM_SPLATS; at++)
            memcpy((char *)to + (at * WD_SPLAT_STRATA + stratum) * size,
                   (const char *)from + (stratum * WD_STRATUM_SPLATS + at) * size, size);
    }
}

/* In rooms of a corner. */
static size_t wood_room(const struct wd_splat_model *model)
{
    return model->wood_corners + (model->wood_count + WD_WOOD_TRIANGLES - 1) / WD_WOOD_TRIANGLES;
}

/* The corners of each model, then its triangles. */
static bool upload_wood(struct wd_continuum_forest *own, struct wd_gpu *gpu,
                        const struct wd_splats *splats, struct wd_splat_model *headers,
                        uint32_t models)
{
    size_t room = 1, at = 0; /* never empty: a buffer must hold something */
    for (uint32_t i = 0; i < models; i++)
        room += wood_room(&splats[i].model);
    struct wd_splat_corner *wood = wd_alloc_array(room, sizeof *wood);
    for (uint32_t i = 0; i < models; i++) {
        const struct wd_splat_model *model = &splats[i].model;
        memcpy(wood + at, splats[i].corners, model->wood_corners * sizeof *wood);
        headers[i].wood_first = (uint32_t)at + model->wood_corners;
        memcpy(wood + headers[i].wood_first, splats[i].wood,
               model->wood_count * sizeof *splats[i].wood);
        at += wood_room(model);
    }
    bool ok = make_buffer(&own->wood, gpu, "splat wood", wood, room * sizeof *wood,
                          VK_FORMAT_R32G32B32A32_UINT);
    free(wood);
    return ok;
}

static bool upload_splats(struct wd_continuum_forest *own, struct wd_gpu *gpu,
                          const struct wd_splats *splats, uint32_t models)
{
    size_t count = (size_t)models * WD_SPLATS;
    struct wd_splat *all = wd_alloc_array(count, sizeof *all);
    uint32_t *looks = wd_alloc_array(count, sizeof *looks);
    uint32_t *lit = wd_alloc_array(count, sizeof *lit);
    struct wd_splat_model *headers = wd_alloc_array(models, sizeof *headers);
    for (size_t i = 0; i < models; i++) {
        deal_strata(all + i * WD_SPLATS, splats[i].splats, sizeof *all);
        deal_strata(looks + i * WD_SPLATS, splats[i].looks, sizeof *looks);
        deal_strata(lit + i * WD_SPLATS, splats[i].lit, sizeof *lit);
        headers[i] = splats[i].model;
    }
    bool ok = make_buffer(&own->splats, gpu, "splats", all, count * sizeof *all,
                          VK_FORMAT_R32G32_UINT) &&
              make_buffer(&own->looks, gpu, "splat looks", looks, count * sizeof *looks,
                          VK_FORMAT_R32_UINT) &&
              make_buffer(&own->lit, gpu, "splat lit", lit, count * sizeof *lit,
                          VK_FORMAT_R32_UINT) &&
              upload_wood(own, gpu, splats, headers, models) &&
              make_buffer(&own->models, gpu, "splat models", headers, models * sizeof *headers,
                          VK_FORMAT_R32_UINT);
    free(all);
    free(looks);
    free(lit);
    free(headers);
    return ok;
}

/* Grains of the models and the greatest of a stored tree. */
static void measure_grains(struct wd_continuum_forest *own, const struct wd_forest_device *forest,
                           struct wd_splats *splats)
{
    const struct wd_world *world = forest->world;
    own->grains = wd_alloc_array(forest->model_count, sizeof *own->grains);
    for (uint32_t i = 0; i < forest->model_count; i++) {
        measure_grain(&splats[i].model, forest, i);
        own->grains[i] = splats[i].model.grain;
    }
    for (size_t i = 0; i < world->tree_count; i++) {
        float share = own->grains[wd_forest_model_of(forest, &world->trees[i])];
        own->coarsest_m = fmaxf(own->coarsest_m, share * WD_TREE_CROWN_M(world->trees[i]));
    }
}

static void count_heights(struct wd_continuum_forest *own, const struct wd_world *world)
{
    for (size_t i = 0; i < world->tree_count; i++) {
        uint32_t steps = WD_TREE_HEIGHT_CM(world->trees[i]) / WD_HEIGHT_STEP_CM;
        own->taller[steps < WD_HEIGHT_STEPS ? steps : WD_HEIGHT_STEPS - 1]++;
    }
    for (size_t i = WD_HEIGHT_STEPS - 1; i > 0; i--)
        own->taller[i - 1] += own->taller[i];
}

static bool make_splats(struct wd_continuum_forest *own, struct wd_gpu *gpu,
                        struct wd_forest_device *forest)
{
    size_t species = forest->scene->species_file_count;
    struct sampling work = {
        .forest = forest,
        .log = &forest->log.log,
        .splats = wd_alloc_array(forest->model_count, sizeof *work.splats),
        .looks = wd_alloc_array(species, WD_LOOK_BYTES),
    };
    wd_jobs_run(gpu->threads, forest->model_count, load_splats, &work);
    wd_jobs_run(gpu->threads, species, make_look, &work);
    bool ok = wd_jobs_run_told(gpu->threads, forest->model_count, sample_model, &work, &forest->progress,
                               "making discs") &&
              !atomic_load(&work.failed);
    if (ok)
        measure_grains(own, forest, work.splats);
    ok = ok && upload_splats(own, gpu, work.splats, forest->model_count);
    for (uint32_t i = 0; i < forest->model_count; i++)
        wd_splats_finish(&work.splats[i]);
    free(work.splats);
    free(work.looks);
    return ok;
}

bool wd_continuum_forest_init(struct wd_continuum_forest *own, struct wd_gpu *gpu,
                              struct wd_forest_device *forest)
{
    *own = (struct wd_continuum_forest){0};
    struct wd_cluster *clusters;
    own->cluster_count = wd_clusters_make(&clusters, &forest->world->octree, forest->world->trees);
    count_heights(own, forest->world);
    size_t paged = (size_t)forest->pages.capacity * WD_PAGE_CLUSTERS;
    const struct wd_buffer_params params = {"clusters",
                                            (own->cluster_count + paged) * sizeof *clusters,
                                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, WD_MEMORY_DEVICE};
    bool ok = wd_buffer_init(&own->clusters, gpu, &params) &&
              (!own->cluster_count ||
               wd_buffer_upload(gpu, &own->clusters, 0, clusters,
                                own->cluster_count * sizeof *clusters)) &&
              make_splats(own, gpu, forest);
    free(clusters);
    if (!ok)
        wd_continuum_forest_finish(own, gpu);
    return ok;
}

void wd_continuum_forest_finish(struct wd_continuum_forest *own, struct wd_gpu *gpu)
{
    struct wd_buffer *buffers[] = {&own->clusters, &own->splats, &own->looks,
                                   &own->lit,      &own->wood,   &own->models};
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; i++)
        wd_buffer_finish(buffers[i], gpu);
    free(own->grains);
    *own = (struct wd_continuum_forest){0};
}
