#include "forest/sprays.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

static uint32_t aligned(uint32_t count)
{
    return (count + WD_SPRAY_ALIGNMENT - 1) / WD_SPRAY_ALIGNMENT * WD_SPRAY_ALIGNMENT;
}

static bool upload(struct wd_buffer *buffer, struct wd_gpu *gpu, const char *name,
                   VkBufferUsageFlags usage, const void *data, size_t size)
{
    const struct wd_buffer_params params = {name, size, usage, WD_MEMORY_DEVICE};
    return wd_buffer_init(buffer, gpu, &params) && wd_buffer_upload(gpu, buffer, 0, data, size);
}

/* The range after `before`. */
static struct wd_spray_range next_range(const struct wd_spray_range *before,
                                        const struct wd_tree_model *model)
{
    struct wd_spray_range range = {0};
    if (before) {
        range.first_leaf = before->first_leaf + aligned(before->leaf_count);
        range.first_vertex = before->first_vertex + aligned(before->vertex_count);
        range.first_index = before->first_index + before->index_count;
    }
    if (model) {
        range.leaf_count = model->leaf_count;
        range.vertex_count = model->spray.vertex_count;
        range.index_count = model->spray.index_count;
        range.reach = model->spray_reach;
    }
    return range;
}

bool wd_forest_sprays_init(struct wd_forest_sprays *sprays, struct wd_gpu *gpu,
                           const struct wd_tree_model *models, uint32_t count)
{
    *sprays = (struct wd_forest_sprays){.ranges = wd_alloc_array(count + 1, sizeof *sprays->ranges)};
    for (uint32_t i = 0; i <= count; i++)
        sprays->ranges[i] = next_range(i ? &sprays->ranges[i - 1] : NULL,
                                       i < count ? &models[i] : NULL);
    const struct wd_spray_range *end = &sprays->ranges[count];
    size_t leaves = (size_t)end->first_leaf + 1, vertices = (size_t)end->first_vertex + 1;
    size_t indices = (size_t)end->first_index + 1;
    struct wd_tree_vertex *all_vertices = wd_alloc_array(vertices, sizeof *all_vertices);
    uint32_t *all_indices = wd_alloc_array(indices, sizeof *all_indices);
    sprays->host_leaves = wd_alloc_array(leaves, sizeof *sprays->host_leaves);
    for (uint32_t i = 0; i < count; i++) {
        const struct wd_spray_range *range = &sprays->ranges[i];
        if (!range->leaf_count)
            continue;
        memcpy(sprays->host_leaves + range->first_leaf, models[i].leaves,
               range->leaf_count * sizeof *models[i].leaves);
        memcpy(all_vertices + range->first_vertex, models[i].spray.vertices,
               range->vertex_count * sizeof *all_vertices);
        memcpy(all_indices + range->first_index, models[i].spray.indices,
               range->index_count * sizeof *all_indices);
    }
    bool ok = upload(&sprays->leaves, gpu, "leaves", VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                     sprays->host_leaves, leaves * sizeof *sprays->host_leaves) &&
              upload(&sprays->vertices, gpu, "twig vertices", VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                     all_vertices, vertices * sizeof *all_vertices) &&
              upload(&sprays->indices, gpu, "twig indices", VK_BUFFER_USAGE_INDEX_BUFFER_BIT,
                     all_indices, indices * sizeof *all_indices);
    free(all_vertices);
    free(all_indices);
    if (!ok)
        wd_forest_sprays_finish(sprays, gpu);
    return ok;
}

void wd_forest_sprays_finish(struct wd_forest_sprays *sprays, struct wd_gpu *gpu)
{
    wd_buffer_finish(&sprays->leaves, gpu);
    wd_buffer_finish(&sprays->vertices, gpu);
    wd_buffer_finish(&sprays->indices, gpu);
    free(sprays->host_leaves);
    free(sprays->ranges);
    *sprays = (struct wd_forest_sprays){0};
}

void wd_forest_sprays_use(struct wd_forest_sprays *sprays, struct wd_cmd *cmd)
{
    if (!sprays->leaves.buffer)
        return;
    wd_cmd_use_buffer(cmd, &sprays->leaves, WD_USE_SHADER_READ);
    wd_cmd_use_buffer(cmd, &sprays->vertices, WD_USE_SHADER_READ);
    wd_cmd_use_buffer(cmd, &sprays->indices, WD_USE_INDEX);
}
