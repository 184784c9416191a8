/* device_mesh.h: a mesh and its look textures on a device, for baking. */
#ifndef WD_TESTS_DEVICE_MESH_H
#define WD_TESTS_DEVICE_MESH_H

#include "bake/baker.h"
#include "tree/mesh.h"

struct device_mesh {
    struct wd_buffer vertices, indices;
    struct wd_image looks;
    struct wd_bake_mesh mesh;
};

/* `looks`: bark, then leaf, `size` x `size` texels RGBA8 sRGB each. */
bool device_mesh_init(struct device_mesh *device, struct wd_gpu *gpu,
                      const struct wd_tree_mesh *mesh, const uint8_t *looks, uint32_t size);
void device_mesh_finish(struct device_mesh *device, struct wd_gpu *gpu);

#endif
