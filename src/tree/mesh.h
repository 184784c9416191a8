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
    float min_m[3], max_m[3];             /* bounds, set by wd_tree_mesh_update_bounds */
    float reach_m;                        /* from the z axis to the farthest vertex, likewise */
};

void wd_tree_mesh_finish(struct wd_tree_mesh *mesh); /* accepts {0} */
uint32_t wd_tree_mesh_add_vertex(struct wd_tree_mesh *mesh, const struct wd_tree_vertex *vertex);
void wd_tree_mesh_add_triangle(struct wd_tree_mesh *mesh, uint32_t a, uint32_t b, uint32_t c);
void wd_tree_mesh_update_bounds(struct wd_tree_mesh *mesh);

/* The box between two corners. */
struct wd_mesh_box wd_mesh_box_of(const float least_m[3], const float most_m[3]);
/* The place in it, to the nearest step. */
void wd_mesh_box_steps(uint32_t steps[3], const struct wd_mesh_box *box, const float position_m[3]);
/* A vertex as the device keeps it. */
struct wd_packed_vertex wd_vertex_pack(const struct wd_tree_vertex *vertex,
                                       const struct wd_mesh_box *box);

/* Packing as struct wd_tree_vertex wants it. `normal` is of unit length. */
uint32_t wd_pack_normal(const float normal[3]);
void wd_unpack_normal(uint32_t packed, float normal[3]);
uint32_t wd_pack_uv(float u, float v);
void wd_unpack_uv(uint32_t packed, float uv[2]);

#endif
