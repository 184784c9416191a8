#include "tree/model_reduce.h"

#include <math.h>
#include <meshoptimizer.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "shared/hash.h"
#include "tree/coverage.h"
#include "tree/silhouette.h"
#include "tree/vec.h"

/* Larger leaves read as balloons. */
#define MOST_GROWTH 3.0f

enum {
    FEW_PIECES = 64,           /* solid foliage */
    MOST_PIECE_TRIANGLES = 12, /* on the average, of a leaf that is kept or dropped whole */
};

/* --- simplifying ------------------------------------------------------------------------- */

/* Keeps to the shape if that gets near the target, else to the count. */
static size_t simplify(uint32_t *to, const uint32_t *from, size_t count,
                       const struct wd_tree_mesh *mesh, size_t target)
{
    const float *positions = mesh->vertices[0].position_m;
    const size_t stride = sizeof *mesh->vertices;
    const float most_error = 0.02f, any_error = 1;
    if (count <= target) {
        memcpy(to, from, count * sizeof *to);
        return count;
    }
    size_t reached = meshopt_simplify(to, from, count, positions, mesh->vertex_count, stride,
                                      target, most_error, 0, NULL);
    if (reached > 2 * target)
        reached = meshopt_simplifySloppy(to, from, count, positions, mesh->vertex_count, stride,
                                         target, any_error, NULL);
    return reached;
}

/* --- pieces that hang together ----------------------------------------------------------- */

struct piece {
    uint32_t first, count; /* in `order`: triangles */
    uint32_t key;          /* sorts into a random order */
    float area_m2;
    struct wd_vec3 middle_m;
};

struct pieces {
    struct piece *items;
    size_t count;
    uint32_t *order; /* triangles, piece by piece */
    float area_m2;
    size_t triangles;
};

static uint32_t root_of(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i)
        i = parent[i] = parent[parent[i]];
    return i;
}

static struct wd_vec3 position(const struct wd_tree_mesh *mesh, uint32_t index)
{
    const float *p = mesh->vertices[index].position_m;
    return WD_V3(p[0], p[1], p[2]);
}

/* parent[v]: the vertices that v's triangles join it with share one root. */
static void join(const struct wd_tree_mesh *mesh, const uint32_t *indices, size_t count,
                 uint32_t *parent)
{
    uint32_t *welded = wd_alloc_array(count, sizeof *welded);
    meshopt_generateShadowIndexBuffer(welded, indices, count, mesh->vertices, mesh->vertex_count,
                                      sizeof mesh->vertices->position_m, sizeof *mesh->vertices);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        parent[i] = i;
    for (size_t i = 0; i < count; i++) {
        size_t triangle = i / 3 * 3;
        uint32_t a = root_of(parent, welded[i]), b = root_of(parent, welded[triangle]);
        parent[a] = b;
        a = root_of(parent, indices[i]);
        parent[a] = root_of(parent, welded[i]);
    }
    free(welded);
}

static void add_triangle(struct piece *piece, const struct wd_tree_mesh *mesh,
                         const uint32_t *corner)
{
    struct wd_vec3 a = position(mesh, corner[0]), b = position(mesh, corner[1]);
    struct wd_vec3 c = position(mesh, corner[2]);
    float area = 0.5f * wd_v3_length(wd_v3_cross(wd_v3_sub(b, a), wd_v3_sub(c, a)));
    struct wd_vec3 sum = wd_v3_add(a, wd_v3_add(b, c));
    piece->middle_m = wd_v3_mad(piece->middle_m, sum, area * (1.0f / 3));
    piece->area_m2 += area;
    piece->count++;
}

static int compare_keys(const void *a, const void *b)
{
    const struct piece *x = a, *y = b;
    if (x->key != y->key)
        return x->key < y->key ? -1 : 1;
    return x->first < y->first ? -1 : x->first > y->first;
}

static void find_pieces(struct pieces *pieces, const struct wd_tree_mesh *mesh,
                        const uint32_t *indices, size_t count)
{
    uint32_t *parent = wd_alloc_array(mesh->vertex_count, sizeof *parent);
    uint32_t *piece_of = wd_alloc_array(mesh->vertex_count, sizeof *piece_of);
    size_t capacity = 0;
    *pieces = (struct pieces){.triangles = count / 3};
    join(mesh, indices, count, parent);
    for (size_t i = 0; i < count; i += 3) {
        uint32_t root = root_of(parent, indices[i]);
        if (piece_of[root] == 0) {
            struct piece *piece = wd_push(pieces->items, pieces->count, capacity);
            piece->key = wd_hash_mix((uint32_t)pieces->count);
            piece_of[root] = (uint32_t)pieces->count;
        }
        add_triangle(&pieces->items[piece_of[root] - 1], mesh, indices + i);
    }
    uint32_t first = 0;
    for (size_t i = 0; i < pieces->count; i++) {
        struct piece *piece = &pieces->items[i];
        piece->first = first;
        first += piece->count;
        piece->count = 0;
        pieces->area_m2 += piece->area_m2;
        piece->middle_m = wd_v3_scale(piece->middle_m, 1 / fmaxf(piece->area_m2, 1e-20f));
    }
    pieces->order = wd_alloc_array(pieces->triangles, sizeof *pieces->order);
    for (size_t i = 0; i < count; i += 3) {
        struct piece *piece = &pieces->items[piece_of[root_of(parent, indices[i])] - 1];
        pieces->order[piece->first + piece->count++] = (uint32_t)(i / 3);
    }
    qsort(pieces->items, pieces->count, sizeof *pieces->items, compare_keys);
    free(parent);
    free(piece_of);
}

/* --- putting together -------------------------------------------------------------------- */

/* Copies vertices on first use. */
struct copier {
    struct wd_tree_mesh *to;
    const struct wd_tree_mesh *from;
    uint32_t *copy_of; /* + 1; 0: none yet */
};

static void copy_triangle(struct copier *copier, const uint32_t *corner, struct wd_vec3 middle_m,
                          float growth)
{
    uint32_t copies[3];
    for (int k = 0; k < 3; k++) {
        uint32_t *copy = &copier->copy_of[corner[k]];
        if (*copy == 0) {
            struct wd_tree_vertex vertex = copier->from->vertices[corner[k]];
            struct wd_vec3 p = position(copier->from, corner[k]);
            p = wd_v3_mad(middle_m, wd_v3_sub(p, middle_m), growth);
            vertex.position_m[0] = p.x;
            vertex.position_m[1] = p.y;
            vertex.position_m[2] = p.z;
            *copy = wd_tree_mesh_add_vertex(copier->to, &vertex) + 1;
        }
        copies[k] = *copy - 1;
    }
    wd_tree_mesh_add_triangle(copier->to, copies[0], copies[1], copies[2]);
}

static void copy_simplified(struct copier *copier, const uint32_t *indices, size_t count,
                            size_t triangles)
{
    uint32_t *kept = wd_alloc_array(count, sizeof *kept);
    size_t kept_count = simplify(kept, indices, count, copier->from, 3 * triangles);
    for (size_t i = 0; i + 2 < kept_count; i += 3)
        copy_triangle(copier, kept + i, WD_V3(0, 0, 0), 1);
    free(kept);
}

/* Enough of the pieces, in their random order, for about `triangles`. */
static void copy_pieces(struct copier *copier, const struct pieces *pieces,
                        const uint32_t *indices, size_t triangles)
{
    size_t kept = 0, used = 0;
    float area = 0;
    while (kept < pieces->count && used < triangles) {
        used += pieces->items[kept].count;
        area += pieces->items[kept++].area_m2;
    }
    float growth = fminf(sqrtf(pieces->area_m2 / fmaxf(area, 1e-20f)), MOST_GROWTH);
    for (size_t i = 0; i < kept; i++) {
        const struct piece *piece = &pieces->items[i];
        for (uint32_t t = 0; t < piece->count; t++)
            copy_triangle(copier, indices + 3 * (size_t)pieces->order[piece->first + t],
                          piece->middle_m, growth);
    }
}

/* A random triangle of each part of the list, enlarged: for pieces of many triangles, of which too
 * few whole ones would be left to show the crown's shape. */
static void copy_triangles(struct copier *copier, const uint32_t *indices, size_t count,
                           size_t triangles)
{
    size_t all = count / 3;
    struct piece chosen = {0}, whole = {0};
    uint32_t *picks = wd_alloc_array(triangles + 1, sizeof *picks);
    for (size_t i = 0; i < triangles; i++) {
        size_t first = i * all / triangles, end = (i + 1) * all / triangles;
        size_t pick = first + wd_hash1((uint32_t)i) % (end > first ? end - first : 1);
        picks[i] = (uint32_t)pick;
        add_triangle(&chosen, copier->from, indices + 3 * pick);
    }
    for (size_t i = 0; i < all; i++)
        add_triangle(&whole, copier->from, indices + 3 * i);
    float growth = fminf(sqrtf(whole.area_m2 / fmaxf(chosen.area_m2, 1e-20f)), MOST_GROWTH);
    for (size_t i = 0; i < triangles; i++) {
        const uint32_t *corner = indices + 3 * (size_t)picks[i];
        struct piece own = {0};
        add_triangle(&own, copier->from, corner);
        for (int k = 0; k < 3; k++)
            copier->copy_of[corner[k]] = 0; /* grown about its own middle: shared with none */
        copy_triangle(copier, corner,
                      wd_v3_scale(own.middle_m, 1 / fmaxf(own.area_m2, 1e-20f)), growth);
    }
    free(picks);
}

/* Whether leaves are large enough for pictures of WD_SILHOUETTE pixels a side to measure them. */
static bool seen_in_silhouettes(const struct wd_tree_mesh *full, const struct pieces *pieces)
{
    float side_m = 0;
    for (int axis = 0; axis < 3; axis++)
        side_m = fmaxf(side_m, full->max_m[axis] - full->min_m[axis]);
    float pixel_m = side_m / WD_SILHOUETTE;
    return pieces->area_m2 > 0.25f * pixel_m * pixel_m * (float)pieces->count;
}

void wd_tree_mesh_reduce_import(struct wd_tree_mesh *reduced, const struct wd_tree_mesh *full,
                                size_t wood_triangles, size_t leaf_triangles)
{
    *reduced = (struct wd_tree_mesh){0};
    struct copier copier = {reduced, full, wd_alloc_array(full->vertex_count + 1, 4)};
    const uint32_t *leaves = full->indices + full->wood_index_count;
    size_t leaf_count = full->index_count - full->wood_index_count;
    if (full->wood_index_count)
        copy_simplified(&copier, full->indices, full->wood_index_count, wood_triangles);
    reduced->wood_index_count = reduced->index_count;
    if (leaf_count) {
        struct pieces pieces;
        find_pieces(&pieces, full, leaves, leaf_count);
        bool coarse = pieces.triangles > MOST_PIECE_TRIANGLES * pieces.count;
        bool simplified = pieces.triangles <= leaf_triangles ||
                          (pieces.count < FEW_PIECES && coarse);
        if (simplified)
            copy_simplified(&copier, leaves, leaf_count, leaf_triangles);
        else if (coarse)
            copy_triangles(&copier, leaves, leaf_count, leaf_triangles);
        else
            copy_pieces(&copier, &pieces, leaves, leaf_triangles);
        if (!simplified && seen_in_silhouettes(full, &pieces))
            wd_tree_mesh_fit_coverage(reduced, full, (float[WD_LEAF_SETS]){0});
        free(pieces.items);
        free(pieces.order);
    }
    free(copier.copy_of);
    wd_tree_mesh_update_bounds(reduced);
}
