#include "tree/points.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/color.h"
#include "base/dmath.h"
#include "base/memory.h"
#include "shared/sun_ways.h"
#include "tree/progressive.h"
#include "tree/random.h"

/* Triangles of wood, then of leaves, each along its own curve, with the area up to each. */
struct surface {
    const struct wd_tree_mesh *mesh;
    uint32_t *order; /* triangle */
    double *below;   /* [count + 1] m^2 */
    size_t count, wood_count;
};

enum { KEY = 0x70e5 };

static struct wd_vec3 corner(const struct wd_tree_mesh *mesh, size_t index)
{
    const float *p = mesh->vertices[mesh->indices[index]].position_m;
    return WD_V3(p[0], p[1], p[2]);
}

/* Broken triangles have none. */
static double triangle_area(const struct wd_tree_mesh *mesh, size_t triangle)
{
    struct wd_vec3 a = corner(mesh, 3 * triangle);
    struct wd_vec3 b = wd_v3_sub(corner(mesh, 3 * triangle + 1), a);
    struct wd_vec3 c = wd_v3_sub(corner(mesh, 3 * triangle + 2), a);
    double area = 0.5 * (double)wd_v3_length(wd_v3_cross(b, c));
    return area > 0 && area < 1e12 ? area : 0;
}

static bool is_petal(const struct wd_tree_mesh *mesh, size_t triangle)
{
    return wd_vertex_layer(mesh->vertices[mesh->indices[3 * triangle]].kind) == WD_LOOK_FLOWER;
}

/* A triangle's middle as a point that any side is seen of, and its plane's normal times its area. */
static struct wd_vec3 put_middle(struct wd_tree_point *point, const struct wd_tree_mesh *mesh, size_t triangle)
{
    struct wd_vec3 a = corner(mesh, 3 * triangle), b = corner(mesh, 3 * triangle + 1), c = corner(mesh, 3 * triangle + 2);
    struct wd_vec3 middle = wd_v3_scale(wd_v3_add(a, wd_v3_add(b, c)), 1 / 3.0f);
    *point = (struct wd_tree_point){.position_m = {middle.x, middle.y, middle.z}};
    return wd_v3_cross(wd_v3_sub(b, a), wd_v3_sub(c, a));
}

/* Petals lie over one another, where few points a flower would show all of them: of each triangle, the share of what it
 * would cover, seen from above and around, that no petal hides. 1 of what is none. */
static void find_petals_seen(float *shares, const struct wd_tree_mesh *mesh)
{
    const size_t count = mesh->index_count / 3;
    struct wd_tree_mesh petals = *mesh;
    struct wd_tree_points middles = {.points = wd_alloc_array(count + 1, sizeof *middles.points)};
    struct wd_vec3 *faces = wd_alloc_array(count + 1, sizeof *faces), ways[WD_SUN_WAYS];
    uint32_t *open = wd_alloc_array(count + 1, sizeof *open);
    petals.indices = wd_alloc_array(mesh->index_count + 1, sizeof *petals.indices);
    petals.index_count = petals.wood_index_count = 0;
    for (size_t i = 0; i < count; i++) {
        shares[i] = 1;
        if (!is_petal(mesh, i))
            continue;
        memcpy(petals.indices + petals.index_count, mesh->indices + 3 * i, 3 * sizeof *petals.indices);
        petals.index_count += 3;
        faces[middles.count] = put_middle(&middles.points[middles.count], mesh, i);
        middles.count++;
    }
    for (uint32_t way = 0; way < WD_SUN_WAYS; way++)
        ways[way] = wd_sun_way(way);
    if (middles.count)
        wd_tree_points_open(open, &middles, &petals, 0, ways, WD_SUN_WAYS);
    for (size_t i = 0, at = 0; i < count && at < middles.count; i++) {
        float seen = 0, all = 0;
        if (!is_petal(mesh, i))
            continue;
        for (uint32_t way = 0; way < WD_SUN_WAYS; way++) {
            float shown = fabsf(wd_v3_dot(faces[at], ways[way]));
            all += shown;
            seen += shown * wd_sun_way_lit(open[at], way);
        }
        shares[i] = all > 0 ? seen / all : 1;
        at++;
    }
    wd_tree_points_finish(&middles);
    free(petals.indices);
    free(faces);
    free(open);
}

static void order_part(struct surface *surface, size_t first, size_t count, const float *shares)
{
    struct wd_vec3 *centers = wd_alloc_array(count ? count : 1, sizeof *centers);
    double *areas = wd_alloc_array(count ? count : 1, sizeof *areas);
    for (size_t i = 0; i < count; i++) {
        struct wd_vec3 sum = {0};
        for (size_t k = 0; k < 3; k++)
            sum = wd_v3_add(sum, corner(surface->mesh, 3 * (first + i) + k));
        centers[i] = wd_v3_scale(sum, 1 / 3.0f);
        areas[i] = triangle_area(surface->mesh, first + i) * (double)shares[first + i];
    }
    wd_curve_order(surface->order + first, centers, count);
    for (size_t i = first; i < first + count; i++) {
        surface->below[i + 1] = surface->below[i] + areas[surface->order[i]];
        surface->order[i] += (uint32_t)first;
    }
    free(centers);
    free(areas);
}

static void surface_init(struct surface *surface, const struct wd_tree_mesh *mesh)
{
    size_t count = mesh->index_count / 3, wood = mesh->wood_index_count / 3;
    *surface = (struct surface){
        .mesh = mesh,
        .order = wd_alloc_array(count + 1, sizeof *surface->order),
        .below = wd_alloc_array(count + 1, sizeof *surface->below),
        .count = count,
        .wood_count = wood < count ? wood : count,
    };
    float *shares = wd_alloc_array(count + 1, sizeof *shares);
    find_petals_seen(shares, mesh);
    order_part(surface, 0, surface->wood_count, shares);
    order_part(surface, surface->wood_count, count - surface->wood_count, shares);
    free(shares);
}

static void surface_finish(struct surface *surface)
{
    free(surface->order);
    free(surface->below);
}

static uint32_t pack_albedo(const float rgb[3], float sky)
{
    uint32_t packed = (uint32_t)wd_unorm_encode(sky) << 24;
    for (int k = 0; k < 3; k++)
        packed |= (uint32_t)wd_srgb_encode(rgb[k]) << (8 * k);
    return packed;
}

struct triangle {
    const struct wd_tree_vertex *vertices[3];
    struct wd_vec3 a, b, c; /* a corner, and from it to the others */
    float uv[3][2];
};

static struct triangle triangle_of(const struct wd_tree_mesh *mesh, size_t index)
{
    struct triangle triangle;
    for (size_t k = 0; k < 3; k++) {
        triangle.vertices[k] = &mesh->vertices[mesh->indices[3 * index + k]];
        wd_unpack_uv(triangle.vertices[k]->uv, triangle.uv[k]);
    }
    triangle.a = wd_v3_of(triangle.vertices[0]->position_m);
    triangle.b = wd_v3_sub(wd_v3_of(triangle.vertices[1]->position_m), triangle.a);
    triangle.c = wd_v3_sub(wd_v3_of(triangle.vertices[2]->position_m), triangle.a);
    return triangle;
}

/* Sums of a triangle's vertices by weight. */
struct blend {
    float position_m[3], normal[3], tint[4], uv[2], flexibility;
};

static struct blend blend_corners(const struct triangle *triangle, const float weight[3])
{
    struct blend blend = {0};
    for (size_t k = 0; k < 3; k++) {
        const struct wd_tree_vertex *vertex = triangle->vertices[k];
        float normal[3];
        wd_unpack_normal(vertex->normal, normal);
        blend.uv[0] += weight[k] * triangle->uv[k][0];
        blend.uv[1] += weight[k] * triangle->uv[k][1];
        for (int i = 0; i < 3; i++) {
            blend.position_m[i] += weight[k] * vertex->position_m[i];
            blend.normal[i] += weight[k] * normal[i];
        }
        for (int i = 0; i < 4; i++)
            blend.tint[i] += weight[k] * (float)(vertex->tint >> (8 * i) & 255) / 255;
        blend.flexibility += weight[k] * (float)(vertex->kind & 255);
    }
    return blend;
}

static const uint8_t *texel(const struct wd_point_look *look, uint32_t layer, const float uv[2])
{
    float size = (float)look->size;
    uint32_t x = (uint32_t)((uv[0] - floorf(uv[0])) * size) % look->size;
    uint32_t y = (uint32_t)((uv[1] - floorf(uv[1])) * size) % look->size;
    return look->rgba + 4 * (((size_t)layer * look->size + y) * look->size + x);
}

/* Across the triangle, out of the side that its texture is not mirrored on: a leaf's upper one. */
static uint32_t face_of(const struct triangle *triangle)
{
    const float(*uv)[2] = triangle->uv;
    struct wd_vec3 n = wd_v3_cross(triangle->b, triangle->c);
    float turn = (uv[1][0] - uv[0][0]) * (uv[2][1] - uv[0][1]) -
                 (uv[1][1] - uv[0][1]) * (uv[2][0] - uv[0][0]);
    n = wd_v3_unit(turn < 0 ? wd_v3_scale(n, -1) : n);
    const float normal[3] = {n.x, n.y, n.z};
    return wd_pack_normal(normal);
}

/* Along a leaf, of any length: as v grows on its texture. */
static struct wd_vec3 along_of(const struct triangle *triangle)
{
    const float(*uv)[2] = triangle->uv;
    return wd_v3_sub(wd_v3_scale(triangle->c, uv[1][0] - uv[0][0]),
                     wd_v3_scale(triangle->b, uv[2][0] - uv[0][0]));
}

/* Two axes of the plane across a unit normal (Duff et al. 2017). */
static void plane_axes(const float n[3], struct wd_vec3 axes[2])
{
    float sign = n[2] < 0 ? -1.0f : 1.0f, a = -1 / (sign + n[2]), b = n[0] * n[1] * a;
    axes[0] = WD_V3(1 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]);
    axes[1] = WD_V3(b, sign + n[1] * n[1] * a, -n[1]);
}

/* In WD_POINT_ALONG's steps of half a turn from one axis of the face's plane to where it points back. */
static uint32_t pack_along(uint32_t face, struct wd_vec3 along)
{
    struct wd_vec3 axes[2];
    float n[3];
    wd_unpack_normal(face, n);
    plane_axes(n, axes);
    float x = wd_v3_dot(along, axes[0]), y = wd_v3_dot(along, axes[1]);
    float sum = fabsf(x) + fabsf(y), share = sum > 0 ? (y < 0 ? -x : x) / sum : 0;
    return (uint32_t)wd_clampf((share + 1) * 0.5f * WD_POINT_ALONG, 0, WD_POINT_ALONG - 1);
}

struct wd_vec3 wd_point_along(const struct wd_tree_point *point)
{
    struct wd_vec3 axes[2];
    float n[3], step = (float)(point->kind >> WD_POINT_ALONG_BIT & (WD_POINT_ALONG - 1)) + 0.5f;
    wd_unpack_normal(point->face, n);
    plane_axes(n, axes);
    float x = step * (2.0f / WD_POINT_ALONG) - 1;
    return wd_v3_unit(wd_v3_mad(wd_v3_scale(axes[0], x), axes[1], 1 - fabsf(x)));
}

/* The point at `area` of the triangle at `place`. */
static void sample_point(struct wd_tree_point *point, const struct surface *surface,
                         const struct wd_point_look *look, uint32_t index, double area,
                         size_t place, float area_m2)
{
    double within = surface->below[place + 1] - surface->below[place];
    float u = within > 0 ? (float)((area - surface->below[place]) / within) : 0;
    float v = wd_hash_unit(wd_hash2(index, KEY)), side = sqrtf(u);
    const float weight[3] = {1 - side, side * (1 - v), side * v};
    const struct triangle triangle = triangle_of(surface->mesh, surface->order[place]);
    struct blend blend = blend_corners(&triangle, weight);
    struct wd_vec3 n = wd_v3_unit(WD_V3(blend.normal[0], blend.normal[1], blend.normal[2]));
    const float normal[3] = {n.x, n.y, n.z};
    bool wood = place < surface->wood_count;
    uint32_t layer = wd_vertex_layer(triangle.vertices[0]->kind);
    const uint8_t *color = texel(look, layer, blend.uv);
    float albedo[3];
    for (int k = 0; k < 3; k++) {
        point->position_m[k] = blend.position_m[k];
        albedo[k] = blend.tint[k] * wd_srgb_decode(color[k]);
    }
    point->normal = wd_pack_normal(normal);
    point->face = wood ? point->normal : face_of(&triangle);
    point->albedo = pack_albedo(albedo, blend.tint[3]);
    point->kind = (uint32_t)wd_clampf(blend.flexibility + 0.5f, 0, 255) |
                  (wood ? WD_POINT_ONE_SIDED : WD_POINT_LEAF) |
                  pack_along(point->face, along_of(&triangle)) << WD_POINT_ALONG_BIT |
                  (wd_pack_uv(0, area_m2) & 0xffff0000u);
}

/* Each of 2^bits equal parts of the area holds one point at most: they are made in the order of the curve,
 * along which triangles and their corners lie close together. */
static void sample_points(struct wd_tree_points *points, const struct surface *surface,
                          const struct wd_point_look *look, float area_m2)
{
    int bits = 0;
    while (((size_t)1 << bits) < points->count)
        bits++;
    uint32_t *held = wd_alloc_array((size_t)1 << bits, sizeof *held); /* 1 + index, 0 none */
    for (uint32_t i = 0; i < points->count; i++)
        held[(uint64_t)wd_scrambled_radical(i, KEY) >> (32 - bits)] = i + 1;
    for (size_t part = 0, place = 0; part >> bits == 0; part++) {
        if (!held[part])
            continue;
        uint32_t index = held[part] - 1;
        double share = (double)wd_scrambled_radical(index, KEY) / 4294967296.0;
        double area = share * surface->below[surface->count];
        while (place + 1 < surface->count && surface->below[place + 1] <= area)
            place++;
        sample_point(&points->points[index], surface, look, index, area, place, area_m2);
    }
    free(held);
}

bool wd_tree_points_build(struct wd_tree_points *points, const struct wd_tree_mesh *mesh,
                          const struct wd_point_look *look, size_t count)
{
    *points = (struct wd_tree_points){0};
    struct surface surface;
    surface_init(&surface, mesh);
    double area = surface.below[surface.count];
    if (area > 0 && count > 0) {
        points->points = wd_alloc_array(count, sizeof *points->points);
        points->count = count;
        points->wood_area_m2 = (float)surface.below[surface.wood_count];
        points->leaf_area_m2 = (float)(area - surface.below[surface.wood_count]);
        sample_points(points, &surface, look, (float)(area / (double)count));
    }
    surface_finish(&surface);
    return points->count > 0;
}

void wd_tree_points_finish(struct wd_tree_points *points)
{
    free(points->points);
    free(points->lit);
    *points = (struct wd_tree_points){0};
}
