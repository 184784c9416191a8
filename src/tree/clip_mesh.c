#include "tree/clip_mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "tree/clip.h"
#include "tree/model_file.h"

/* Turned z up, and put over the foot. */
static void take_places(float *places_m, float size_m[3], const struct wd_model_file *file)
{
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < file->vertex_count; i++) {
        const float *from = file->vertices[i].position;
        const float p[3] = {from[0], -from[2], from[1]};
        for (uint32_t axis = 0; axis < 3; axis++) {
            places_m[3 * i + axis] = p[axis];
            low[axis] = fminf(low[axis], p[axis]);
            high[axis] = fmaxf(high[axis], p[axis]);
        }
    }
    const float foot[3] = {0.5f * (low[0] + high[0]), 0.5f * (low[1] + high[1]), low[2]};
    for (uint32_t i = 0; i < 3 * file->vertex_count; i++)
        places_m[i] -= foot[i % 3];
    for (int axis = 0; axis < 3; axis++)
        size_m[axis] = high[axis] - low[axis];
}

bool wd_clip_mesh_read(struct wd_clip_mesh *mesh, const char *path, const struct wd_log *log)
{
    struct wd_model_file file;
    struct wd_clip_grid grid;
    *mesh = (struct wd_clip_mesh){0};
    if (!wd_model_file_read(&file, path, log))
        return false;
    float *places_m = wd_alloc_array(3 * (size_t)file.vertex_count + 1, sizeof *places_m);
    uint32_t *indices = wd_alloc_array(file.index_count + (size_t)1, sizeof *indices);
    take_places(places_m, mesh->size_m, &file);
    memcpy(indices, file.indices, file.index_count * sizeof *indices);
    mesh->volume = (struct wd_clip_volume){
        .name = wd_strdup(path),
        .positions_m = places_m,
        .indices = indices,
        .vertex_count = file.vertex_count,
        .triangle_count = file.index_count / 3,
    };
    wd_model_file_finish(&file);
    bool ok = wd_clip_grid_init(&grid, &mesh->volume, log);
    if (!ok)
        wd_clip_mesh_finish(mesh);
    return ok;
}

void wd_clip_mesh_finish(struct wd_clip_mesh *mesh)
{
    free((char *)mesh->volume.name);
    free((float *)mesh->volume.positions_m);
    free((uint32_t *)mesh->volume.indices);
    *mesh = (struct wd_clip_mesh){0};
}
