#include "device_mesh.h"

static bool upload(struct wd_buffer *buffer, struct wd_gpu *gpu, const void *data, size_t size)
{
    const struct wd_buffer_params params = {"mesh", size, 0, WD_MEMORY_DEVICE, WD_BAKE_WORDS};
    return wd_buffer_init(buffer, gpu, &params) && wd_buffer_upload(gpu, buffer, 0, data, size);
}

bool device_mesh_init(struct device_mesh *device, struct wd_gpu *gpu,
                      const struct wd_tree_mesh *mesh, const uint8_t *looks, uint32_t size)
{
    const struct wd_image_params image = {
        .name = "looks",
        .format = VK_FORMAT_R8G8B8A8_SRGB,
        .width = size,
        .height = size,
        .layers = 2,
        .usage = VK_IMAGE_USAGE_SAMPLED_BIT,
        .view = WD_IMAGE_ARRAY,
    };
    size_t layer = (size_t)4 * size * size;
    *device = (struct device_mesh){0};
    if (!upload(&device->vertices, gpu, mesh->vertices,
                mesh->vertex_count * sizeof *mesh->vertices) ||
        !upload(&device->indices, gpu, mesh->indices, mesh->index_count * sizeof *mesh->indices) ||
        !wd_image_init(&device->looks, gpu, &image) ||
        !wd_image_upload(gpu, &device->looks, 0, 0, looks, layer) ||
        !wd_image_upload(gpu, &device->looks, 1, 0, looks + layer, layer))
        return false;
    device->mesh = (struct wd_bake_mesh){
        .vertices = &device->vertices,
        .indices = &device->indices,
        .index_count = mesh->index_count,
        .wood_index_count = mesh->wood_index_count,
        .looks = &device->looks,
    };
    return true;
}

void device_mesh_finish(struct device_mesh *device, struct wd_gpu *gpu)
{
    wd_buffer_finish(&device->vertices, gpu);
    wd_buffer_finish(&device->indices, gpu);
    wd_image_finish(&device->looks, gpu);
}
