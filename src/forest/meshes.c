#include "forest/meshes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "tree/leaf_spray.h"

/* The index list of all leaves with the same triangles. */
struct pattern {
    const struct wd_leaf_set *set; /* one that has them */
    uint32_t first_index, leaves;
};

/* What is brought to the device, on the host. Sizes are counted before anything is filled. */
struct building {
    struct wd_forest_meshes *meshes;
    const struct wd_tree_model *models;
    uint32_t count;
    size_t vertices, leaves, corners;
    size_t index_bytes;
    struct wd_packed_vertex *all_vertices;
    uint8_t *all_indices;
    struct wd_leaf_vertex *all_corners;
    struct pattern *patterns;
    size_t pattern_count, pattern_capacity;
};

static size_t aligned(size_t count)
{
    return (count + WD_MESH_ALIGNMENT - 1) / WD_MESH_ALIGNMENT * WD_MESH_ALIGNMENT;
}

/* Whether a model has the very meshes of the one before: variants of an imported tree. */
static bool repeats(const struct building *building, uint32_t index)
{
    const struct wd_tree_model *model = &building->models[index];
    return index > 0 && model->borrowed && model->full.vertices == model[-1].full.vertices;
}

static const struct wd_tree_mesh *level_mesh(const struct wd_tree_model *model, int level)
{
    return level == WD_LEVEL_MESH ? &model->full : &model->reduced;
}

/* --- layout ------------------------------------------------------------------------------ */

static struct wd_mesh_box bounds_of(const struct wd_tree_mesh *mesh)
{
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        for (int axis = 0; axis < 3; axis++) {
            low[axis] = fminf(low[axis], mesh->vertices[i].position_m[axis]);
            high[axis] = fmaxf(high[axis], mesh->vertices[i].position_m[axis]);
        }
    return mesh->vertex_count ? wd_mesh_box_of(low, high) : (struct wd_mesh_box){0};
}

static void place_mesh(struct building *building, struct wd_mesh_range *range,
                       const struct wd_tree_mesh *mesh)
{
    bool small = mesh->vertex_count <= 65536;
    size_t size = small ? sizeof(uint16_t) : sizeof(uint32_t);
    *range = (struct wd_mesh_range){
        .first_vertex = (uint32_t)building->vertices,
        .vertex_count = mesh->vertex_count,
        .first_index = (uint32_t)(building->index_bytes / size),
        .index_count = mesh->index_count,
        .wood_index_count = mesh->wood_index_count,
        .index_type = small ? VK_INDEX_TYPE_UINT16 : VK_INDEX_TYPE_UINT32,
        .box = bounds_of(mesh),
    };
    building->vertices += aligned(mesh->vertex_count);
    building->index_bytes += (mesh->index_count * size + 3) / 4 * 4;
}

static uint32_t bits_for(uint32_t corners)
{
    uint32_t bits = 0;
    while (1u << bits < corners)
        bits++;
    return bits;
}

/* The pattern of a set, which holds its leaves, or as many as one draw may. */
static size_t find_pattern(struct building *building, const struct wd_leaf_set *set)
{
    size_t i = 0;
    for (; i < building->pattern_count; i++) {
        const struct wd_leaf_set *other = building->patterns[i].set;
        if (other->corner_count == set->corner_count && other->index_count == set->index_count &&
            memcmp(other->indices, set->indices, set->index_count * sizeof *set->indices) == 0)
            break;
    }
    if (i == building->pattern_count)
        *wd_push(building->patterns, building->pattern_count, building->pattern_capacity) =
            (struct pattern){set, 0, 0};
    uint32_t most = WD_LEAF_DRAW_VERTICES >> bits_for(set->corner_count);
    uint32_t leaves = set->leaf_count < most ? set->leaf_count : most;
    struct pattern *pattern = &building->patterns[i];
    pattern->leaves = leaves > pattern->leaves ? leaves : pattern->leaves;
    return i;
}

/* Forms that the same set of the model before has, too, are kept once. */
static const struct wd_leaf_draw *same_forms(const struct building *building, uint32_t index,
                                             int level, int kind)
{
    if (index == 0)
        return NULL;
    const struct wd_leaf_set *set = &building->models[index].sets[level][kind];
    const struct wd_leaf_set *other = &building->models[index - 1].sets[level][kind];
    bool same = other->leaf_count && other->forms == set->forms &&
                other->corner_count == set->corner_count &&
                memcmp(other->corners, set->corners,
                       (size_t)set->forms * set->corner_count * sizeof *set->corners) == 0;
    return same ? &building->meshes->ranges[index - 1][level].sets[kind] : NULL;
}

static void place_set(struct building *building, uint32_t index, int level, int kind)
{
    const struct wd_tree_model *model = &building->models[index];
    const struct wd_leaf_set *set = &model->sets[level][kind];
    const struct wd_leaf_draw *same = same_forms(building, index, level, kind);
    building->meshes->ranges[index][level].sets[kind] = (struct wd_leaf_draw){
        .first_leaf = kind == WD_SET_FLOWERS ? model->leaf_count : 0,
        .leaf_count = set->leaf_count,
        .first_corner = same ? same->first_corner : (uint32_t)building->corners,
        .corner_count = set->corner_count,
        .forms = set->forms,
        .corner_bits = bits_for(set->corner_count),
        .first_index = set->leaf_count ? (uint32_t)find_pattern(building, set) : 0,
        .index_count = set->index_count,
        .own = set->own,
        .arch_least = set->arch_least,
        .arch_range = set->arch_range,
    };
    if (!same)
        building->corners += (size_t)set->forms * set->corner_count;
}

static float mean_leaf_m(const struct wd_tree_model *model)
{
    double sum = 0;
    for (uint32_t i = 0; i < model->leaf_count; i++)
        sum += (double)wd_leaf_size_m(model->leaves[i], model->leaf_box);
    return (float)(sum / (double)model->leaf_count);
}

/* How leaves of a model's meshes thin out with distance: fronds do not. */
static void describe_leaves(struct wd_mesh_range ranges[2], const struct wd_tree_model *model)
{
    struct wd_mesh_range *full = &ranges[WD_LEVEL_MESH], *reduced = &ranges[WD_LEVEL_REDUCED];
    if (!model->leaf_count || model->spray_forms != 1)
        return;
    full->leaf_count = model->leaf_count;
    float leaf_m = mean_leaf_m(model);
    full->leaf_m = leaf_m * model->sets[WD_LEVEL_MESH][WD_SET_LEAVES].grain;
    reduced->leaf_count = reduced->sets[WD_SET_LEAVES].leaf_count;
    if (reduced->leaf_count > 0)
        reduced->leaf_m =
            leaf_m * model->sets[WD_LEVEL_REDUCED][WD_SET_LEAVES].grain *
            sqrtf((float)full->leaf_count / (float)reduced->leaf_count);
}

static void place_model(struct building *building, uint32_t index)
{
    const struct wd_tree_model *model = &building->models[index];
    struct wd_forest_meshes *meshes = building->meshes;
    struct wd_twig_range *twig = &meshes->twigs[index];
    if (repeats(building, index)) {
        memcpy(meshes->ranges[index], meshes->ranges[index - 1], sizeof meshes->ranges[index]);
        *twig = twig[-1];
        return;
    }
    for (int level = 0; level < 2; level++) {
        place_mesh(building, &meshes->ranges[index][level], level_mesh(model, level));
        for (int kind = 0; kind < WD_LEAF_SETS; kind++)
            place_set(building, index, level, kind);
    }
    describe_leaves(meshes->ranges[index], model);
    place_mesh(building, &twig->mesh, &model->spray);
    place_mesh(building, &twig->shade, &model->spray_shade);
    twig->shade_grain = wd_leaf_spray_grain(&model->spray_shade);
    twig->first_leaf = (uint32_t)building->leaves;
    twig->leaf_count = model->leaf_count + model->flower_count;
    twig->box = model->leaf_box;
    twig->reach = model->spray_reach;
    twig->forms = model->spray_forms;
    building->leaves += aligned(twig->leaf_count);
}

static void place_patterns(struct building *building)
{
    for (size_t i = 0; i < building->pattern_count; i++) {
        struct pattern *pattern = &building->patterns[i];
        size_t indices = (size_t)pattern->leaves * pattern->set->index_count;
        pattern->first_index = (uint32_t)(building->index_bytes / sizeof(uint16_t));
        building->index_bytes += (indices * sizeof(uint16_t) + 3) / 4 * 4;
    }
    for (uint32_t i = 0; i < building->count; i++)
        for (int k = 0; k < 2 * WD_LEAF_SETS; k++) {
            struct wd_leaf_draw *draw =
                &building->meshes->ranges[i][k / WD_LEAF_SETS].sets[k % WD_LEAF_SETS];
            if (draw->leaf_count && !repeats(building, i))
                draw->first_index = building->patterns[draw->first_index].first_index;
        }
}

/* --- contents ---------------------------------------------------------------------------- */

static void fill_mesh(struct building *building, const struct wd_mesh_range *range,
                      const struct wd_tree_mesh *mesh)
{
    struct wd_packed_vertex *vertices = building->all_vertices + range->first_vertex;
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        vertices[i] = wd_vertex_pack(&mesh->vertices[i], &range->box);
    if (range->index_type == VK_INDEX_TYPE_UINT32) {
        memcpy(building->all_indices + (size_t)range->first_index * sizeof(uint32_t), mesh->indices,
               mesh->index_count * sizeof(uint32_t));
        return;
    }
    uint16_t *indices = (uint16_t *)(void *)building->all_indices + range->first_index;
    for (uint32_t i = 0; i < mesh->index_count; i++)
        indices[i] = (uint16_t)mesh->indices[i];
}

static void fill_model(struct building *building, uint32_t index)
{
    const struct wd_tree_model *model = &building->models[index];
    struct wd_forest_meshes *meshes = building->meshes;
    const struct wd_twig_range *twig = &meshes->twigs[index];
    for (int level = 0; level < 2; level++) {
        fill_mesh(building, &meshes->ranges[index][level], level_mesh(model, level));
        for (int kind = 0; kind < WD_LEAF_SETS; kind++) {
            const struct wd_leaf_set *set = &model->sets[level][kind];
            const struct wd_leaf_draw *draw = &meshes->ranges[index][level].sets[kind];
            if (set->leaf_count)
                memcpy(building->all_corners + draw->first_corner, set->corners,
                       (size_t)set->forms * set->corner_count * sizeof *set->corners);
        }
    }
    fill_mesh(building, &twig->mesh, &model->spray);
    fill_mesh(building, &twig->shade, &model->spray_shade);
    if (twig->leaf_count)
        memcpy(meshes->host_leaves + twig->first_leaf, model->leaves,
               twig->leaf_count * sizeof *model->leaves);
}

static void fill_pattern(struct building *building, const struct pattern *pattern)
{
    const struct wd_leaf_set *set = pattern->set;
    uint16_t *indices = (uint16_t *)(void *)building->all_indices + pattern->first_index;
    uint32_t bits = bits_for(set->corner_count);
    for (uint32_t leaf = 0; leaf < pattern->leaves; leaf++)
        for (uint32_t i = 0; i < set->index_count; i++)
            *indices++ = (uint16_t)(leaf << bits | set->indices[i]);
}

static bool upload(struct wd_buffer *buffer, struct wd_gpu *gpu, const char *name,
                   VkBufferUsageFlags usage, const void *data, size_t size)
{
    const struct wd_buffer_params params = {name, size, usage, WD_MEMORY_DEVICE};
    return wd_buffer_init(buffer, gpu, &params) && wd_buffer_upload(gpu, buffer, 0, data, size);
}

/* One element more than there are: buffers hold something. */
static bool upload_all(const struct building *building, struct wd_gpu *gpu)
{
    struct wd_forest_meshes *meshes = building->meshes;
    const VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    return upload(&meshes->vertices, gpu, "tree vertices", storage, building->all_vertices,
                  (building->vertices + 1) * sizeof *building->all_vertices) &&
           upload(&meshes->indices, gpu, "tree indices", VK_BUFFER_USAGE_INDEX_BUFFER_BIT,
                  building->all_indices, building->index_bytes + 4) &&
           upload(&meshes->leaves, gpu, "tree leaves", storage, meshes->host_leaves,
                  (building->leaves + 1) * sizeof *meshes->host_leaves) &&
           upload(&meshes->corners, gpu, "leaf forms", storage, building->all_corners,
                  (building->corners + 1) * sizeof *building->all_corners);
}

bool wd_forest_meshes_init(struct wd_forest_meshes *meshes, struct wd_gpu *gpu,
                           const struct wd_tree_model *models, uint32_t count)
{
    *meshes = (struct wd_forest_meshes){
        .ranges = wd_alloc_array(count + 1, sizeof *meshes->ranges),
        .twigs = wd_alloc_array(count + 1, sizeof *meshes->twigs),
    };
    struct building building = {.meshes = meshes, .models = models, .count = count};
    for (uint32_t i = 0; i < count; i++)
        place_model(&building, i);
    place_patterns(&building);
    building.all_vertices = wd_alloc_array(building.vertices + 1, sizeof *building.all_vertices);
    building.all_indices = wd_alloc(building.index_bytes + 4);
    building.all_corners = wd_alloc_array(building.corners + 1, sizeof *building.all_corners);
    meshes->host_leaves = wd_alloc_array(building.leaves + 1, sizeof *meshes->host_leaves);
    for (uint32_t i = 0; i < count; i++)
        if (!repeats(&building, i))
            fill_model(&building, i);
    for (size_t i = 0; i < building.pattern_count; i++)
        fill_pattern(&building, &building.patterns[i]);
    bool ok = upload_all(&building, gpu);
    free(building.all_vertices);
    free(building.all_indices);
    free(building.all_corners);
    free(building.patterns);
    if (!ok)
        wd_forest_meshes_finish(meshes, gpu);
    return ok;
}

void wd_forest_meshes_finish(struct wd_forest_meshes *meshes, struct wd_gpu *gpu)
{
    wd_buffer_finish(&meshes->vertices, gpu);
    wd_buffer_finish(&meshes->indices, gpu);
    wd_buffer_finish(&meshes->leaves, gpu);
    wd_buffer_finish(&meshes->corners, gpu);
    free(meshes->ranges);
    free(meshes->twigs);
    free(meshes->host_leaves);
    *meshes = (struct wd_forest_meshes){0};
}

void wd_forest_meshes_use(struct wd_forest_meshes *meshes, struct wd_cmd *cmd)
{
    if (!meshes->vertices.buffer)
        return;
    wd_cmd_use_buffer(cmd, &meshes->vertices, WD_USE_SHADER_READ);
    wd_cmd_use_buffer(cmd, &meshes->leaves, WD_USE_SHADER_READ);
    wd_cmd_use_buffer(cmd, &meshes->corners, WD_USE_SHADER_READ);
    wd_cmd_use_buffer(cmd, &meshes->indices, WD_USE_INDEX);
}
