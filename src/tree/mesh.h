/* mesh.h: an indexed triangle mesh of a tree. */
#ifndef WD_TREE_MESH_H
#define WD_TREE_MESH_H

#include <stdbool.h>
#include <stddef.h>

#include "shared/tree.h"

/* Wood comes first in the index list, leaves after it. Triangles of wood are counter-clockwise
 * seen from outside; leaves are single sheets seen from both sides. */
struct wd_tree_mesh {
    struct wd_tree_vertex *vertices;
    uint32_t *indices;
    uint32_t vertex_count, vertex_capacity;
    uint32_t index_count, index_capacity; /* three a triangle */
    uint32_t wood_index_count;            /* indices [0, wood_index_count) are wood */
    uint32_t stem_index_count;            /* the first of them: a stem with root lobes */
    float min_m[3], max_m[3];             /* bounds, set by wd_tree_mesh_update_bounds */
    float reach_m;                        /* from the z axis to the farthest vertex, likewise */
};

void wd_tree_mesh_finish(struct wd_tree_mesh *mesh); /* accepts {0} */

/* Makes room for so many more. */
void wd_tree_mesh_reserve(struct wd_tree_mesh *mesh, uint32_t vertices, uint32_t indices);

static inline uint32_t wd_tree_mesh_add_vertex(struct wd_tree_mesh *mesh,
                                               const struct wd_tree_vertex *vertex)
{
    if (mesh->vertex_count == mesh->vertex_capacity)
        wd_tree_mesh_reserve(mesh, 1, 0);
    mesh->vertices[mesh->vertex_count] = *vertex;
    return mesh->vertex_count++;
}

static inline void wd_tree_mesh_add_triangle(struct wd_tree_mesh *mesh, uint32_t a, uint32_t b,
                                             uint32_t c)
{
    if (mesh->index_count + 3 > mesh->index_capacity)
        wd_tree_mesh_reserve(mesh, 0, 3);
    mesh->indices[mesh->index_count++] = a;
    mesh->indices[mesh->index_count++] = b;
    mesh->indices[mesh->index_count++] = c;
}

void wd_tree_mesh_update_bounds(struct wd_tree_mesh *mesh);

/* The box between two corners. */
struct wd_mesh_box wd_mesh_box_of(const float least_m[3], const float most_m[3]);
/* The place in it, to the nearest step. */
void wd_mesh_box_steps(uint32_t steps[3], const struct wd_mesh_box *box, const float position_m[3]);
/* A vertex as the device keeps it. */
struct wd_packed_vertex wd_vertex_pack(const struct wd_tree_vertex *vertex,
                                       const struct wd_mesh_box *box);

/* Packing as struct wd_tree_vertex wants it. `normal` is of any length above 0. */
static inline uint32_t wd_pack_snorm16(float value)
{
    float clamped = value < -1 ? -1 : value > 1 ? 1 : value;
    int32_t scaled = (int32_t)(clamped * 32767 + 32768.5f) - 32768; /* to nearest */
    return (uint32_t)scaled & 0xffffu;
}

static inline uint32_t wd_pack_normal(const float normal[3])
{
    float sum = fabsf(normal[0]) + fabsf(normal[1]) + fabsf(normal[2]);
    float over = sum > 0 ? 1 / sum : 0, x = normal[0] * over, y = normal[1] * over;
    if (normal[2] < 0) {
        float folded = (1 - fabsf(y)) * (x < 0 ? -1.0f : 1.0f);
        y = (1 - fabsf(x)) * (y < 0 ? -1.0f : 1.0f);
        x = folded;
    }
    return wd_pack_snorm16(x) | wd_pack_snorm16(y) << 16;
}

static inline void wd_unpack_normal(uint32_t packed, float normal[3])
{
    float x = fmaxf((float)(int16_t)(packed & 0xffffu) / 32767, -1);
    float y = fmaxf((float)(int16_t)(packed >> 16) / 32767, -1);
    float z = 1 - fabsf(x) - fabsf(y), fold = fmaxf(-z, 0);
    x += x >= 0 ? -fold : fold;
    y += y >= 0 ? -fold : fold;
    float length = sqrtf(x * x + y * y + z * z);
    normal[0] = x / length;
    normal[1] = y / length;
    normal[2] = z / length;
}

/* From 16 bits a part to 8. */
static inline uint32_t wd_normal8(uint32_t packed)
{
    uint32_t coarse = 0;
    for (int i = 0; i < 2; i++) {
        float part = (float)(int16_t)(packed >> (16 * i) & 0xffffu) / 32767;
        coarse |= ((uint32_t)((int32_t)(part * 127 + 128.5f) - 128) & 0xffu) << (8 * i);
    }
    return coarse;
}

uint32_t wd_pack_uv(float u, float v);
void wd_unpack_uv(uint32_t packed, float uv[2]);

#endif
