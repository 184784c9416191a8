#include "forest/model_bakes.h"

#include <stdlib.h>

#include "bake/growth_cache.h"
#include "base/clock.h"
#include "base/jobs.h"
#include "base/memory.h"
#include "shared/mixed.h"

static const VkFormat formats[WD_PLANES] = {
    VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM};
static const char *const names[WD_PLANES] = {"albedo", "normal", "depth"};

static bool get_model(struct wd_tree_model *grown, struct wd_forest_device *forest, uint32_t model,
                      const struct wd_log *log, void (*add_leaves)(struct wd_tree_model *model))
{
    uint64_t key;
    if (!wd_growth_get(grown, &key, &forest->cache, forest->scene, model, log))
        return false;
    add_leaves(grown);
    return true;
}

bool wd_forest_grow_model(struct wd_tree_model *grown, struct wd_forest_device *forest,
                          uint32_t model, const struct wd_log *log)
{
    return get_model(grown, forest, model, log, wd_tree_model_add_leaves);
}

static bool upload_words(struct wd_buffer *buffer, struct wd_gpu *gpu, const char *name,
                         const void *data, size_t size)
{
    const struct wd_buffer_params params = {name, size, 0, WD_MEMORY_DEVICE, WD_BAKE_WORDS};
    return wd_buffer_init(buffer, gpu, &params) && wd_buffer_upload(gpu, buffer, 0, data, size);
}

/* A model's full mesh on the host, with every leaf as triangles in an order that suits bakers. */
static bool grow_mesh(struct wd_tree_model *grown, struct wd_forest_device *forest, uint32_t model,
                      const struct wd_log *log)
{
    return get_model(grown, forest, model, log, wd_tree_model_add_leaves_by_place);
}

/* And on the device: made for one bake. */
struct model_mesh {
    struct wd_buffer vertices, indices;
    struct wd_bake_mesh mesh;
};

static void finish_mesh(struct model_mesh *mesh, struct wd_gpu *gpu)
{
    wd_buffer_finish(&mesh->vertices, gpu);
    wd_buffer_finish(&mesh->indices, gpu);
}

/* To be finished also after a failure. */
static bool upload_mesh(struct model_mesh *mesh, struct wd_gpu *gpu,
                        struct wd_forest_device *forest, uint32_t model,
                        const struct wd_tree_mesh *full)
{
    mesh->mesh = (struct wd_bake_mesh){
        .vertices = &mesh->vertices,
        .indices = &mesh->indices,
        .index_count = full->index_count,
        .wood_index_count = full->wood_index_count,
        .looks = &forest->looks,
        .look_layer = forest->host_models[model].look_layer,
        .cut_out = forest->scene->species[model / forest->variants].imported ? 1 : 0,
    };
    return upload_words(&mesh->vertices, gpu, "model vertices", full->vertices,
                        full->vertex_count * sizeof *full->vertices) &&
           upload_words(&mesh->indices, gpu, "model indices", full->indices,
                        full->index_count * sizeof *full->indices);
}

static bool make_image(struct wd_image *image, struct wd_gpu *gpu, struct wd_image_params params)
{
    uint32_t most = gpu->properties.limits.maxImageArrayLayers;
    params.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
    params.view = WD_IMAGE_ARRAY;
    if (params.layers > most)
        return wd_error(gpu->log,
                        "pictures of trees need %u image layers, %s has %u: use fewer species or "
                        "variants",
                        params.layers, gpu->properties.deviceName, most);
    return wd_image_init(image, gpu, &params);
}

/* --- cards ------------------------------------------------------------------------------- */

/* Software devices unpack blocks of albedo, whose opacity is read for every card that a pixel may show, at 4%
 * of a frame: a fair price for a fourth of the memory. */
static struct wd_card_form card_form(const struct wd_gpu *gpu, enum wd_bake_parts parts,
                                     struct wd_image *images[WD_PLANES],
                                     enum wd_card_depth depth)
{
    bool blocks = gpu->features & WD_GPU_FEATURE_BLOCKS;
    struct wd_card_form form = {.parts = parts};
    for (int plane = 0; plane < WD_PLANES; plane++)
        form.planes[plane] = !images[plane]                      ? WD_CARD_NOTHING
                             : blocks && plane != WD_PLANE_DEPTH ? WD_CARD_BLOCKS
                                                                 : WD_CARD_TEXELS;
    if (images[WD_PLANE_DEPTH] && depth == WD_CARD_DEPTH_LEAVES)
        form.planes[WD_PLANE_DEPTH] = blocks ? WD_CARD_ALPHA_BLOCKS : WD_CARD_ALPHA;
    return form;
}

static VkFormat card_format(const struct wd_card_form *form, int plane)
{
    switch (form->planes[plane]) {
    case WD_CARD_BLOCKS:
        return plane == WD_PLANE_ALBEDO ? VK_FORMAT_BC3_SRGB_BLOCK : VK_FORMAT_BC3_UNORM_BLOCK;
    case WD_CARD_ALPHA: return VK_FORMAT_R8_UNORM;
    case WD_CARD_ALPHA_BLOCKS: return VK_FORMAT_BC4_UNORM_BLOCK;
    default: return formats[plane];
    }
}

static bool make_card_plane(struct wd_image *image, struct wd_gpu *gpu,
                            const struct wd_card_form *form, int plane, uint32_t models)
{
    uint32_t width, height, first = wd_card_first_mip(form, plane);
    wd_card_size(first, &width, &height);
    return make_image(image, gpu,
                      (struct wd_image_params){.name = names[plane],
                                               .format = card_format(form, plane),
                                               .width = width,
                                               .height = height,
                                               .layers = WD_CARDS * models,
                                               .mips = WD_CARD_MIPS - first});
}

/* A few models at a time: all that the processor does for them alone is done on several threads. */
enum { MODELS_AT_ONCE = 4 };
struct made_cards {
    struct wd_forest_device *forest;
    const struct wd_card_form *form;
    const struct wd_log *log;
    uint32_t first;
    struct {
        struct wd_cards cards;
        struct wd_tree_model grown;
        bool found, ready, baked; /* found: in the cache; ready: or grown */
    } models[MODELS_AT_ONCE];
};

static void prepare_cards(void *user, size_t i)
{
    struct made_cards *made = user;
    struct wd_forest_device *forest = made->forest;
    uint32_t index = made->first + (uint32_t)i;
    made->models[i].found = wd_cards_load(&made->models[i].cards, &forest->cache,
                                          forest->model_keys[index], made->form);
    made->models[i].ready = made->models[i].found ||
                            grow_mesh(&made->models[i].grown, forest, index, made->log);
}

/* The baker is made when the first model is not in the cache. */
static void bake_cards(struct made_cards *made, struct wd_gpu *gpu, struct wd_baker *baker,
                       uint32_t i)
{
    struct wd_tree_model *grown = &made->models[i].grown;
    const struct wd_model *model = &made->forest->host_models[made->first + i];
    const struct wd_card_extent extent = {model->half_width_m, model->half_depth_m,
                                          model->bottom_m, model->top_m};
    struct model_mesh mesh = {0};
    made->models[i].baked =
        (baker->gpu || wd_baker_init(baker, gpu, gpu->log)) &&
        upload_mesh(&mesh, gpu, made->forest, made->first + i, &grown->full) &&
        wd_cards_bake(&made->models[i].cards, baker, &mesh.mesh, &extent, made->form);
    finish_mesh(&mesh, gpu);
    wd_tree_model_finish(grown);
}

static void store_cards(void *user, size_t i)
{
    struct made_cards *made = user;
    if (made->models[i].baked)
        wd_cards_store(&made->models[i].cards, &made->forest->cache,
                       made->forest->model_keys[made->first + i]);
}

/* Models `first` up to `first` + `count`, at most MODELS_AT_ONCE. */
static bool make_cards(struct wd_forest_device *forest, struct wd_gpu *gpu, struct wd_baker *baker,
                       const struct wd_card_form *form, struct wd_image *images[WD_PLANES],
                       uint32_t first, uint32_t count)
{
    struct made_cards made = {forest, form, &forest->log.log, first, {{.found = false}}};
    bool ok = true;
    wd_jobs_run(gpu->threads, count, prepare_cards, &made);
    for (uint32_t i = 0; i < count && ok; i++) {
        ok = made.models[i].ready && wd_progress_report(&forest->progress, "baking trees",
                                                        first + i, forest->model_count);
        if (ok && !made.models[i].found)
            bake_cards(&made, gpu, baker, i);
        ok = ok && (made.models[i].found || made.models[i].baked);
    }
    wd_jobs_run(gpu->threads, count, store_cards, &made); /* also of one that was stopped half-way */
    for (uint32_t i = 0; i < count; i++) {
        if (form->parts == WD_BAKE_ALL)
            forest->host_models[first + i].mixed = made.models[i].cards.mixed;
        for (int k = 0; k < WD_PLANES && ok; k++)
            ok = !images[k] || wd_image_upload_layers(gpu, images[k], (first + i) * WD_CARDS,
                                                      WD_CARDS, made.models[i].cards.planes[k]);
        wd_cards_finish(&made.models[i].cards);
        wd_tree_model_finish(&made.models[i].grown);
    }
    return ok;
}

bool wd_forest_bake_cards(struct wd_forest_device *forest, struct wd_gpu *gpu,
                          enum wd_bake_parts parts, struct wd_image *images[WD_PLANES],
                          enum wd_card_depth depth)
{
    const struct wd_card_form form = card_form(gpu, parts, images, depth);
    struct wd_baker baker = {0};
    bool ok = true;
    for (int k = 0; k < WD_PLANES && ok; k++)
        ok = !images[k] || make_card_plane(images[k], gpu, &form, k, forest->model_count);
    for (uint32_t i = 0; i < forest->model_count && ok; i += MODELS_AT_ONCE) {
        uint32_t left = forest->model_count - i;
        ok = make_cards(forest, gpu, &baker, &form, images, i,
                        left < MODELS_AT_ONCE ? left : MODELS_AT_ONCE);
    }
    wd_baker_finish(&baker);
    return ok;
}

bool wd_forest_make_cards(struct wd_forest_device *forest, struct wd_gpu *gpu)
{
    struct wd_image *images[WD_PLANES] = {&forest->card_albedo, &forest->card_normal,
                                          &forest->card_leaf};
    if (forest->card_albedo.image || !forest->model_count)
        return true;
    size_t models = forest->model_count * sizeof *forest->host_models;
    bool ok = wd_forest_bake_cards(forest, gpu, WD_BAKE_ALL, images, WD_CARD_DEPTH_LEAVES) &&
              wd_buffer_upload(gpu, &forest->models, 0, forest->host_models, models);
    for (int k = 0; k < WD_PLANES && !ok; k++)
        wd_image_finish(images[k], gpu);
    wd_transfer_drop_staging(gpu);
    return ok;
}

/* --- view sets --------------------------------------------------------------------------- */

static struct wd_view_model view_model(const struct wd_forest_device *forest, uint32_t index,
                                       uint32_t variants)
{
    const struct wd_model *model = &forest->host_models[index];
    uint32_t species = index / forest->variants, variant = index % forest->variants;
    return (struct wd_view_model){model->half_width_m, model->bottom_m, model->top_m,
                                  species * variants + variant % variants, WD_MIXED_EVEN};
}

static bool upload_set(struct wd_view_sets *sets, struct wd_gpu *gpu, const struct wd_view_set *set)
{
    for (uint32_t mip = 0; mip < sets->atlas.mips; mip++) {
        uint32_t side = wd_view_layer_size(&sets->atlas, mip);
        for (int k = 0; k < WD_PLANES; k++)
            if (!wd_image_upload(gpu, &sets->planes[k], set->model.layer, mip,
                                 set->planes[k] + wd_view_mip_offset(&sets->atlas, mip),
                                 (size_t)4 * side * side))
                return false;
    }
    return true;
}

static bool get_set(struct wd_view_sets *sets, struct wd_gpu *gpu, struct wd_forest_device *forest,
                    struct wd_baker *baker, uint32_t index, const struct wd_view_set_params *params,
                    struct wd_view_model *model)
{
    const struct wd_view_set_name name = {&forest->cache, forest->model_keys[index], params, model};
    struct wd_view_set set = {0};
    bool ok = wd_view_set_load(&set, &sets->atlas, &name);
    if (!ok) {
        struct model_mesh mesh = {0};
        struct wd_tree_model grown = {0};
        ok = grow_mesh(&grown, forest, index, gpu->log) &&
             upload_mesh(&mesh, gpu, forest, index, &grown.full) &&
             wd_view_set_bake(&set, baker, &mesh.mesh, model, &sets->atlas, params);
        finish_mesh(&mesh, gpu);
        wd_tree_model_finish(&grown);
        if (ok)
            wd_view_set_store(&set, &name);
    }
    model->mixed = ok ? set.model.mixed : WD_MIXED_EVEN;
    ok = ok && upload_set(sets, gpu, &set);
    wd_view_set_finish(&set);
    return ok;
}

static bool fill_sets(struct wd_view_sets *sets, struct wd_gpu *gpu,
                      struct wd_forest_device *forest, const struct wd_view_set_params *views,
                      uint32_t variants, const struct wd_progress *progress)
{
    struct wd_baker baker;
    struct wd_view_model *models = wd_alloc_array(forest->model_count, sizeof *models);
    bool ok = wd_baker_init(&baker, gpu, gpu->log);
    for (uint32_t i = 0; i < forest->model_count && ok; i++) {
        models[i] = view_model(forest, i, variants);
        if (i % forest->variants < variants)
            ok = wd_progress_report(progress, "baking views", models[i].layer, sets->layers) &&
                 get_set(sets, gpu, forest, &baker, i, views, &models[i]);
        else
            models[i].mixed = models[i - i % forest->variants + i % forest->variants % variants].mixed;
    }
    size_t bytes = forest->model_count * sizeof *models;
    const struct wd_buffer_params params = {"view models", bytes,
                                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, WD_MEMORY_DEVICE};
    ok = ok && wd_buffer_init(&sets->models, gpu, &params) &&
         wd_buffer_upload(gpu, &sets->models, 0, models, bytes);
    wd_baker_finish(&baker);
    free(models);
    return ok;
}

bool wd_view_sets_init(struct wd_view_sets *sets, struct wd_gpu *gpu,
                       struct wd_forest_device *forest, const struct wd_view_sets_params *params)
{
    double start = wd_clock_s();
    struct wd_view_set_params views = params->views;
    uint32_t variants = params->variants ? params->variants : forest->variants;
    variants = variants < forest->variants ? variants : forest->variants;
    *sets = (struct wd_view_sets){.variants = variants,
                                  .layers = forest->model_count / forest->variants * variants};
    bool ok = wd_view_atlas_init(&sets->atlas, &views, gpu, gpu->log);
    for (int k = 0; k < WD_PLANES && ok; k++) {
        uint32_t side = wd_view_layer_size(&sets->atlas, 0);
        ok = make_image(&sets->planes[k], gpu,
                        (struct wd_image_params){.name = names[k],
                                                 .format = formats[k],
                                                 .width = side,
                                                 .height = side,
                                                 .layers = sets->layers ? sets->layers : 1,
                                                 .mips = sets->atlas.mips});
        sets->bytes += sets->planes[k].memory_size;
    }
    ok = ok && (!forest->model_count ||
                fill_sets(sets, gpu, forest, &views, variants, params->progress));
    sets->baked_us = (uint64_t)((wd_clock_s() - start) * 1e6);
    if (!ok)
        wd_view_sets_finish(sets, gpu);
    return ok;
}

void wd_view_sets_finish(struct wd_view_sets *sets, struct wd_gpu *gpu)
{
    for (int k = 0; k < WD_PLANES; k++)
        wd_image_finish(&sets->planes[k], gpu);
    wd_buffer_finish(&sets->models, gpu);
    *sets = (struct wd_view_sets){0};
}

void wd_view_sets_use(struct wd_view_sets *sets, struct wd_cmd *cmd)
{
    for (int k = 0; k < WD_PLANES; k++)
        if (sets->planes[k].image)
            wd_cmd_use_image(cmd, &sets->planes[k], WD_USE_SHADER_READ);
    if (sets->models.buffer)
        wd_cmd_use_buffer(cmd, &sets->models, WD_USE_SHADER_READ);
}
