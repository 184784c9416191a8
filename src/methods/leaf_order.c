#include "methods/leaf_order.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "forest/model_bakes.h"
#include "tree/progressive.h"

/* The leaves of a full mesh. */
struct mesh {
    const struct wd_tree_vertex *vertices;
    uint32_t vertex_count;
    const uint32_t *indices;
    uint32_t index_count;
};

/* --- leaves ------------------------------------------------------------------------------ */

/* The least vertex of the part that `vertex` hangs together with, with the way to it shortened. */
static uint32_t root_of(uint32_t *parent, uint32_t vertex)
{
    while (parent[vertex] != vertex) {
        parent[vertex] = parent[parent[vertex]];
        vertex = parent[vertex];
    }
    return vertex;
}

static void join(uint32_t *parent, uint32_t a, uint32_t b)
{
    a = root_of(parent, a);
    b = root_of(parent, b);
    if (a < b)
        parent[b] = a;
    else
        parent[a] = b;
}

/* leaf_of[vertex], numbered in the order of the index list; UINT32_MAX for wood. */
static uint32_t find_leaves(uint32_t *leaf_of, const struct mesh *mesh)
{
    uint32_t *parent = wd_alloc_array(mesh->vertex_count, sizeof *parent), count = 0;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        parent[i] = i;
        leaf_of[i] = UINT32_MAX;
    }
    for (uint32_t i = 0; i + 2 < mesh->index_count; i += 3) {
        join(parent, mesh->indices[i], mesh->indices[i + 1]);
        join(parent, mesh->indices[i], mesh->indices[i + 2]);
    }
    for (uint32_t i = 0; i < mesh->index_count; i++) {
        uint32_t root = root_of(parent, mesh->indices[i]);
        if (leaf_of[root] == UINT32_MAX)
            leaf_of[root] = count++;
        leaf_of[mesh->indices[i]] = leaf_of[root];
    }
    free(parent);
    return count;
}

static void find_centers(struct wd_vec3 *centers, uint32_t leaf_count, const uint32_t *leaf_of,
                         const struct mesh *mesh)
{
    uint32_t *sums = wd_alloc_array(leaf_count, sizeof *sums);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        if (leaf_of[i] == UINT32_MAX)
            continue;
        const float *p = mesh->vertices[i].position_m;
        struct wd_vec3 *center = &centers[leaf_of[i]];
        float share = 1.0f / (float)++sums[leaf_of[i]];
        center->x += (p[0] - center->x) * share;
        center->y += (p[1] - center->y) * share;
        center->z += (p[2] - center->z) * share;
    }
    free(sums);
}

/* Index lists leaf by leaf in the order of their ranks. */
static void write_indices(uint32_t *indices, const struct mesh *mesh, const uint32_t *leaf_of,
                          const uint32_t *rank_of, uint32_t leaf_count)
{
    uint32_t *first = wd_alloc_array((size_t)leaf_count + 1, sizeof *first);
    for (uint32_t i = 0; i < mesh->index_count; i++)
        first[rank_of[leaf_of[mesh->indices[i]]] + 1]++;
    for (uint32_t i = 0; i < leaf_count; i++)
        first[i + 1] += first[i];
    for (uint32_t i = 0; i < mesh->index_count; i++)
        indices[first[rank_of[leaf_of[mesh->indices[i]]]]++] = mesh->indices[i];
    free(first);
}

static void order_mesh(uint32_t *indices, struct wd_leaf_place *places, const struct mesh *mesh,
                       uint32_t key)
{
    uint32_t *leaf_of = wd_alloc_array(mesh->vertex_count, sizeof *leaf_of);
    uint32_t leaf_count = find_leaves(leaf_of, mesh);
    struct wd_vec3 *centers = wd_alloc_array(leaf_count, sizeof *centers);
    uint32_t *order = wd_alloc_array(leaf_count, sizeof *order);
    uint32_t *rank_of = wd_alloc_array(leaf_count, sizeof *rank_of);
    find_centers(centers, leaf_count, leaf_of, mesh);
    wd_progressive_order(order, centers, leaf_count, key);
    for (uint32_t i = 0; i < leaf_count; i++)
        rank_of[order[i]] = i;
    write_indices(indices, mesh, leaf_of, rank_of, leaf_count);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        if (leaf_of[i] == UINT32_MAX)
            continue;
        const struct wd_vec3 *center = &centers[leaf_of[i]];
        places[i] = (struct wd_leaf_place){{center->x, center->y, center->z},
                                           (float)rank_of[leaf_of[i]] / (float)leaf_count};
    }
    free(leaf_of);
    free(centers);
    free(order);
    free(rank_of);
}

/* --- the whole --------------------------------------------------------------------------- */

static bool upload(struct wd_buffer *buffer, struct wd_gpu *gpu, const char *name,
                   VkBufferUsageFlags usage, const void *data, size_t size)
{
    const struct wd_buffer_params params = {name, size, usage, WD_MEMORY_DEVICE};
    return wd_buffer_init(buffer, gpu, &params) && wd_buffer_upload(gpu, buffer, 0, data, size);
}

/* The order of all models as it is gathered. */
struct gathering {
    struct wd_tree_vertex *vertices;
    struct wd_leaf_place *places;
    uint32_t *indices;
    size_t vertex_count, index_count;
};

/* Makes room for a mesh, and for one element where there is nothing. */
static void make_room(struct gathering *all, const struct mesh *mesh)
{
    size_t vertices = all->vertex_count + mesh->vertex_count + WD_MESH_ALIGNMENT;
    all->vertices = wd_realloc(all->vertices, vertices * sizeof *all->vertices);
    all->places = wd_realloc(all->places, vertices * sizeof *all->places);
    memset(all->places + all->vertex_count, 0,
           (vertices - all->vertex_count) * sizeof *all->places);
    memset(all->vertices + all->vertex_count, 0,
           (vertices - all->vertex_count) * sizeof *all->vertices);
    all->indices = wd_realloc(all->indices, (all->index_count + mesh->index_count + 1) *
                                                sizeof *all->indices);
    all->indices[all->index_count] = 0;
}

static void gather_model(struct gathering *all, struct wd_leaf_range *range,
                         const struct wd_tree_mesh *full, uint32_t model)
{
    const struct mesh mesh = {full->vertices, full->vertex_count,
                              full->indices + full->wood_index_count,
                              full->index_count - full->wood_index_count};
    make_room(all, &mesh);
    *range = (struct wd_leaf_range){(uint32_t)all->index_count, mesh.index_count,
                                    (uint32_t)all->vertex_count, mesh.vertex_count};
    memcpy(all->vertices + all->vertex_count, mesh.vertices,
           mesh.vertex_count * sizeof *mesh.vertices);
    order_mesh(all->indices + all->index_count, all->places + all->vertex_count, &mesh, model);
    all->vertex_count += (mesh.vertex_count + WD_MESH_ALIGNMENT - 1) / WD_MESH_ALIGNMENT *
                         WD_MESH_ALIGNMENT;
    all->index_count += mesh.index_count;
}

static bool upload_all(struct wd_leaf_order *order, struct wd_gpu *gpu, const struct gathering *all)
{
    const VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    return upload(&order->vertices, gpu, "leaf vertices", storage, all->vertices,
                  (all->vertex_count + 1) * sizeof *all->vertices) &&
           upload(&order->indices, gpu, "leaf indices", VK_BUFFER_USAGE_INDEX_BUFFER_BIT,
                  all->indices, (all->index_count + 1) * sizeof *all->indices) &&
           upload(&order->places, gpu, "leaf places", storage, all->places,
                  (all->vertex_count + 1) * sizeof *all->places);
}

bool wd_leaf_order_init(struct wd_leaf_order *order, struct wd_gpu *gpu,
                        struct wd_forest_device *forest)
{
    *order = (struct wd_leaf_order){
        .ranges = wd_alloc_array(forest->model_count, sizeof *order->ranges)};
    struct gathering all = {0};
    bool ok = true;
    make_room(&all, &(struct mesh){0});
    for (uint32_t i = 0; i < forest->model_count && ok; i++) {
        struct wd_tree_model grown;
        ok = wd_forest_grow_model(&grown, forest, i, gpu->log);
        if (!ok)
            break;
        gather_model(&all, &order->ranges[i], &grown.full, i);
        wd_tree_model_finish(&grown);
    }
    ok = ok && upload_all(order, gpu, &all);
    free(all.vertices);
    free(all.places);
    free(all.indices);
    if (!ok)
        wd_leaf_order_finish(order, gpu);
    return ok;
}

void wd_leaf_order_finish(struct wd_leaf_order *order, struct wd_gpu *gpu)
{
    wd_buffer_finish(&order->vertices, gpu);
    wd_buffer_finish(&order->indices, gpu);
    wd_buffer_finish(&order->places, gpu);
    free(order->ranges);
    *order = (struct wd_leaf_order){0};
}
