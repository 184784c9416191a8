#include "methods/leaf_order.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "tree/progressive.h"

/* One full mesh on the host. */
struct mesh {
    struct wd_tree_vertex *vertices;
    uint32_t vertex_count;
    uint32_t *indices; /* of its leaves */
    uint32_t index_count;
};

static bool read_mesh(struct mesh *mesh, struct wd_gpu *gpu, struct wd_forest_device *forest,
                      const struct wd_mesh_range *range)
{
    *mesh = (struct mesh){.vertex_count = range->vertex_count,
                          .index_count = range->index_count - range->wood_index_count};
    mesh->vertices = wd_alloc_array(mesh->vertex_count, sizeof *mesh->vertices);
    mesh->indices = wd_alloc_array(mesh->index_count, sizeof *mesh->indices);
    VkDeviceSize first = (VkDeviceSize)range->first_index + range->wood_index_count;
    return wd_buffer_read(gpu, &forest->vertices,
                          range->first_vertex * sizeof *mesh->vertices, mesh->vertices,
                          mesh->vertex_count * sizeof *mesh->vertices) &&
           (!mesh->index_count ||
            wd_buffer_read(gpu, &forest->indices, first * sizeof *mesh->indices, mesh->indices,
                           mesh->index_count * sizeof *mesh->indices));
}

static void mesh_finish(struct mesh *mesh)
{
    free(mesh->vertices);
    free(mesh->indices);
    *mesh = (struct mesh){0};
}

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
    uint32_t limit = gpu->properties.limits.maxStorageBufferRange;
    if (size > limit && usage == VK_BUFFER_USAGE_STORAGE_BUFFER_BIT)
        return wd_error(gpu->log, "%s: %zu MB are more than the %u MB that %s can bind at once: "
                                  "use fewer variants",
                        name, size >> 20, limit >> 20, gpu->properties.deviceName);
    return wd_buffer_init(buffer, gpu, &params) && wd_buffer_upload(gpu, buffer, 0, data, size);
}

static void lay_out(struct wd_leaf_order *order, const struct wd_forest_device *forest,
                    size_t *index_count, size_t *place_count)
{
    for (uint32_t i = 0; i < forest->model_count; i++) {
        const struct wd_mesh_range *range = &forest->ranges[i][WD_LEVEL_MESH];
        order->ranges[i] = (struct wd_leaf_range){
            (uint32_t)*index_count, range->index_count - range->wood_index_count,
            (uint32_t)*place_count};
        *index_count += order->ranges[i].index_count;
        *place_count += range->vertex_count;
    }
}

bool wd_leaf_order_init(struct wd_leaf_order *order, struct wd_gpu *gpu,
                        struct wd_forest_device *forest)
{
    size_t index_count = 0, place_count = 0;
    *order = (struct wd_leaf_order){
        .ranges = wd_alloc_array(forest->model_count, sizeof *order->ranges)};
    lay_out(order, forest, &index_count, &place_count);
    uint32_t *indices = wd_alloc_array(index_count + 1, sizeof *indices);
    struct wd_leaf_place *places = wd_alloc_array(place_count + 1, sizeof *places);
    bool ok = true;
    for (uint32_t i = 0; i < forest->model_count && ok; i++) {
        struct mesh mesh;
        ok = read_mesh(&mesh, gpu, forest, &forest->ranges[i][WD_LEVEL_MESH]);
        if (ok)
            order_mesh(indices + order->ranges[i].first_index,
                       places + order->ranges[i].first_place, &mesh, i);
        mesh_finish(&mesh);
    }
    ok = ok &&
         upload(&order->indices, gpu, "leaf indices", VK_BUFFER_USAGE_INDEX_BUFFER_BIT, indices,
                (index_count + 1) * sizeof *indices) &&
         upload(&order->places, gpu, "leaf places", VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, places,
                (place_count + 1) * sizeof *places);
    free(indices);
    free(places);
    if (!ok)
        wd_leaf_order_finish(order, gpu);
    return ok;
}

void wd_leaf_order_finish(struct wd_leaf_order *order, struct wd_gpu *gpu)
{
    wd_buffer_finish(&order->indices, gpu);
    wd_buffer_finish(&order->places, gpu);
    free(order->ranges);
    *order = (struct wd_leaf_order){0};
}
