#include "bake/growth_cache.h"

#include <stdlib.h>
#include <string.h>

#include <meshoptimizer.h>

#include "base/memory.h"

/* A kept model: words, then for the full mesh, the reduced one and the twig its vertices and its
 * indices, then the leaves, packed by meshoptimizer's codecs (the sequence codec keeps the order of
 * indices). */
enum { MESHES = 3, MESH_WORDS = 5, FIGURES = 7, LEAVES = FIGURES + MESHES * MESH_WORDS,
       WORDS = LEAVES + 2 };
static const size_t MAX_MODEL_BYTES = (size_t)512 << 20;
static const uint32_t MAX_VERTICES = 1u << 26;

/* --- keys -------------------------------------------------------------------------------- */

uint64_t wd_species_key(const struct wd_species *species)
{
    struct wd_species values;
    if (species->model.file || species->imported)
        return 0;
    memcpy(&values, species, sizeof values);
    values.name = values.latin = values.citation = NULL;
    values.allometry.source = values.growth.source = NULL;
    values.habitat.region = NULL;
    values.orders = NULL;
    values.model.leaves = values.model.wood = NULL;
    uint64_t key = wd_cache_key(wd_cache_code_key(), &values, sizeof values);
    for (size_t i = 0; i < species->order_count; i++)
        key = wd_cache_key(key, &species->orders[i], sizeof species->orders[i]);
    return key;
}

/* How an individual is grown; of a volume that it is cut to, what that holds. */
static uint64_t params_key(uint64_t key, const struct wd_grow_params *params)
{
    struct wd_grow_params values;
    memcpy(&values, params, sizeof values);
    values.clip = NULL;
    key = wd_cache_key(key, &values, sizeof values);
    const struct wd_clip_volume *clip = params->clip;
    if (!clip)
        return key;
    key = wd_cache_key(key, clip->min_m, sizeof clip->min_m);
    key = wd_cache_key(key, clip->max_m, sizeof clip->max_m);
    key = wd_cache_key(key, clip->positions_m,
                       3 * (size_t)clip->vertex_count * sizeof *clip->positions_m);
    return wd_cache_key(key, clip->indices,
                        3 * (size_t)clip->triangle_count * sizeof *clip->indices);
}

/* What an imported mesh is, byte by byte. */
static uint64_t mesh_key(const struct wd_tree_mesh *mesh)
{
    uint64_t key = wd_cache_key(wd_cache_code_key(), mesh->vertices,
                                mesh->vertex_count * sizeof *mesh->vertices);
    key = wd_cache_key(key, mesh->indices, mesh->index_count * sizeof *mesh->indices);
    return wd_cache_key(key, &mesh->wood_index_count, sizeof mesh->wood_index_count);
}

/* --- models ------------------------------------------------------------------------------ */

static void put_word(uint8_t *words, size_t at, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        words[4 * at + (size_t)i] = (uint8_t)(value >> (8 * i));
}

static uint32_t get_word(const uint8_t *words, size_t at)
{
    uint32_t value = 0;
    for (int i = 0; i < 4; i++)
        value |= (uint32_t)words[4 * at + (size_t)i] << (8 * i);
    return value;
}

static void figures_of(float *figures[FIGURES], struct wd_tree_model *model)
{
    figures[0] = &model->height_m;
    figures[1] = &model->crown_radius_m;
    figures[2] = &model->crown_base_m;
    figures[3] = &model->dbh_m;
    figures[4] = &model->age_years;
    figures[5] = &model->leaf_area_m2;
    figures[6] = &model->spray_reach;
}

static void meshes_of(struct wd_tree_mesh *meshes[MESHES], struct wd_tree_model *model)
{
    meshes[0] = &model->full;
    meshes[1] = &model->reduced;
    meshes[2] = &model->spray;
}

/* Appends a mesh to `block` and describes it at `words`. */
static size_t pack_mesh(uint8_t *block, size_t used, size_t capacity, uint8_t *words,
                        const struct wd_tree_mesh *mesh)
{
    size_t vertex_bytes = meshopt_encodeVertexBuffer(block + used, capacity - used, mesh->vertices,
                                                     mesh->vertex_count, sizeof *mesh->vertices);
    size_t index_bytes =
        meshopt_encodeIndexSequence(block + used + vertex_bytes, capacity - used - vertex_bytes,
                                    mesh->indices, mesh->index_count);
    put_word(words, 0, mesh->vertex_count);
    put_word(words, 1, mesh->index_count);
    put_word(words, 2, mesh->wood_index_count);
    put_word(words, 3, (uint32_t)vertex_bytes);
    put_word(words, 4, (uint32_t)index_bytes);
    return used + vertex_bytes + index_bytes;
}

static size_t mesh_bound(const struct wd_tree_mesh *mesh)
{
    return meshopt_encodeVertexBufferBound(mesh->vertex_count, sizeof *mesh->vertices) +
           meshopt_encodeIndexSequenceBound(mesh->index_count, mesh->vertex_count);
}

static void store_model(struct wd_bake_cache *cache, uint64_t key, struct wd_tree_model *model)
{
    struct wd_tree_mesh *meshes[MESHES];
    meshes_of(meshes, model);
    size_t used = 4 * WORDS;
    size_t capacity =
        used + meshopt_encodeVertexBufferBound(model->leaf_count, sizeof *model->leaves);
    for (int i = 0; i < MESHES; i++)
        capacity += mesh_bound(meshes[i]);
    uint8_t *block = wd_alloc(capacity);
    float *figures[FIGURES];
    figures_of(figures, model);
    for (size_t i = 0; i < FIGURES; i++) {
        uint32_t bits;
        memcpy(&bits, figures[i], sizeof bits);
        put_word(block, i, bits);
    }
    for (int i = 0; i < MESHES; i++)
        used = pack_mesh(block, used, capacity, block + 4 * (FIGURES + i * MESH_WORDS), meshes[i]);
    size_t leaf_bytes = meshopt_encodeVertexBuffer(block + used, capacity - used, model->leaves,
                                                   model->leaf_count, sizeof *model->leaves);
    put_word(block, LEAVES, model->leaf_count);
    put_word(block, LEAVES + 1, (uint32_t)leaf_bytes);
    used += leaf_bytes;
    wd_cache_store(cache, "growth", key, block, used);
    free(block);
}

/* False where the block holds anything else than a mesh. */
static bool unpack_mesh(struct wd_tree_mesh *mesh, const uint8_t *words, const uint8_t *block,
                        size_t size, size_t *used)
{
    uint32_t vertices = get_word(words, 0), indices = get_word(words, 1);
    size_t vertex_bytes = get_word(words, 3), index_bytes = get_word(words, 4);
    if (vertices > MAX_VERTICES || indices > 6 * MAX_VERTICES || size - *used < vertex_bytes ||
        size - *used - vertex_bytes < index_bytes)
        return false;
    *mesh = (struct wd_tree_mesh){
        .vertices = wd_alloc_array(vertices, sizeof *mesh->vertices),
        .indices = wd_alloc_array(indices, sizeof *mesh->indices),
        .vertex_count = vertices,
        .vertex_capacity = vertices,
        .index_count = indices,
        .index_capacity = indices,
        .wood_index_count = get_word(words, 2),
    };
    const uint8_t *at = block + *used;
    *used += vertex_bytes + index_bytes;
    bool ok = meshopt_decodeVertexBuffer(mesh->vertices, vertices, sizeof *mesh->vertices, at,
                                         vertex_bytes) == 0 &&
              meshopt_decodeIndexSequence(mesh->indices, indices, sizeof *mesh->indices,
                                          at + vertex_bytes, index_bytes) == 0;
    for (uint32_t i = 0; i < indices && ok; i++)
        ok = mesh->indices[i] < vertices;
    if (ok)
        wd_tree_mesh_update_bounds(mesh);
    return ok;
}

/* A model without leaves has no records; with them its full mesh names no others. */
static bool unpack_leaves(struct wd_tree_model *model, const uint8_t *block, size_t size,
                          size_t used)
{
    uint32_t count = get_word(block, LEAVES);
    size_t bytes = get_word(block, LEAVES + 1);
    if (count > MAX_VERTICES || size - used < bytes)
        return false;
    model->leaf_count = count;
    model->leaves = count ? wd_alloc_array(count, sizeof *model->leaves) : NULL;
    if (count && meshopt_decodeVertexBuffer(model->leaves, count, sizeof *model->leaves,
                                            block + used, bytes) != 0)
        return false;
    for (uint32_t i = 0; i < model->full.vertex_count && count; i++)
        if (model->full.vertices[i].kind >> WD_VERTEX_LEAF_SHIFT > count)
            return false;
    return true;
}

static bool load_model(struct wd_tree_model *model, struct wd_bake_cache *cache, uint64_t key)
{
    size_t size, used = 4 * WORDS;
    uint8_t *block = wd_cache_load(cache, "growth", key, MAX_MODEL_BYTES, &size);
    *model = (struct wd_tree_model){0};
    bool ok = block && size >= used;
    if (ok) {
        float *figures[FIGURES];
        figures_of(figures, model);
        for (size_t i = 0; i < FIGURES; i++) {
            uint32_t bits = get_word(block, i);
            memcpy(figures[i], &bits, sizeof bits);
        }
        struct wd_tree_mesh *meshes[MESHES];
        meshes_of(meshes, model);
        for (int i = 0; i < MESHES && ok; i++)
            ok = unpack_mesh(meshes[i], block + 4 * (FIGURES + i * MESH_WORDS), block, size, &used);
        ok = ok && unpack_leaves(model, block, size, used);
    }
    free(block);
    if (!ok)
        wd_tree_model_finish(model);
    return ok;
}

bool wd_growth_get(struct wd_tree_model *model, uint64_t *key, struct wd_bake_cache *cache,
                   const struct wd_scene *scene, uint32_t index, const struct wd_log *log)
{
    uint64_t species = wd_species_key(&scene->species[index / (uint32_t)scene->variants]);
    const struct wd_grow_params params = wd_variant_params(scene, index);
    *key = params_key(species, &params);
    if (species && load_model(model, cache, *key))
        return true;
    if (!wd_variant_grow(model, scene, index, log))
        return false;
    if (species)
        store_model(cache, *key, model);
    else
        *key = mesh_key(&model->full);
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
