#include "forest/forest.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "bake/growth_cache.h"
#include "base/jobs.h"
#include "base/memory.h"
#include "forest/canopy_light.h"
#include "forest/looks.h"
#include "forest/sky.h"
#include "shared/crown.h"
#include "tree/variant.h"
#include "world/cover.h"
#include "world/packed_trees.h"

/* Layers that seven bits can tell apart, inventories included. */
enum { MAX_FADES = 128, LEAST_CARD_BATCH = 1024 };

/* Everything made on the CPU before it is uploaded. */
struct preparation {
    struct wd_forest_device *forest;
    const struct wd_forest_device_params *params;
    struct wd_tree_model *grown; /* [model] */
    uint8_t *looks;              /* WD_LOOK_BYTES a species */
    atomic_bool failed;
};

/* --- growing ----------------------------------------------------------------------------- */

static void grow_model(void *user, size_t index)
{
    struct preparation *work = user;
    struct wd_forest_device *forest = work->forest;
    if (atomic_load(&work->failed))
        return;
    if (!wd_growth_get(&work->grown[index], &forest->model_keys[index], &forest->cache,
                       work->params->scene, (uint32_t)index, &forest->log.log))
        atomic_store(&work->failed, true);
}

static void make_look(void *user, size_t index)
{
    struct preparation *work = user;
    wd_look_get(work->looks + index * WD_LOOK_BYTES, &work->forest->cache,
                &work->params->scene->species[index]);
}

/* --- uploading --------------------------------------------------------------------------- */

static bool make_buffer(struct wd_buffer *buffer, struct wd_gpu *gpu, const char *name,
                        VkBufferUsageFlags usage, const void *data, size_t size)
{
    const struct wd_buffer_params params = {name, size, usage, WD_MEMORY_DEVICE};
    return wd_buffer_init(buffer, gpu, &params) && wd_buffer_upload(gpu, buffer, 0, data, size);
}

/* A table that shaders see whole. */
static bool make_table(struct wd_buffer *buffer, struct wd_gpu *gpu, const char *name,
                       const void *data, size_t size)
{
    uint32_t limit = gpu->properties.limits.maxStorageBufferRange;
    if (size > limit)
        return wd_error(gpu->log, "%s: %zu MB are more than the %u MB that %s can bind at once",
                        name, size >> 20, limit >> 20, gpu->properties.deviceName);
    return make_buffer(buffer, gpu, name, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, data, size);
}

/* Two triangles a card: corners 0 1 2, 2 1 3. */
static bool make_card_pattern(struct wd_forest_device *forest, struct wd_gpu *gpu)
{
    static const uint32_t corners[6] = {0, 1, 2, 2, 1, 3};
    VkDeviceSize trees = forest->trees.size / sizeof(struct wd_packed_tree);
    trees = trees < LEAST_CARD_BATCH ? LEAST_CARD_BATCH
                                     : trees < WD_CARD_BATCH ? trees : WD_CARD_BATCH;
    size_t cards = (size_t)trees * WD_CARD_VERTICES / 4;
    forest->quads_a_draw = (uint32_t)cards;
    uint32_t *indices = wd_alloc_array(cards * 6, sizeof *indices);
    for (size_t i = 0; i < cards * 6; i++)
        indices[i] = (uint32_t)(i / 6 * 4) + corners[i % 6];
    bool ok = make_buffer(&forest->card_indices, gpu, "card indices",
                          VK_BUFFER_USAGE_INDEX_BUFFER_BIT, indices, cards * 6 * sizeof *indices);
    free(indices);
    return ok;
}

/* What cards and view sets span, and the name of each model's content. */
static void describe_content(struct preparation *work, uint32_t index)
{
    struct wd_forest_device *forest = work->forest;
    const struct wd_tree_mesh *mesh = &work->grown[index].full;
    const struct wd_card_extent extent = wd_card_extent_of(mesh);
    struct wd_model *model = &forest->host_models[index];
    model->half_width_m = extent.half_width_m;
    model->half_depth_m = extent.half_depth_m;
    model->bottom_m = extent.bottom_m;
    model->top_m = extent.top_m;
    model->card_layer = WD_CARDS * index;
    forest->model_keys[index] =
        wd_cache_key(forest->model_keys[index],
                     work->looks + index / forest->variants * WD_LOOK_BYTES, WD_LOOK_HALF_BYTES);
}

/* --- the whole --------------------------------------------------------------------------- */

/* Pages follow the stored trees, a block each; they are filled when a view needs them. */
static bool make_trees(struct wd_forest_device *forest, struct wd_gpu *gpu)
{
    const struct wd_world *world = forest->world;
    size_t pages = wd_pages_capacity(gpu, world);
    size_t trees = pages ? wd_pages_first(world) + pages * WD_PAGE_TREES : world->tree_count;
    uint64_t size = wd_packed_count(trees ? trees : 1) * sizeof(struct wd_packed_tree);
    uint32_t limit = gpu->properties.limits.maxStorageBufferRange;
    const struct wd_buffer_params params = {"trees", size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                            WD_MEMORY_DEVICE, VK_FORMAT_R32G32B32A32_UINT};
    if (size > limit)
        return wd_error(gpu->log,
                        "trees: %llu MB are more than the %u MB that %s can bind at once; with "
                        "\"planting\": \"on_demand\" trees of grids take none",
                        (unsigned long long)(size >> 20), limit >> 20,
                        gpu->properties.deviceName);
    return wd_buffer_init(&forest->trees, gpu, &params);
}

/* The device's copy carries each tree's layer. */
static struct wd_packed_tree *pack_trees(const struct wd_forest_device *forest)
{
    const struct wd_world *world = forest->world;
    struct wd_packed_tree *packed =
        wd_alloc_array(wd_packed_count(world->tree_count), sizeof *packed);
    struct wd_tree *trees = wd_alloc_array(world->tree_count, sizeof *trees);
    for (size_t i = 0; i < world->tree_count; i++) {
        trees[i] = world->trees[i];
        trees[i].look = WD_TREE_LOOK_OF_LAYER(trees[i].look, wd_forest_fade_of(forest, i));
    }
    wd_trees_pack(packed, trees, world->tree_count, forest->variants);
    free(trees);
    return packed;
}

static bool upload_trees(struct wd_forest_device *forest, struct wd_gpu *gpu)
{
    const struct wd_world *world = forest->world;
    size_t species = forest->scene->species_file_count;
    if (!wd_packed_models_fit(species, forest->variants))
        return wd_error(gpu->log,
                        "%zu species of %u variants are more than %u models, which trees can have",
                        species, forest->variants, 1u << WD_MODEL_BITS);
    for (size_t i = 0; i < world->tree_count; i++)
        forest->max_tree_height_m =
            fmaxf(forest->max_tree_height_m, WD_TREE_HEIGHT_M(world->trees[i]));
    for (uint32_t i = 0; i < world->demand.count; i++)
        forest->max_tree_height_m =
            fmaxf(forest->max_tree_height_m, world->demand.layers[i].max_height_m);
    struct wd_packed_tree *trees = pack_trees(forest);
    bool ok = make_trees(forest, gpu) &&
              (world->tree_count == 0 ||
               wd_buffer_upload(gpu, &forest->trees, 0, trees,
                                wd_packed_count(world->tree_count) * sizeof *trees)) &&
              wd_pages_init(&forest->pages, gpu, world, &forest->ground, forest->variants);
    free(trees);
    return ok;
}

static bool upload_fades(struct wd_forest_device *forest, struct wd_gpu *gpu)
{
    size_t count = forest->scene->layer_count + 1;
    forest->host_fades = wd_alloc_array(count, sizeof *forest->host_fades);
    for (size_t i = 1; i < count; i++) {
        const struct wd_scene_layer *layer = &forest->scene->layers[i - 1];
        forest->host_fades[i] =
            (struct wd_layer_fade){(float)layer->fade_near_m[0], (float)layer->fade_near_m[1],
                                   (float)layer->fade_far_m[0], (float)layer->fade_far_m[1]};
    }
    return make_table(&forest->fades, gpu, "layer fades", forest->host_fades,
                      count * sizeof *forest->host_fades);
}

/* Leaves absorb what none of them reflects or lets through, and of what a crown stops it absorbs more, since
 * what they scatter meets others of it; each model counts by its area. */
static void set_leaf_scatter(struct preparation *work)
{
    struct wd_forest_device *forest = work->forest;
    double sum[3] = {0}, area = 0;
    for (uint32_t i = 0; i < forest->model_count; i++) {
        const struct wd_species *species = &forest->scene->species[i / forest->variants];
        double own = (double)work->grown[i].leaf_area_m2;
        for (int k = 0; k < 3; k++)
            sum[k] += own * (double)(species->leaf.color[k] + species->leaf.transmittance[k]);
        area += own;
    }
    for (int k = 0; k < 3 && area > 0; k++) {
        double leaf = fmin(sum[k] / area, 0.99);
        forest->leaf_scatter[k] = (float)sqrt((1 - leaf) / (1 - (double)WD_RECOLLISION * leaf));
    }
}

static bool make_canopy_light(struct preparation *work, struct wd_gpu *gpu)
{
    struct wd_forest_device *forest = work->forest;
    struct wd_canopy_field field;
    wd_canopy_field_init(&field, &(struct wd_canopy_field_params){
                                     .world = forest->world,
                                     .models = forest->host_models,
                                     .grown = work->grown,
                                     .variants = forest->variants,
                                     .threads = work->params->threads});
    for (int k = 0; k < 2; k++)
        forest->canopy_light_from_m[k] = (float)field.from_m[k];
    bool ok = wd_canopy_light_upload(&forest->canopy_light, forest->canopy_light_scale, gpu, &field);
    wd_canopy_field_finish(&field);
    set_leaf_scatter(work);
    return ok;
}

/* Leaf area over the ground that a layer is planted on, of one of its species: square metres a square metre. */
static double leaf_layers(const struct wd_scene_layer *layer, const struct wd_scene_share *species,
                          const struct wd_model *model, const struct wd_tree_model *grown)
{
    double shares = 0, tall = 0.5 * (double)(layer->height_m[0] + layer->height_m[1]);
    double wide = 0.5 * (double)(layer->aspect[0] + layer->aspect[1]), scale = tall / (double)model->height_m;
    double plants = layer->placement == WD_PLACE_CANOPY ? 1 : layer->density;
    for (size_t i = 0; i < layer->species_count; i++)
        shares += layer->species[i].share;
    double per_m2 = plants * species->share / (shares * layer->spacing_m * layer->spacing_m);
    return per_m2 * scale * scale * wide * wide * (double)grown->leaf_area_m2;
}

/* Grasses of a layer that is dense enough shade one another, however tall they are. */
static const double CLOSED_LAYERS = 0.5;

static bool closes_over_ground(const struct preparation *work, uint32_t index)
{
    const struct wd_scene *scene = work->params->scene;
    const struct wd_model *model = &work->forest->host_models[index];
    double layers = 0;
    for (size_t i = 0; i < scene->layer_count && model->roughness < 0; i++) {
        const struct wd_scene_layer *layer = &scene->layers[i];
        for (size_t k = 0; k < layer->species_count; k++) {
            const struct wd_scene_share *share = &layer->species[k];
            if (wd_scene_find_species(scene, share->name) == (int)(index / work->forest->variants))
                layers = fmax(layers, leaf_layers(layer, share, model, &work->grown[index]));
        }
    }
    return layers >= CLOSED_LAYERS;
}

static void set_roughness(struct wd_lit_leaves *leaves, float roughness)
{
    float rough_flat[2];
    wd_unpack_uv(leaves->rough_flat, rough_flat);
    leaves->rough_flat = wd_pack_uv(roughness, rough_flat[1]);
}

/* What wd_lit_leaves tells of grasses by its roughness: -1 less where they close over the ground; as of other
 * plants where none do, so that tufts stand free. */
static void tell_swards(struct wd_lit_model *lit, const struct preparation *work)
{
    const struct wd_model *models = work->forest->host_models;
    uint32_t count = work->forest->model_count;
    bool sward = false;
    for (uint32_t i = 0; i < count; i++) {
        bool closes = closes_over_ground(work, i);
        set_roughness(&lit[i].leaves, models[i].roughness - (closes ? 1.0f : 0.0f));
        sward |= closes;
    }
    for (uint32_t i = 0; i < count && !sward; i++)
        set_roughness(&lit[i].leaves, fabsf(models[i].roughness));
}

static bool make_lit_models(struct preparation *work, struct wd_gpu *gpu)
{
    struct wd_forest_device *forest = work->forest;
    size_t size = forest->model_count * sizeof(struct wd_lit_model);
    struct wd_lit_model *lit = wd_alloc_array(forest->model_count, sizeof *lit);
    for (uint32_t i = 0; i < forest->model_count; i++)
        wd_variant_describe_light(&lit[i], &forest->scene->species[i / forest->variants], &forest->host_models[i],
                                  &work->grown[i]);
    tell_swards(lit, work);
    const struct wd_buffer_params params = {.name = "light of models",
                                            .size = size,
                                            .memory = WD_MEMORY_DEVICE,
                                            .texels = VK_FORMAT_R32G32B32A32_UINT};
    bool ok = wd_buffer_init(&forest->lit_models, gpu, &params) &&
              wd_buffer_upload(gpu, &forest->lit_models, 0, lit, size);
    free(lit);
    return ok;
}

/* 0 of what stands on many thin stems or on none, and of artists' models, which may be clumps. */
static float find_stem_radius_m(const struct wd_scene *scene, uint32_t model, const struct wd_tree_model *grown)
{
    const struct wd_species species = wd_variant_species(scene, model);
    enum wd_species_form form = species.form;
    bool stem = form == WD_FORM_BROADLEAF || form == WD_FORM_CONIFER || form == WD_FORM_PALM || form == WD_FORM_SNAG;
    return stem && !species.imported ? 0.5f * grown->dbh_m : 0;
}

static bool prepare(struct preparation *work, struct wd_gpu *gpu)
{
    struct wd_forest_device *forest = work->forest;
    const struct wd_forest_device_params *params = work->params;
    wd_jobs_run(params->threads, params->scene->species_file_count, make_look, work);
    if (!wd_jobs_run_told(params->threads, forest->model_count, grow_model, work, params->progress,
                          "growing trees") ||
        atomic_load(&work->failed))
        return false;
    for (uint32_t i = 0; i < forest->model_count; i++) {
        wd_variant_describe(&forest->host_models[i], params->scene, i, &work->grown[i]);
        forest->crown_shades[i] = work->grown[i].shade;
        forest->stem_radii_m[i] = find_stem_radius_m(params->scene, i, &work->grown[i]);
        describe_content(work, i);
        forest->falls |= forest->host_models[i].fall_mps > 0.0f;
    }
    return wd_forest_meshes_init(&forest->meshes, gpu, work->grown, forest->model_count) &&
           make_table(&forest->models, gpu, "tree models", forest->host_models,
                      forest->model_count * sizeof *forest->host_models) &&
           make_lit_models(work, gpu) &&
           wd_looks_upload(&forest->looks, gpu, work->looks,
                           (uint32_t)params->scene->species_file_count) &&
           wd_look_details_upload(&forest->look_details, gpu, work->looks,
                                  (uint32_t)params->scene->species_file_count);
}

bool wd_forest_device_init(struct wd_forest_device *forest, struct wd_gpu *gpu,
                           const struct wd_forest_device_params *params)
{
    const struct wd_scene *scene = params->scene;
    *forest = (struct wd_forest_device){
        .scene = scene,
        .world = params->world,
        .leaf_scatter = {1, 1, 1},
        .variants = (uint32_t)scene->variants,
    };
    forest->model_count = (uint32_t)scene->species_file_count * forest->variants;
    size_t slots = forest->model_count ? forest->model_count : 1;
    forest->host_models = wd_alloc_array(slots, sizeof *forest->host_models);
    forest->crown_shades = wd_alloc_array(slots, sizeof *forest->crown_shades);
    forest->stem_radii_m = wd_alloc_array(slots, sizeof *forest->stem_radii_m);
    forest->model_keys = wd_alloc_array(slots, sizeof *forest->model_keys);
    forest->cache.directory = params->cache_dir ? wd_strdup(params->cache_dir) : NULL;
    wd_shared_log_init(&forest->log, params->log);
    forest->cache.log = &forest->log.log;
    struct preparation work = {
        .forest = forest,
        .params = params,
        .grown = wd_alloc_array(slots, sizeof *work.grown),
        .looks = wd_alloc_array(scene->species_file_count, WD_LOOK_BYTES),
    };
    bool ok = wd_ground_init(&forest->ground, gpu, params->world, params->log) &&
              upload_trees(forest, gpu) && upload_fades(forest, gpu) &&
              make_card_pattern(forest, gpu) &&
              wd_sampler_init(&forest->look_sampler, gpu, WD_SAMPLER_TRILINEAR_REPEAT) &&
              wd_sampler_init(&forest->card_sampler, gpu, WD_SAMPLER_MAGNIFY_CLAMP) &&
              wd_sampler_init(&forest->point_sampler, gpu, WD_SAMPLER_NEAREST_CLAMP) &&
              (forest->model_count == 0 || prepare(&work, gpu)) && make_canopy_light(&work, gpu) &&
              wd_sky_upload(&forest->sky, gpu, &params->world->sky);
    for (uint32_t i = 0; i < forest->model_count; i++)
        wd_tree_model_finish(&work.grown[i]);
    wd_transfer_drop_staging(gpu);
    free(work.grown);
    free(work.looks);
    if (!ok)
        wd_forest_device_finish(forest, gpu);
    return ok;
}

void wd_forest_device_finish(struct wd_forest_device *forest, struct wd_gpu *gpu)
{
    struct wd_buffer *buffers[] = {&forest->trees, &forest->models, &forest->lit_models, &forest->fades,
                                   &forest->card_indices};
    struct wd_image *images[] = {&forest->looks, &forest->look_details, &forest->card_albedo,
                                 &forest->card_normal, &forest->card_leaf,
                                 &forest->canopy_light, &forest->sky};
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; i++)
        wd_buffer_finish(buffers[i], gpu);
    for (size_t i = 0; i < sizeof images / sizeof *images; i++)
        wd_image_finish(images[i], gpu);
    wd_pages_finish(&forest->pages, gpu);
    wd_ground_finish(&forest->ground, gpu);
    wd_forest_meshes_finish(&forest->meshes, gpu);
    if (forest->look_sampler)
        vkDestroySampler(gpu->device, forest->look_sampler, NULL);
    if (forest->point_sampler)
        vkDestroySampler(gpu->device, forest->point_sampler, NULL);
    if (forest->card_sampler)
        vkDestroySampler(gpu->device, forest->card_sampler, NULL);
    free(forest->host_models);
    free(forest->crown_shades);
    free(forest->stem_radii_m);
    free(forest->model_keys);
    free((char *)forest->cache.directory);
    free(forest->host_fades);
    wd_shared_log_finish(&forest->log);
    *forest = (struct wd_forest_device){0};
}

void wd_forest_device_use(struct wd_forest_device *forest, struct wd_cmd *cmd)
{
    struct wd_buffer *tables[] = {&forest->trees, &forest->models, &forest->lit_models,
                                  &forest->fades};
    struct wd_image *images[] = {&forest->looks, &forest->look_details, &forest->card_albedo,
                                 &forest->card_normal, &forest->card_leaf,
                                 &forest->canopy_light, &forest->sky};
    for (size_t i = 0; i < sizeof tables / sizeof *tables; i++) {
        if (tables[i]->buffer)
            wd_cmd_use_buffer(cmd, tables[i], WD_USE_SHADER_READ);
    }
    if (forest->card_indices.buffer)
        wd_cmd_use_buffer(cmd, &forest->card_indices, WD_USE_INDEX);
    for (size_t i = 0; i < sizeof images / sizeof *images; i++) {
        if (images[i]->image)
            wd_cmd_use_image(cmd, images[i], WD_USE_SHADER_READ);
    }
    wd_ground_use(&forest->ground, cmd);
    wd_forest_meshes_use(&forest->meshes, cmd);
}

uint32_t wd_forest_fade_of(const struct wd_forest_device *forest, size_t tree)
{
    uint32_t layer = forest->world->layer_of_tree[tree];
    return layer < MAX_FADES - 1 && layer < forest->scene->layer_count ? layer + 1 : 0;
}

bool wd_forest_tree_at(const struct wd_forest_device *forest, uint32_t record, struct wd_tree *tree)
{
    if (record >= forest->world->tree_count)
        return wd_pages_tree(&forest->pages, record, tree);
    *tree = forest->world->trees[record];
    return true;
}

uint32_t wd_forest_model_of(const struct wd_forest_device *forest, const struct wd_tree *tree)
{
    uint32_t variant = WD_TREE_VARIANT(*tree) % forest->variants;
    return WD_TREE_SPECIES(*tree) * forest->variants + variant;
}
