#include "tree/mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "tree/four.h"

enum { FIRST_CAPACITY = 1024 };

static void *make_room(void *items, uint32_t count, uint32_t more, uint32_t *capacity, size_t size)
{
    if (count + more <= *capacity)
        return items;
    *capacity = *capacity ? *capacity * 2 : FIRST_CAPACITY;
    if (*capacity < count + more)
        *capacity = count + more;
    return wd_realloc(items, *capacity * size);
}

void wd_tree_mesh_reserve(struct wd_tree_mesh *mesh, uint32_t vertices, uint32_t indices)
{
    mesh->vertices = make_room(mesh->vertices, mesh->vertex_count, vertices,
                               &mesh->vertex_capacity, sizeof *mesh->vertices);
    mesh->indices = make_room(mesh->indices, mesh->index_count, indices, &mesh->index_capacity,
                              sizeof *mesh->indices);
}

void wd_tree_mesh_finish(struct wd_tree_mesh *mesh)
{
    free(mesh->vertices);
    free(mesh->indices);
    *mesh = (struct wd_tree_mesh){0};
}

void wd_tree_mesh_update_bounds(struct wd_tree_mesh *mesh)
{
    wd_four low = wd_four_of(INFINITY), high = wd_four_of(-INFINITY);
    float reach = 0;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        wd_four p; /* and what follows it, which nobody asks for */
        memcpy(&p, &mesh->vertices[i], sizeof p);
        float squared = p[0] * p[0] + p[1] * p[1];
        reach = squared > reach ? squared : reach;
        low = wd_four_min(p, low);
        high = wd_four_max(p, high);
    }
    mesh->reach_m = sqrtf(reach);
    for (int axis = 0; axis < 3; axis++) {
        mesh->min_m[axis] = mesh->vertex_count ? low[axis] : 0;
        mesh->max_m[axis] = mesh->vertex_count ? high[axis] : 0;
    }
}

struct wd_mesh_box wd_mesh_box_of(const float least_m[3], const float most_m[3])
{
    struct wd_mesh_box box;
    for (int axis = 0; axis < 3; axis++) {
        box.least_m[axis] = least_m[axis];
        box.step_m[axis] = (most_m[axis] - least_m[axis]) / WD_BOX_STEPS;
    }
    return box;
}

void wd_mesh_box_steps(uint32_t steps[3], const struct wd_mesh_box *box, const float position_m[3])
{
    for (int axis = 0; axis < 3; axis++) {
        float step = box->step_m[axis], from = position_m[axis] - box->least_m[axis];
        float place = step > 0 ? from / step + 0.5f : 0;
        steps[axis] = (uint32_t)(place < 0 ? 0 : place > WD_BOX_STEPS ? WD_BOX_STEPS : place);
    }
}

static uint32_t part_of(float value, uint32_t most)
{
    return (uint32_t)(value * (float)most + 0.5f);
}

static uint32_t tint_part(const struct wd_tree_vertex *vertex, uint32_t part, uint32_t most)
{
    return part_of((float)(vertex->tint >> (8 * part) & 255) / 255, most);
}

static uint32_t root_part(const struct wd_tree_vertex *vertex, uint32_t part, uint32_t most)
{
    return part_of(sqrtf((float)(vertex->tint >> (8 * part) & 255) / 255), most);
}

struct wd_packed_vertex wd_vertex_pack(const struct wd_tree_vertex *vertex,
                                       const struct wd_mesh_box *box)
{
    uint32_t steps[3];
    wd_mesh_box_steps(steps, box, vertex->position_m);
    return (struct wd_packed_vertex){
        .xy = steps[0] | steps[1] << 16,
        .z_kind = steps[2] | (vertex->kind & WD_VERTEX_KIND) << 16 | tint_part(vertex, 3, 63) << 26,
        .uv = vertex->uv,
        .normal_tint = wd_normal8(vertex->normal) | root_part(vertex, 0, 31) << 16 |
                       root_part(vertex, 1, 63) << 21 | root_part(vertex, 2, 31) << 27,
    };
}

/* Round to nearest half float; magnitudes beyond 65504 clamp, below 2^-14 flush to zero. */
static uint32_t pack_half(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    uint32_t sign = bits >> 16 & 0x8000u, magnitude = bits & 0x7fffffffu;
    if (magnitude < 0x38800000u)
        return sign;
    uint32_t half = (magnitude - 0x38000000u + 0x1000u) >> 13;
    return sign | (half > 0x7bffu ? 0x7bffu : half);
}

uint32_t wd_pack_uv(float u, float v)
{
    return pack_half(u) | pack_half(v) << 16;
}

static float unpack_half(uint32_t half)
{
    uint32_t exponent = half >> 10 & 31, mantissa = half & 1023;
    uint32_t bits = (exponent + 112) << 23 | mantissa << 13;
    float value = (float)mantissa / (1 << 24);
    if (exponent)
        memcpy(&value, &bits, sizeof value);
    return half & 0x8000 ? -value : value;
}

void wd_unpack_uv(uint32_t packed, float uv[2])
{
    uv[0] = unpack_half(packed & 0xffff);
    uv[1] = unpack_half(packed >> 16);
}
