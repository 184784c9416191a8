#include "bake/growth_cache.h"

#include <stdlib.h>
#include <string.h>

#include <meshoptimizer.h>

#include "base/memory.h"
#include "tree/clip_mesh.h"
#include "tree/coverage.h"
#include "tree/import.h"
#include "tree/sunlit.h"
#include "tree/thinning.h"

/* A kept model: words, then the wood of the full mesh, of the reduced one, its far stem and the two of the twig, each as
 * vertices and indices, then the leaves and the forms of their sets, packed by meshoptimizer's codecs
 * (the sequence codec keeps the order of indices). */
enum { MESHES = 5, MESH_WORDS = 6, BOUNDS = 14, GROWTHS = 2 * WD_GAIN_SIDES * WD_LEAF_GROWTHS,
       SUNLIT_AT = 7 + 7 + BOUNDS + GROWTHS + WD_GAIN_SIDES,
       SUNLIT = (int)(WD_SUNLIT_PLACES * WD_SUNLIT_KINDS),
       SKYLIT = (int)(WD_SKYLIT_PLACES * WD_SKYLIT_KINDS), SKYLIT_AT = SUNLIT_AT + SUNLIT + 2,
       CLOUD_WAX_AT = SKYLIT_AT + SKYLIT,
       NEAR_SHADE_AT = CLOUD_WAX_AT + 2, UPPER_AT = NEAR_SHADE_AT + 5,
       UPPER = (int)(WD_EYE_RINGS * WD_UPPER_KINDS), SHADE_AT = UPPER_AT + UPPER + 2 * (int)WD_EYE_RINGS,
       FIGURES = SHADE_AT + 5,
       SETS = 2 * WD_LEAF_SETS, SET_WORDS = 10, SET_AT = FIGURES + MESHES * MESH_WORDS,
       LEAVES = SET_AT + SETS * SET_WORDS, WORDS = LEAVES + 4 };
static const size_t MAX_MODEL_BYTES = (size_t)512 << 20;
static const uint32_t MAX_VERTICES = 1u << 26;

/* --- keys -------------------------------------------------------------------------------- */

/* What a volume holds that trees are cut to. */
static uint64_t clip_key(uint64_t key, const struct wd_clip_volume *clip)
{
    if (!clip)
        return key;
    key = wd_cache_key(key, clip->min_m, sizeof clip->min_m);
    key = wd_cache_key(key, clip->max_m, sizeof clip->max_m);
    key = wd_cache_key(key, clip->positions_m,
                       3 * (size_t)clip->vertex_count * sizeof *clip->positions_m);
    return wd_cache_key(key, clip->indices,
                        3 * (size_t)clip->triangle_count * sizeof *clip->indices);
}

uint64_t wd_species_key(const struct wd_species *species)
{
    struct wd_species values;
    if (species->model.file || species->imported)
        return 0;
    memcpy(&values, species, sizeof values);
    values.name = values.path = values.latin = values.citation = NULL;
    values.allometry.source = values.growth.source = NULL;
    values.habitat.region = NULL;
    values.orders = NULL;
    values.model.leaves = values.model.wood = NULL;
    values.clip_file = NULL;
    values.clip = NULL;
    values.planted_m[0] = values.planted_m[1] = 0; /* individuals are told their heights */
    values.when_young = values.in_the_open = 0;
    uint64_t key = wd_cache_key(wd_cache_code_key(), &values, sizeof values);
    key = clip_key(key, species->clip ? &species->clip->volume : NULL);
    for (size_t i = 0; i < species->order_count; i++)
        key = wd_cache_key(key, &species->orders[i], sizeof species->orders[i]);
    return key;
}

/* How an individual is grown. */
static uint64_t params_key(uint64_t key, const struct wd_grow_params *params)
{
    struct wd_grow_params values;
    memcpy(&values, params, sizeof values);
    values.clip = NULL;
    return clip_key(wd_cache_key(key, &values, sizeof values), params->clip);
}

/* What an imported mesh is, byte by byte. */
static uint64_t mesh_key(const struct wd_tree_mesh *mesh)
{
    uint64_t key = wd_cache_key(wd_cache_code_key(), mesh->vertices,
                                mesh->vertex_count * sizeof *mesh->vertices);
    key = wd_cache_key(key, mesh->indices, mesh->index_count * sizeof *mesh->indices);
    return wd_cache_key(key, &mesh->wood_index_count, sizeof mesh->wood_index_count);
}

/* And its pictures: the same mesh may be textured anew. */
static uint64_t import_key(const struct wd_tree_import *import)
{
    uint64_t key = mesh_key(&import->model.full);
    for (size_t i = 0; i < import->materials.picture_count; i++) {
        const struct wd_model_image *image = &import->materials.pictures[i].image;
        key = wd_cache_key(key, &image->width, sizeof image->width);
        key = wd_cache_key(key, image->rgba, (size_t)4 * image->width * image->height);
    }
    return key;
}

/* --- models ------------------------------------------------------------------------------ */

static void figures_of(float *figures[FIGURES], struct wd_tree_model *model)
{
    figures[0] = &model->height_m;
    figures[1] = &model->crown_radius_m;
    figures[2] = &model->crown_base_m;
    figures[3] = &model->dbh_m;
    figures[4] = &model->age_years;
    figures[5] = &model->leaf_area_m2;
    figures[6] = &model->spray_reach;
    for (size_t k = 0; k < 3; k++) {
        figures[7 + k] = &model->leaf_box.feet.least_m[k];
        figures[10 + k] = &model->leaf_box.feet.step_m[k];
    }
    figures[13] = &model->leaf_box.size_step_m;
    struct wd_tree_mesh *meshes[] = {&model->full, &model->reduced};
    for (size_t i = 0; i < BOUNDS; i++) {
        struct wd_tree_mesh *mesh = meshes[i / 7];
        figures[14 + i] = i % 7 == 6  ? &mesh->reach_m
                          : i % 7 < 3 ? &mesh->min_m[i % 7]
                                      : &mesh->max_m[i % 7 - 3];
    }
    for (size_t k = 0; k < GROWTHS; k++) {
        size_t side = k / WD_LEAF_GROWTHS;
        figures[14 + BOUNDS + k] =
            &model->leaf_growth[side / WD_GAIN_SIDES].of[side % WD_GAIN_SIDES][k % WD_LEAF_GROWTHS];
    }
    for (size_t k = 0; k < WD_GAIN_SIDES; k++)
        figures[14 + BOUNDS + GROWTHS + k] = &model->seen_m2[k];
    figures[SUNLIT_AT + SUNLIT] = &model->sun_curve[0];
    figures[SUNLIT_AT + SUNLIT + 1] = &model->sun_curve[1];
    for (size_t k = 0; k < SUNLIT; k++)
        figures[SUNLIT_AT + k] = &model->sunlit[k / WD_SUNLIT_KINDS][k % WD_SUNLIT_KINDS];
    for (size_t k = 0; k < 2; k++) {
        figures[CLOUD_WAX_AT + k] = &model->cloud_wax[k];
        figures[NEAR_SHADE_AT + k] = &model->near_shade[k];
    }
    figures[NEAR_SHADE_AT + 2] = &model->recollision;
    figures[NEAR_SHADE_AT + 3] = &model->low_sky;
    figures[NEAR_SHADE_AT + 4] = &model->flatness;
    for (size_t k = 0; k < UPPER; k++)
        figures[UPPER_AT + k] = &model->upper[k / WD_UPPER_KINDS][k % WD_UPPER_KINDS];
    for (size_t k = 0; k < WD_EYE_RINGS; k++) {
        figures[UPPER_AT + UPPER + k] = &model->wood_seen[k];
        figures[UPPER_AT + UPPER + WD_EYE_RINGS + k] = &model->stem_seen[k];
    }
    figures[SHADE_AT] = &model->shade.radius_m;
    figures[SHADE_AT + 1] = &model->shade.half_m;
    figures[SHADE_AT + 2] = &model->shade.middle_m;
    figures[SHADE_AT + 3] = &model->shade.per_m;
    figures[SHADE_AT + 4] = &model->shade.steeper;
    for (size_t k = 0; k < SKYLIT; k++)
        figures[SKYLIT_AT + k] = &model->skylit[k / WD_SKYLIT_KINDS][k % WD_SKYLIT_KINDS];
}

static void meshes_of(struct wd_tree_mesh *meshes[MESHES], struct wd_tree_model *model)
{
    meshes[0] = &model->full;
    meshes[1] = &model->reduced;
    meshes[2] = &model->far_stem;
    meshes[3] = &model->spray;
    meshes[4] = &model->spray_shade;
}

static uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static float float_of(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* A block that is being filled, or read. */
struct block {
    uint8_t *bytes;
    size_t used, size;
};

static size_t pack_vertices(struct block *block, const void *items, size_t count, size_t size)
{
    size_t bytes = meshopt_encodeVertexBuffer(block->bytes + block->used, block->size - block->used,
                                              items, count, size);
    block->used += bytes;
    return bytes;
}

static size_t pack_indices(struct block *block, const uint32_t *indices, size_t count)
{
    size_t bytes = meshopt_encodeIndexSequence(block->bytes + block->used,
                                               block->size - block->used, indices, count);
    block->used += bytes;
    return bytes;
}

/* What the next `bytes` hold; NULL where they are not `count` items. */
static void *unpack_vertices(struct block *block, size_t bytes, size_t count, size_t size)
{
    const size_t densest = 1024; /* bytes that one stands for: two bits at least are kept of 256 */
    if (count > MAX_VERTICES || block->size - block->used < bytes || count * size / densest > bytes)
        return NULL;
    void *items = wd_alloc_array(count + 1, size);
    if (meshopt_decodeVertexBuffer(items, count, size, block->bytes + block->used, bytes) != 0) {
        free(items);
        return NULL;
    }
    block->used += bytes;
    return items;
}

/* Likewise indices, which are below `below`. */
static uint32_t *unpack_indices(struct block *block, size_t bytes, size_t count, uint32_t below)
{
    if (count > bytes || block->size - block->used < bytes)
        return NULL;
    uint32_t *indices = wd_alloc_array(count + 1, sizeof *indices);
    bool ok = meshopt_decodeIndexSequence(indices, count, sizeof *indices,
                                          block->bytes + block->used, bytes) == 0;
    for (size_t i = 0; i < count && ok; i++)
        ok = indices[i] < below;
    block->used += bytes;
    if (ok)
        return indices;
    free(indices);
    return NULL;
}

/* A mesh, described at `words`. */
static void pack_mesh(struct block *block, uint8_t *words, const struct wd_tree_mesh *mesh)
{
    wd_cache_put_word(words, 0, mesh->vertex_count);
    wd_cache_put_word(words, 1, mesh->index_count);
    wd_cache_put_word(words, 2, mesh->wood_index_count);
    wd_cache_put_word(words, 5, mesh->stem_index_count);
    wd_cache_put_word(words, 3, (uint32_t)pack_vertices(block, mesh->vertices, mesh->vertex_count,
                                               sizeof *mesh->vertices));
    wd_cache_put_word(words, 4, (uint32_t)pack_indices(block, mesh->indices, mesh->index_count));
}

static bool unpack_mesh(struct wd_tree_mesh *mesh, const uint8_t *words, struct block *block)
{
    uint32_t vertices = wd_cache_get_word(words, 0), indices = wd_cache_get_word(words, 1);
    mesh->vertices = unpack_vertices(block, wd_cache_get_word(words, 3), vertices, sizeof *mesh->vertices);
    mesh->indices = mesh->vertices
                        ? unpack_indices(block, wd_cache_get_word(words, 4), indices, vertices)
                        : NULL;
    mesh->vertex_count = mesh->vertex_capacity = vertices;
    mesh->index_count = mesh->index_capacity = indices;
    mesh->wood_index_count = wd_cache_get_word(words, 2);
    mesh->stem_index_count = wd_cache_get_word(words, 5);
    return mesh->indices && mesh->wood_index_count <= indices && mesh->stem_index_count <= mesh->wood_index_count;
}

static void pack_set(struct block *block, uint8_t *words, const struct wd_leaf_set *set)
{
    wd_cache_put_word(words, 0, set->forms);
    wd_cache_put_word(words, 1, set->corner_count);
    wd_cache_put_word(words, 2, set->index_count);
    wd_cache_put_word(words, 3, set->leaf_count);
    wd_cache_put_word(words, 4, bits_of(set->own));
    wd_cache_put_word(words, 5, bits_of(set->arch_least));
    wd_cache_put_word(words, 6, bits_of(set->arch_range));
    wd_cache_put_word(words, 9, bits_of(set->grain));
    wd_cache_put_word(words, 7, (uint32_t)pack_vertices(block, set->corners,
                                               (size_t)set->forms * set->corner_count,
                                               sizeof *set->corners));
    wd_cache_put_word(words, 8, (uint32_t)pack_indices(block, set->indices, set->index_count));
}

static bool unpack_set(struct wd_leaf_set *set, const uint8_t *words, struct block *block,
                       uint32_t leaves)
{
    *set = (struct wd_leaf_set){
        .forms = wd_cache_get_word(words, 0),
        .corner_count = wd_cache_get_word(words, 1),
        .index_count = wd_cache_get_word(words, 2),
        .leaf_count = wd_cache_get_word(words, 3),
        .own = float_of(wd_cache_get_word(words, 4)),
        .arch_least = float_of(wd_cache_get_word(words, 5)),
        .arch_range = float_of(wd_cache_get_word(words, 6)),
        .grain = float_of(wd_cache_get_word(words, 9)),
    };
    if (set->forms > WD_LEAF_FORMS || set->corner_count > MAX_VERTICES || set->leaf_count > leaves ||
        (set->leaf_count && !set->forms))
        return false;
    set->corners = unpack_vertices(block, wd_cache_get_word(words, 7),
                                   (size_t)set->forms * set->corner_count, sizeof *set->corners);
    set->indices = set->corners ? unpack_indices(block, wd_cache_get_word(words, 8), set->index_count,
                                                 set->corner_count)
                                : NULL;
    return set->indices != NULL;
}

static size_t mesh_bound(size_t vertices, size_t size, size_t indices)
{
    return meshopt_encodeVertexBufferBound(vertices, size) +
           meshopt_encodeIndexSequenceBound(indices, vertices);
}

static size_t model_bound(struct wd_tree_model *model)
{
    struct wd_tree_mesh *meshes[MESHES];
    meshes_of(meshes, model);
    size_t bound = 4 * WORDS + meshopt_encodeVertexBufferBound(
                                   model->leaf_count + model->flower_count, sizeof *model->leaves);
    for (int i = 0; i < MESHES; i++)
        bound += mesh_bound(meshes[i]->vertex_count, sizeof *meshes[i]->vertices,
                            meshes[i]->index_count);
    for (int i = 0; i < SETS; i++) {
        const struct wd_leaf_set *set = &model->sets[i / WD_LEAF_SETS][i % WD_LEAF_SETS];
        bound += mesh_bound((size_t)set->forms * set->corner_count, sizeof *set->corners,
                            set->index_count);
    }
    return bound;
}

/* The model has no triangles of leaves. */
static void store_model(struct wd_bake_cache *cache, uint64_t key, struct wd_tree_model *model)
{
    struct wd_tree_mesh *meshes[MESHES];
    meshes_of(meshes, model);
    struct block block = {.used = 4 * WORDS, .size = model_bound(model)};
    block.bytes = wd_alloc(block.size);
    float *figures[FIGURES];
    figures_of(figures, model);
    for (size_t i = 0; i < FIGURES; i++)
        wd_cache_put_word(block.bytes, i, bits_of(*figures[i]));
    for (int i = 0; i < MESHES; i++)
        pack_mesh(&block, block.bytes + 4 * (FIGURES + i * MESH_WORDS), meshes[i]);
    wd_cache_put_word(block.bytes, LEAVES, model->leaf_count);
    wd_cache_put_word(block.bytes, LEAVES + 1, model->flower_count);
    wd_cache_put_word(block.bytes, LEAVES + 3, model->spray_forms);
    wd_cache_put_word(block.bytes, LEAVES + 2,
             (uint32_t)pack_vertices(&block, model->leaves, model->leaf_count + model->flower_count,
                                     sizeof *model->leaves));
    for (int i = 0; i < SETS; i++)
        pack_set(&block, block.bytes + 4 * (SET_AT + i * SET_WORDS),
                 &model->sets[i / WD_LEAF_SETS][i % WD_LEAF_SETS]);
    wd_cache_store(cache, "growth", key, block.bytes, block.used);
    free(block.bytes);
}

/* Whether a mesh can hold so many forms one after another. */
static bool forms_fit(const struct wd_tree_mesh *mesh, uint32_t forms)
{
    if (forms == 0 || forms > WD_LEAF_FORMS)
        return forms == 0 && mesh->index_count == 0;
    uint32_t vertices = mesh->vertex_count / forms, indices = mesh->index_count / forms;
    bool ok = vertices * forms == mesh->vertex_count && indices * forms == mesh->index_count && indices % 3 == 0;
    for (uint32_t i = 0; i < mesh->index_count && ok; i++)
        ok = mesh->indices[i] / vertices == i / indices;
    return ok;
}

static bool unpack_leaves(struct wd_tree_model *model, struct block *block)
{
    const uint8_t *words = block->bytes;
    uint32_t leaves = wd_cache_get_word(words, LEAVES), flowers = wd_cache_get_word(words, LEAVES + 1);
    if (leaves > MAX_VERTICES || flowers > MAX_VERTICES)
        return false;
    model->leaves = unpack_vertices(block, wd_cache_get_word(words, LEAVES + 2), leaves + flowers,
                                    sizeof *model->leaves);
    model->leaf_count = leaves;
    model->flower_count = flowers;
    model->spray_forms = wd_cache_get_word(words, LEAVES + 3);
    bool ok = model->leaves && forms_fit(&model->spray, model->spray_forms) &&
              forms_fit(&model->spray_shade, model->spray_forms);
    for (int i = 0; i < SETS && ok; i++)
        ok = unpack_set(&model->sets[i / WD_LEAF_SETS][i % WD_LEAF_SETS],
                        words + 4 * (SET_AT + i * SET_WORDS), block,
                        i % WD_LEAF_SETS == WD_SET_FLOWERS ? flowers : leaves);
    return ok;
}

static bool load_model(struct wd_tree_model *model, struct wd_bake_cache *cache, uint64_t key)
{
    struct block block = {.used = 4 * WORDS};
    block.bytes = wd_cache_load(cache, "growth", key, MAX_MODEL_BYTES, &block.size);
    *model = (struct wd_tree_model){0};
    bool ok = block.bytes && block.size >= block.used;
    if (ok) {
        float *figures[FIGURES];
        figures_of(figures, model);
        for (size_t i = 0; i < FIGURES; i++)
            *figures[i] = float_of(wd_cache_get_word(block.bytes, i));
        struct wd_tree_mesh *meshes[MESHES];
        meshes_of(meshes, model);
        for (int i = 0; i < MESHES && ok; i++)
            ok = unpack_mesh(meshes[i], block.bytes + 4 * (FIGURES + i * MESH_WORDS), &block);
        ok = ok && unpack_leaves(model, &block);
        if (ok) {
            wd_tree_mesh_update_bounds(&model->far_stem);
            wd_tree_mesh_update_bounds(&model->spray);
            wd_tree_mesh_update_bounds(&model->spray_shade);
        }
    }
    free(block.bytes);
    if (!ok)
        wd_tree_model_finish(model);
    return ok;
}

static void fit_model(struct wd_tree_model *model)
{
    wd_tree_thinning_fit(model);
    wd_tree_mesh_measure_seen(model->seen_m2, &model->full);
    model->shade = wd_crown_shade_of(&model->full);
    wd_tree_sunlit_fit(model);
}

/* Of imported models the file is read anew; what is fitted to its mesh is kept. */
static void fit_import(struct wd_tree_model *model, struct wd_bake_cache *cache)
{
    const uint64_t key = mesh_key(&model->full);
    uint8_t block[4 * FIGURES];
    float *figures[FIGURES];
    size_t found = 0;
    uint8_t *kept = wd_cache_load(cache, "fits", key, sizeof block, &found);
    figures_of(figures, model);
    if (found == sizeof block)
        for (size_t i = 0; i < FIGURES; i++)
            *figures[i] = float_of(wd_cache_get_word(kept, i));
    else {
        fit_model(model);
        for (size_t i = 0; i < FIGURES; i++)
            wd_cache_put_word(block, i, bits_of(*figures[i]));
        wd_cache_store(cache, "fits", key, block, sizeof block);
    }
    free(kept);
}

bool wd_growth_get(struct wd_tree_model *model, uint64_t *key, struct wd_bake_cache *cache,
                   const struct wd_scene *scene, uint32_t index, const struct wd_log *log)
{
    const struct wd_species grown = wd_variant_species(scene, index);
    uint64_t species = wd_species_key(&grown);
    const struct wd_grow_params params = wd_variant_params(scene, index);
    *key = params_key(species, &params);
    if (species && load_model(model, cache, *key))
        return true;
    if (!wd_variant_grow(model, scene, index, log))
        return false;
    if (!species) {
        *key = import_key(grown.imported);
        fit_import(model, cache);
        return true;
    }
    fit_model(model);
    wd_tree_model_drop_leaves(model);
    store_model(cache, *key, model);
    return true;
}

/* --- looks ------------------------------------------------------------------------------- */

bool wd_looks_load(uint8_t *looks, size_t size, struct wd_bake_cache *cache,
                   const struct wd_species *species)
{
    uint64_t key = wd_species_key(species);
    size_t found;
    uint8_t *block = key ? wd_cache_load(cache, "looks", key, size, &found) : NULL;
    bool ok = block && found == size;
    if (ok)
        memcpy(looks, block, size);
    free(block);
    return ok;
}

void wd_looks_store(const uint8_t *looks, size_t size, struct wd_bake_cache *cache,
                    const struct wd_species *species)
{
    uint64_t key = wd_species_key(species);
    if (key)
        wd_cache_store(cache, "looks", key, looks, size);
}
