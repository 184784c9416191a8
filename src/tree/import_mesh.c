#include <math.h>
#include <meshoptimizer.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "shared/hash.h"
#include "tree/density.h"
#include "tree/import_parts.h"

/* --- triangles of the file --------------------------------------------------------------- */

static bool finite3(const float v[3])
{
    return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]) && fabsf(v[0]) < 1e18f &&
           fabsf(v[1]) < 1e18f && fabsf(v[2]) < 1e18f;
}

static bool check_positions(const struct wd_import_work *work, const struct wd_file_mesh *mesh)
{
    const struct wd_model_file *file = work->file;
    for (uint32_t i = 0; i < mesh->index_count; i++) {
        const struct wd_file_vertex *v =
            &file->vertices[file->indices[mesh->first_index + i]];
        if (!finite3(v->position))
            return wd_error(work->log, "%s: mesh %s: vertex %u is at %g, %g, %g",
                            work->species->model.file, mesh->name,
                            file->indices[mesh->first_index + i], (double)v->position[0],
                            (double)v->position[1], (double)v->position[2]);
    }
    return true;
}

static bool has_area(const struct wd_model_file *file, const uint32_t index[3])
{
    struct wd_vec3 p[3];
    for (int k = 0; k < 3; k++) {
        const float *v = file->vertices[index[k]].position;
        p[k] = WD_V3(v[0], v[1], v[2]);
    }
    struct wd_vec3 a = wd_v3_sub(p[1], p[0]), b = wd_v3_sub(p[2], p[0]);
    float area = wd_v3_length(wd_v3_cross(a, b));
    return area > 1e-9f * (wd_v3_dot(a, a) + wd_v3_dot(b, b)) && isfinite(area);
}

static void add_triangle(struct wd_import_work *work, const struct wd_file_mesh *mesh,
                         const uint32_t index[3])
{
    if (!has_area(work->file, index)) {
        work->degenerate++;
        return;
    }
    const struct wd_model_material *material = &work->materials->items[mesh->material];
    struct wd_look_sheet *sheet = &work->import->looks[material->leaf];
    float uv[3][2], shift[2];
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 2; k++) {
            float value = work->file->vertices[index[i]].uv[k];
            uv[i][k] = isfinite(value) && fabsf(value) < 1e4f ? value : 0;
        }
    }
    wd_look_sheet_add(sheet, material->picture, (const float(*)[2])uv, shift);
    for (int i = 0; i < 3; i++)
        work->corners[work->corner_count++] = (struct wd_import_corner){
            index[i], mesh->material, {uv[i][0] - shift[0], uv[i][1] - shift[1]}, material->leaf};
    work->wood_corners += material->leaf ? 0 : 3;
}

/* One triangle, by lot, of each of so many equal parts of the list. */
static size_t sample(const uint32_t *indices, size_t count, size_t target, uint32_t *kept)
{
    size_t all = count / 3, wanted = target / 3;
    for (size_t i = 0; i < wanted; i++) {
        size_t first = i * all / wanted, end = (i + 1) * all / wanted;
        size_t pick = first + wd_hash1((uint32_t)i) % (end - first);
        memcpy(kept + 3 * i, indices + 3 * pick, 3 * sizeof *kept);
    }
    return 3 * wanted;
}

/* A mesh's share of the triangles that are allowed, by shape where that suffices, by count where
 * not: loose leaves cannot be simplified. Of triangles that cross the whole model, which no grid of
 * cells holds apart, some are left out. */
static size_t simplify(const struct wd_import_work *work, const struct wd_file_mesh *mesh,
                       size_t most_triangles, uint32_t *kept)
{
    const struct wd_model_file *file = work->file;
    const uint32_t *indices = file->indices + mesh->first_index;
    size_t target = (size_t)((double)most_triangles * mesh->index_count / file->index_count) * 3;
    const float *positions = file->vertices[0].position;
    size_t stride = sizeof *file->vertices;
    size_t count = meshopt_simplify(kept, indices, mesh->index_count, positions,
                                    file->vertex_count, stride, target, 0.01f, 0, NULL);
    if (count > target + target / 2)
        count = meshopt_simplifySloppy(kept, indices, mesh->index_count, positions,
                                       file->vertex_count, stride, target, 1, NULL);
    if (count < target / 4 && target < mesh->index_count)
        count = sample(indices, mesh->index_count, target, kept);
    return count;
}

static void collect_mesh(struct wd_import_work *work, const struct wd_file_mesh *mesh,
                         size_t most_triangles)
{
    const uint32_t *indices = work->file->indices + mesh->first_index;
    size_t count = mesh->index_count;
    uint32_t *kept = NULL;
    if (work->file->index_count / 3 > most_triangles) {
        kept = wd_alloc_array(count + 1, sizeof *kept);
        count = simplify(work, mesh, most_triangles, kept);
        indices = kept;
    }
    for (size_t i = 0; i + 2 < count; i += 3)
        add_triangle(work, mesh, indices + i);
    free(kept);
}

bool wd_import_collect(struct wd_import_work *work, size_t most_triangles)
{
    const struct wd_model_file *file = work->file;
    if (file->index_count / 3 > most_triangles)
        wd_info(work->log, "%s: has %u triangles, simplified to about %zu",
                work->species->model.file, file->index_count / 3, most_triangles);
    work->corners = wd_alloc_array((size_t)file->index_count + 1, sizeof *work->corners);
    for (uint32_t i = 0; i < file->mesh_count; i++)
        if (!check_positions(work, &file->meshes[i]))
            return false;
    for (uint32_t i = 0; i < file->mesh_count; i++)
        collect_mesh(work, &file->meshes[i], most_triangles);
    for (int leaf = 0; leaf < 2; leaf++)
        wd_look_sheet_lay_out(&work->import->looks[leaf]);
    return work->corner_count > 0 || wd_error(work->log, "%s: no triangle of it has an area",
                                              work->species->model.file);
}

void wd_import_index(struct wd_tree_mesh *mesh, struct wd_tree_vertex *corners, uint32_t *indices,
                     size_t count)
{
    uint32_t *remap = wd_alloc_array(count + 1, sizeof *remap);
    size_t unique = meshopt_generateVertexRemap(remap, NULL, count, corners, count,
                                                sizeof *corners);
    meshopt_remapIndexBuffer(indices, NULL, count, remap);
    mesh->vertices = wd_alloc_array(unique, sizeof *mesh->vertices);
    meshopt_remapVertexBuffer(mesh->vertices, corners, count, sizeof *corners, remap);
    mesh->vertex_count = mesh->vertex_capacity = (uint32_t)unique;
    mesh->indices = indices;
    mesh->index_count = mesh->index_capacity = (uint32_t)count;
    free(remap);
    free(corners);
    wd_tree_mesh_update_bounds(mesh);
}

/* --- figures ----------------------------------------------------------------------------- */

static struct wd_vec3 position(const struct wd_tree_mesh *mesh, uint32_t index)
{
    const float *p = mesh->vertices[mesh->indices[index]].position_m;
    return WD_V3(p[0], p[1], p[2]);
}

static float triangle_area(const struct wd_tree_mesh *mesh, uint32_t first, struct wd_vec3 *middle)
{
    struct wd_vec3 a = position(mesh, first), b = position(mesh, first + 1);
    struct wd_vec3 c = position(mesh, first + 2);
    *middle = wd_v3_scale(wd_v3_add(a, wd_v3_add(b, c)), 1.0f / 3);
    return 0.5f * wd_v3_length(wd_v3_cross(wd_v3_sub(b, a), wd_v3_sub(c, a)));
}

void wd_import_shade(struct wd_tree_mesh *mesh)
{
    const float cells = 28; /* along the height */
    struct wd_tree_density density;
    struct wd_vec3 low = WD_V3(mesh->min_m[0], mesh->min_m[1], mesh->min_m[2]);
    struct wd_vec3 high = WD_V3(mesh->max_m[0], mesh->max_m[1], mesh->max_m[2]);
    wd_tree_density_init(&density, low, high, (high.z - low.z) / cells);
    for (uint32_t i = mesh->wood_index_count; i + 2 < mesh->index_count; i += 3) {
        struct wd_vec3 middle;
        float area = triangle_area(mesh, i, &middle);
        wd_tree_density_add(&density, middle, area);
    }
    wd_tree_density_light(&density);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        struct wd_tree_vertex *vertex = &mesh->vertices[i];
        struct wd_vec3 p = WD_V3(vertex->position_m[0], vertex->position_m[1],
                                 vertex->position_m[2]);
        float sky = fminf(fmaxf(wd_tree_density_sky(&density, p), 0), 1);
        vertex->tint = (vertex->tint & 0xffffffu) | (uint32_t)(sky * 255 + 0.5f) << 24;
    }
    wd_tree_density_finish(&density);
}

enum { SECTORS = 16 };

static int sector_of(struct wd_vec3 p)
{
    double turn = wd_datan2((double)p.y, (double)p.x) / (2 * WD_PI) + 0.5;
    return (int)(turn * SECTORS) % SECTORS;
}

/* Mean over the sectors of how far the crown (or all, where there are no leaves) reaches. */
static float crown_radius(const struct wd_tree_mesh *mesh)
{
    float reach[SECTORS] = {0}, sum = 0;
    bool leaves = mesh->wood_index_count < mesh->index_count;
    for (uint32_t i = leaves ? mesh->wood_index_count : 0; i < mesh->index_count; i++) {
        struct wd_vec3 p = position(mesh, i);
        int sector = sector_of(p);
        reach[sector] = fmaxf(reach[sector], sqrtf(p.x * p.x + p.y * p.y));
    }
    for (int i = 0; i < SECTORS; i++)
        sum += reach[i];
    return sum / SECTORS;
}

/* Nearest crossing of the wood with the plane at 1.3 m in each sector about the foot: the stem;
 * branches lie beyond it. */
static float stem_diameter(const struct wd_tree_mesh *mesh, float at_m)
{
    float nearest[SECTORS], sum = 0;
    int found = 0;
    for (int i = 0; i < SECTORS; i++)
        nearest[i] = INFINITY;
    for (uint32_t i = 0; i + 2 < mesh->wood_index_count; i += 3) {
        for (uint32_t k = 0; k < 3; k++) {
            struct wd_vec3 a = position(mesh, i + k), b = position(mesh, i + (k + 1) % 3);
            if ((a.z < at_m) == (b.z < at_m))
                continue;
            struct wd_vec3 p = wd_v3_mix(a, b, (at_m - a.z) / (b.z - a.z));
            int sector = sector_of(p);
            nearest[sector] = fminf(nearest[sector], sqrtf(p.x * p.x + p.y * p.y));
        }
    }
    for (int i = 0; i < SECTORS; i++) {
        if (isfinite(nearest[i])) {
            sum += nearest[i];
            found++;
        }
    }
    return found ? 2 * sum / (float)found : 0;
}

/* Height below which a twentieth of the leaf area hangs. */
static float crown_base(const struct wd_tree_mesh *mesh, float leaf_area)
{
    enum { STEPS = 256 };
    float by_height[STEPS] = {0}, sum = 0, tall = fmaxf(mesh->max_m[2], 1e-6f);
    for (uint32_t i = mesh->wood_index_count; i + 2 < mesh->index_count; i += 3) {
        struct wd_vec3 middle;
        float area = triangle_area(mesh, i, &middle);
        int step = (int)(fmaxf(middle.z, 0) / tall * STEPS);
        by_height[step < STEPS ? step : STEPS - 1] += area;
    }
    for (int step = 0; step < STEPS; step++) {
        sum += by_height[step];
        if (sum > 0.05f * leaf_area)
            return tall * (float)step / STEPS;
    }
    return 0;
}

void wd_import_measure(struct wd_tree_model *model)
{
    const struct wd_tree_mesh *full = &model->full;
    double area = 0;
    for (uint32_t i = full->wood_index_count; i + 2 < full->index_count; i += 3) {
        struct wd_vec3 middle;
        area += (double)triangle_area(full, i, &middle);
    }
    model->height_m = full->max_m[2];
    model->leaf_area_m2 = (float)area;
    model->crown_radius_m = crown_radius(full);
    model->crown_base_m = crown_base(full, model->leaf_area_m2);
    model->dbh_m = stem_diameter(full, fminf(1.3f, 0.3f * model->height_m));
}
