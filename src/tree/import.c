#include "tree/import.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "tree/clip_mesh.h"
#include "tree/import_parts.h"
#include "tree/model_io.h"
#include "tree/model_obj.h"
#include "tree/model_reduce.h"
#include "tree/openness.h"
#include "tree/vec.h"

enum {
    MOST_TRIANGLES = 600000, /* of the full mesh */
    REDUCED_WOOD_TRIANGLES = 1600,
    REDUCED_LEAF_TRIANGLES = 5200,  /* at least */
    REDUCED_MOST_TRIANGLES = 30000,
    TALLEST_TREE_M = 130,
};

static const float SMALLEST_TREE_M = 0.01f;

/* --- axes and units ---------------------------------------------------------------------- */

struct frame {
    int up;          /* enum wd_model_axis, no longer AUTO */
    float scale;     /* of the file's units to metres */
    float foot[3];   /* z up, in the file's units: goes to (0, 0, 0) */
};

static void turn(int up, const float from[3], float to[3])
{
    const float x = from[0], y = from[1], z = from[2];
    to[0] = up == WD_AXIS_X ? -z : x;
    to[1] = up == WD_AXIS_Z ? y : up == WD_AXIS_X ? y : -z;
    to[2] = up == WD_AXIS_Z ? z : up == WD_AXIS_X ? x : y;
}

struct box {
    float low[3], high[3];
};

static void box_add(struct box *box, const float p[3])
{
    for (int k = 0; k < 3; k++) {
        box->low[k] = fminf(box->low[k], p[k]);
        box->high[k] = fmaxf(box->high[k], p[k]);
    }
}

static const struct box empty_box = {{INFINITY, INFINITY, INFINITY},
                                     {-INFINITY, -INFINITY, -INFINITY}};

/* y, as formats and common exporters have it, unless the model plainly stands on z = 0. */
static int guess_up(const struct box *box)
{
    float tall_y = box->high[1] - box->low[1], tall_z = box->high[2] - box->low[2];
    bool on_z = fabsf(box->low[2]) < 0.03f * tall_z;
    bool on_y = fabsf(box->low[1]) < 0.2f * tall_y;
    return on_z && !on_y && tall_z > 0.5f * tall_y ? WD_AXIS_Z : WD_AXIS_Y;
}

static const float unit_m[] = {[WD_UNIT_M] = 1,         [WD_UNIT_CM] = 0.01f, [WD_UNIT_MM] = 0.001f,
                               [WD_UNIT_FT] = 0.3048f, [WD_UNIT_IN] = 0.0254f};

static float guess_scale(const struct wd_species *species, float tall)
{
    if (species->model.height_m > 0)
        return species->model.height_m / tall;
    if (species->model.unit != WD_UNIT_AUTO)
        return unit_m[species->model.unit];
    if (tall <= TALLEST_TREE_M)
        return 1;
    return tall * 0.01f <= TALLEST_TREE_M ? 0.01f : 0.001f;
}

/* Middle of the wood's lowest two percent of the height, at its very bottom. Returns how wide they are. */
static float find_foot(struct wd_import_work *work, float tall, float foot[3])
{
    struct box all = empty_box, low = empty_box;
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < work->corner_count; i++) {
            float p[3];
            const struct wd_import_corner *corner = &work->corners[i];
            if (corner->leaf && work->wood_corners)
                continue;
            turn(work->up, work->file->vertices[corner->vertex].position, p);
            if (pass == 0)
                box_add(&all, p);
            else if (p[2] <= all.low[2] + 0.02f * tall)
                box_add(&low, p);
        }
    }
    foot[0] = 0.5f * (low.low[0] + low.high[0]);
    foot[1] = 0.5f * (low.low[1] + low.high[1]);
    foot[2] = all.low[2];
    return fmaxf(low.high[0] - low.low[0], low.high[1] - low.low[1]);
}

/* What is read well and still is no tree as meant. */
static void warn_of_size(const struct wd_import_work *work, float tall_m, float wide_m)
{
    const char *file = work->species->model.file;
    if (tall_m < SMALLEST_TREE_M || tall_m > TALLEST_TREE_M * 1.01f)
        wd_warn(work->log, "%s: is %.3g m high with 1 unit = %g m; its height (\"height_m\", or --height for one "
                "tree) sets it right", file, (double)tall_m, (double)work->metres_a_unit);
    if (work->wood_corners && wide_m > tall_m)
        wd_warn(work->log, "%s: stands on wood %.3g m wide, but is only %.3g m high: it may lie on its side (\"up\" "
                "sets that right), have ground with it, or be more than one tree", file, (double)wide_m,
                (double)tall_m);
}

static bool settle_frame(struct wd_import_work *work, struct frame *frame)
{
    struct box box = empty_box, turned = empty_box;
    for (size_t i = 0; i < work->corner_count; i++)
        box_add(&box, work->file->vertices[work->corners[i].vertex].position);
    work->up = work->species->model.up == WD_AXIS_AUTO ? guess_up(&box) : work->species->model.up;
    for (size_t i = 0; i < work->corner_count; i++) {
        float p[3];
        turn(work->up, work->file->vertices[work->corners[i].vertex].position, p);
        box_add(&turned, p);
    }
    float tall = turned.high[2] - turned.low[2];
    frame->up = work->up;
    if (!(tall > 1e-20f && tall < 1e20f))
        return wd_error(work->log, "%s: the model has no height along its %c axis",
                        work->species->model.file, "?xyz"[work->up]);
    frame->scale = guess_scale(work->species, tall);
    float wide = find_foot(work, tall, frame->foot);
    work->metres_a_unit = frame->scale;
    warn_of_size(work, tall * frame->scale, wide * frame->scale);
    return true;
}

/* --- the mesh ---------------------------------------------------------------------------- */

static uint32_t corner_tint(const struct wd_model_material *material, const uint8_t rgba[4])
{
    uint32_t packed = 255u << 24;
    for (int k = 0; k < 3; k++) {
        float value = material->color[k] * (float)rgba[k] + 0.5f;
        packed |= (uint32_t)fminf(fmaxf(value, 0), 255) << (8 * k);
    }
    return packed;
}

static struct wd_tree_vertex make_vertex(struct wd_import_work *work,
                                         const struct frame *frame,
                                         const struct wd_import_corner *corner)
{
    const struct wd_file_vertex *from = &work->file->vertices[corner->vertex];
    const struct wd_model_material *material = &work->materials->items[corner->material];
    struct wd_tree_vertex vertex = {.tint = corner_tint(material, from->rgba)};
    float p[3], n[3];
    turn(frame->up, from->position, p);
    turn(frame->up, from->normal, n);
    for (int k = 0; k < 3; k++)
        vertex.position_m[k] = (p[k] - frame->foot[k]) * frame->scale;
    struct wd_vec3 normal = WD_V3(n[0], n[1], n[2]);
    if (!isfinite(wd_v3_dot(normal, normal))) {
        normal = WD_V3(0, 0, 1);
        work->broken_normals++;
    }
    normal = wd_v3_unit_or(normal, WD_V3(0, 0, 1));
    vertex.normal = wd_pack_normal((float[3]){normal.x, normal.y, normal.z});
    float uv[2];
    wd_look_sheet_map(&work->import->looks[corner->leaf], material->picture, corner->uv, uv);
    vertex.uv = wd_pack_uv(uv[0], uv[1]);
    if (corner->leaf)
        vertex.kind = WD_VERTEX_LEAF | 128u;
    return vertex;
}

static void build_full(struct wd_import_work *work, const struct frame *frame)
{
    struct wd_tree_mesh *mesh = &work->import->model.full;
    struct wd_tree_vertex *vertices = wd_alloc_array(work->corner_count, sizeof *vertices);
    uint32_t *indices = wd_alloc_array(work->corner_count, sizeof *indices);
    size_t at = 0;
    for (int leaf = 0; leaf < 2; leaf++) {
        for (size_t i = 0; i < work->corner_count; i++)
            if (work->corners[i].leaf == leaf)
                vertices[at++] = make_vertex(work, frame, &work->corners[i]);
        if (leaf == 0)
            mesh->wood_index_count = (uint32_t)at;
    }
    wd_import_index(mesh, vertices, indices, at);
}

/* A fifth of the leaves, within bounds: fewer would have to be enlarged too much. */
static void reduce(struct wd_tree_model *model)
{
    const struct wd_tree_mesh *full = &model->full;
    size_t leaves = (full->index_count - full->wood_index_count) / 3, target = leaves / 5;
    target = target < REDUCED_LEAF_TRIANGLES ? REDUCED_LEAF_TRIANGLES : target;
    target = target > REDUCED_MOST_TRIANGLES ? REDUCED_MOST_TRIANGLES : target;
    wd_tree_mesh_reduce_import(&model->reduced, full, REDUCED_WOOD_TRIANGLES, target);
}

/* --- the whole --------------------------------------------------------------------------- */

static void report(const struct wd_import_work *work)
{
    const struct wd_tree_import *import = work->import;
    const struct wd_tree_mesh *full = &import->model.full;
    char leaves[256] = "", *end = leaves;
    for (size_t i = 0; i < work->materials->count; i++)
        if (work->materials->items[i].used && work->materials->items[i].leaf &&
            (size_t)(end - leaves) < sizeof leaves)
            end += snprintf(end, sizeof leaves - (size_t)(end - leaves), "%s%s",
                            end == leaves ? "" : ", ", work->materials->items[i].file->name);
    wd_info(work->log,
            "%s: %u triangles of wood, %u of leaves (%s); %c up, 1 unit = %.4g m, %.1f m high",
            work->species->model.file, full->wood_index_count / 3,
            (full->index_count - full->wood_index_count) / 3, leaves[0] ? leaves : "no material",
            "?xyz"[work->up], (double)work->metres_a_unit, (double)import->model.height_m);
    if (work->file->stray_points || work->file->stray_lines || work->degenerate)
        wd_info(work->log, "%s: left out: %u points, %u lines, %zu triangles without area",
                work->species->model.file, work->file->stray_points, work->file->stray_lines,
                work->degenerate);
    if (work->broken_normals)
        wd_warn(work->log, "%s: %zu corners have normals that are no finite numbers: taken to look up",
                work->species->model.file, work->broken_normals);
}

/* glTF extensions for pictures of other kinds leave materials without any that can be found. */
static void warn_of_pictures(const struct wd_import_work *work)
{
    static const char *const unread[] = {"EXT_texture_webp", "KHR_texture_basisu"};
    for (size_t i = 0; i < sizeof unread / sizeof *unread; i++)
        if (wd_model_has_word(work->species->model.file, unread[i]))
            wd_warn(work->log, "%s: its textures come by %s, which is not read: materials' colours "
                    "stand in", work->species->model.file, unread[i]);
}

/* Of materials without a library the importing library makes one grey. */
static void warn_of_materials(const struct wd_import_work *work)
{
    char *lacks = wd_model_obj_lacks(work->species->model.file);
    if (lacks)
        wd_warn(work->log, "%s: %s: grey stands in", work->species->model.file, lacks);
    free(lacks);
}

static bool import_file(struct wd_tree_import *import, const struct wd_species *species,
                        const struct wd_log *log)
{
    struct wd_import_work work = {.import = import, .species = species, .file = &import->file,
                                  .materials = &import->materials, .log = log};
    struct frame frame = {0};
    bool ok = wd_model_file_read(&import->file, species->model.file, log) &&
              wd_model_materials_init(&import->materials, &import->file, species, log) &&
              wd_import_collect(&work, MOST_TRIANGLES) && settle_frame(&work, &frame);
    if (ok) {
        build_full(&work, &frame);
        wd_import_shade(&import->model.full);
        reduce(&import->model);
        wd_import_measure(&import->model);
        wd_tree_model_fit_openness(&import->model);
        warn_of_pictures(&work);
        warn_of_materials(&work);
        report(&work);
    }
    free(work.corners);
    return ok;
}

bool wd_tree_import(struct wd_tree_import *import, const struct wd_species *species,
                    const struct wd_log *log)
{
    *import = (struct wd_tree_import){0};
    if (import_file(import, species, log))
        return true;
    wd_tree_import_finish(import);
    return false;
}

void wd_tree_import_finish(struct wd_tree_import *import)
{
    wd_tree_model_finish(&import->model);
    wd_model_materials_finish(&import->materials);
    wd_model_file_finish(&import->file);
    for (int i = 0; i < 2; i++)
        wd_look_sheet_finish(&import->looks[i]);
    *import = (struct wd_tree_import){0};
}

void wd_tree_import_look(const struct wd_tree_import *import, const struct wd_look_map *map,
                         uint32_t layer)
{
    bool bark = layer == WD_LOOK_BARK;
    const uint8_t smooth[4] = {128, 128, bark ? 217 : 153, bark ? 255 : 128};
    wd_look_sheet_draw(&import->looks[!bark], import->materials.pictures, map->size, map->albedo);
    const struct wd_tree_mesh *mesh = &import->model.full;
    if (!import->looks[!bark].tiled)
        wd_import_fill(map->albedo, map->size, mesh, bark ? 0 : mesh->wood_index_count,
                       bark ? mesh->wood_index_count : mesh->index_count);
    for (size_t i = 0; i < (size_t)map->size * map->size; i++)
        memcpy(map->detail + 4 * i, smooth, sizeof smooth);
}

/* --- species ----------------------------------------------------------------------------- */

static bool import_species(struct wd_species *species, const struct wd_log *log)
{
    struct wd_tree_import *import = wd_alloc(sizeof *import);
    if (!wd_tree_import(import, species, log)) {
        free(import);
        return false;
    }
    species->imported = import;
    species->typical_height_m = import->model.height_m;
    if (!(species->allometry.crown_b > 0))
        species->model.crown_share = 2 * import->model.crown_radius_m / import->model.height_m;
    return true;
}

/* The mesh that a hedge is cut to. */
static bool import_clip(struct wd_species *species, const struct wd_log *log)
{
    struct wd_clip_mesh mesh;
    if (!wd_clip_mesh_read(&mesh, species->clip_file, log))
        return false;
    if (!(mesh.size_m[2] >= species->height_range_m[0] &&
          mesh.size_m[2] <= species->height_range_m[1])) {
        wd_clip_mesh_finish(&mesh);
        return wd_error(log, "%s is %g m high; the file of %s, which is to be cut to it, allows %g "
                             "to %g", species->clip_file, (double)mesh.size_m[2], species->name,
                        (double)species->height_range_m[0], (double)species->height_range_m[1]);
    }
    species->clip = wd_alloc(sizeof *species->clip);
    *species->clip = mesh;
    memcpy(species->clip_box_m, mesh.size_m, sizeof species->clip_box_m);
    return true;
}

bool wd_species_import_models(struct wd_species *species, size_t count,
                              const struct wd_progress *progress, const struct wd_log *log)
{
    size_t total = 0, done = 0;
    for (size_t i = 0; i < count; i++)
        total += species[i].model.file || species[i].clip_file;
    for (size_t i = 0; i < count; i++) {
        if (!species[i].model.file && !species[i].clip_file)
            continue;
        if (!wd_progress_report(progress, "reading models", done++, total))
            return false;
        if (species[i].model.file && !import_species(&species[i], log))
            return false;
        if (species[i].clip_file && !import_clip(&species[i], log))
            return false;
    }
    return true;
}

void wd_species_drop_models(struct wd_species *species, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (species[i].imported)
            wd_tree_import_finish(species[i].imported);
        free(species[i].imported);
        species[i].imported = NULL;
        if (species[i].clip)
            wd_clip_mesh_finish(species[i].clip);
        free(species[i].clip);
        species[i].clip = NULL;
    }
}
