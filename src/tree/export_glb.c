#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "tree/export.h"
#include "tree/glb.h"

static const uint64_t max_bytes = UINT64_C(1) << 31;
/* glTF has no attributes of 32-bit integers; floats are whole up to here. */
static const uint32_t max_id = UINT32_C(1) << 24;

struct export {
    const struct wd_export *what;
    struct wd_glb glb;
    int sampler;
    struct material {
        const struct wd_species *species;
        uint32_t layer;
        int index;
    } *materials;
    size_t material_count, material_capacity;
};

/* z up to y up. */
static void turn(const float from[3], float to[3])
{
    float x = from[0], y = from[1], z = from[2];
    to[0] = x;
    to[1] = z;
    to[2] = -y;
}

/* --- materials --------------------------------------------------------------------------- */

static json_t *texture(struct export *export, const uint8_t *png, size_t size)
{
    int view = wd_glb_view(&export->glb, png, size, WD_GLB_NO_TARGET);
    int image = wd_glb_add(&export->glb, "images", json_pack("{s:i,s:s}", "bufferView", view,
                                                             "mimeType", "image/png"));
    int index = wd_glb_add(&export->glb, "textures",
                           json_pack("{s:i,s:i}", "sampler", export->sampler, "source", image));
    return json_pack("{s:i}", "index", index);
}

static json_t *make_material(struct export *export, const struct wd_species *species,
                             uint32_t layer)
{
    static const char *const names[] = {"wood", "leaf", "back", "flower"};
    struct wd_export_maps maps;
    if (!wd_export_maps_make(&maps, species, layer, WD_EXPORT_TEXTURE)) {
        wd_export_maps_finish(&maps);
        return NULL;
    }
    char *name = wd_format("%s %s", species->name, names[layer & 3]);
    json_t *surface = json_pack("{s:o,s:f,s:f}", "baseColorTexture",
                                texture(export, maps.color, maps.color_size), "metallicFactor",
                                0.0, "roughnessFactor", maps.surface ? 1.0 : 0.8);
    if (maps.surface)
        json_object_set_new(surface, "metallicRoughnessTexture",
                            texture(export, maps.surface, maps.surface_size));
    json_t *material = json_pack("{s:s,s:o}", "name", name, "pbrMetallicRoughness", surface);
    if (maps.normal)
        json_object_set_new(material, "normalTexture",
                            texture(export, maps.normal, maps.normal_size));
    if (layer != WD_LOOK_BARK)
        json_object_set_new(material, "doubleSided", json_true());
    if (maps.holes) {
        json_object_set_new(material, "alphaMode", json_string("MASK"));
        json_object_set_new(material, "alphaCutoff", json_real(0.5));
    }
    free(name);
    wd_export_maps_finish(&maps);
    return material;
}

/* The index of a species' material, made on first use; -1: no memory. */
static int material_of(struct export *export, const struct wd_species *species, uint32_t layer)
{
    for (size_t i = 0; i < export->material_count; i++)
        if (export->materials[i].species == species && export->materials[i].layer == layer)
            return export->materials[i].index;
    json_t *made = make_material(export, species, layer);
    if (!made)
        return -1;
    struct material *material =
        wd_push(export->materials, export->material_count, export->material_capacity);
    *material = (struct material){species, layer, wd_glb_add(&export->glb, "materials", made)};
    return material->index;
}

/* --- meshes ------------------------------------------------------------------------------ */

static json_t *put_vertices(struct wd_glb *glb, const struct wd_tree_mesh *mesh)
{
    size_t count = mesh->vertex_count;
    float(*position)[3] = wd_alloc_array(count, sizeof *position);
    float(*normal)[3] = wd_alloc_array(count, sizeof *normal);
    float(*uv)[2] = wd_alloc_array(count, sizeof *uv);
    uint32_t *color = wd_alloc_array(count, sizeof *color);
    for (size_t i = 0; i < count; i++) {
        const struct wd_tree_vertex *vertex = &mesh->vertices[i];
        float unpacked[3];
        wd_unpack_normal(vertex->normal, unpacked);
        turn(vertex->position_m, position[i]);
        turn(unpacked, normal[i]);
        wd_unpack_uv(vertex->uv, uv[i]);
        color[i] = vertex->tint | 0xff000000u;
    }
    const struct wd_glb_array arrays[] = {
        {position, count, 3, WD_GLB_FLOAT, WD_GLB_VERTICES, true},
        {normal, count, 3, WD_GLB_FLOAT, WD_GLB_VERTICES, false},
        {uv, count, 2, WD_GLB_FLOAT, WD_GLB_VERTICES, false},
        {color, count, 4, WD_GLB_BYTE, WD_GLB_VERTICES, false},
    };
    static const char *const names[] = {"POSITION", "NORMAL", "TEXCOORD_0", "COLOR_0"};
    json_t *attributes = json_object();
    for (int i = 0; i < 4; i++)
        json_object_set_new(attributes, names[i], json_integer(wd_glb_accessor(glb, &arrays[i])));
    free(position);
    free(normal);
    free(uv);
    free(color);
    return attributes;
}

/* The triangles of one layer; nothing where there are none. False: no memory. */
static bool put_layer(struct export *export, const struct wd_tree_mesh *mesh,
                      const struct wd_species *species, uint32_t layer, json_t *attributes,
                      json_t *primitives)
{
    uint32_t *indices = wd_alloc_array(mesh->index_count + 1, sizeof *indices);
    size_t count = 0;
    for (uint32_t i = 0; i + 2 < mesh->index_count; i += 3)
        if (wd_vertex_layer(mesh->vertices[mesh->indices[i]].kind) == layer)
            for (uint32_t k = 0; k < 3; k++)
                indices[count++] = mesh->indices[i + k];
    int material = count ? material_of(export, species, layer) : 0;
    if (count && material >= 0) {
        const struct wd_glb_array array = {indices, count, 1, WD_GLB_UINT, WD_GLB_INDICES, false};
        json_array_append_new(primitives,
                              json_pack("{s:O,s:i,s:i}", "attributes", attributes, "indices",
                                        wd_glb_accessor(&export->glb, &array), "material",
                                        material));
    }
    free(indices);
    return material >= 0;
}

static int put_mesh(struct export *export, const struct wd_tree_mesh *mesh,
                    const struct wd_species *species, const char *name)
{
    static const uint32_t layers[] = {WD_LOOK_BARK, WD_LOOK_LEAF, WD_LOOK_FLOWER};
    json_t *attributes = put_vertices(&export->glb, mesh), *primitives = json_array();
    bool ok = true;
    for (size_t i = 0; i < sizeof layers / sizeof *layers && ok; i++)
        ok = put_layer(export, mesh, species, layers[i], attributes, primitives);
    json_decref(attributes);
    int index = wd_glb_add(&export->glb, "meshes",
                           json_pack("{s:s,s:o}", "name", name, "primitives", primitives));
    return ok ? index : -1;
}

/* --- nodes ------------------------------------------------------------------------------- */

/* Mirrored ones stand under nodes that mirror in x, M; there T R(yaw) S M = M T' R(-yaw) S, with T' at
 * -x. No scale of theirs is below zero: instancing does not turn the winding of triangles. */
static void place_instance(const struct wd_export_instance *from, float translation[3],
                           float rotation[4], float scale[3])
{
    float side = from->across < 0 ? -1.0f : 1.0f;
    turn(from->position_m, translation);
    translation[0] *= side;
    rotation[1] = side * sinf(0.5f * from->yaw_rad);
    rotation[3] = cosf(0.5f * from->yaw_rad);
    scale[0] = scale[2] = fabsf(from->across);
    scale[1] = from->up;
}

/* Accessors of the places that all levels of a tree share, mirrored ones or the others; NULL: none. */
static json_t *put_instances(struct wd_glb *glb, const struct wd_export_tree *tree, bool mirrored)
{
    size_t most = tree->instance_count, count = 0;
    float(*translation)[3] = wd_alloc_array(most + 1, sizeof *translation);
    float(*rotation)[4] = wd_alloc_array(most + 1, sizeof *rotation);
    float(*scale)[3] = wd_alloc_array(most + 1, sizeof *scale), *id = wd_alloc_array(most + 1, 4);
    for (size_t i = 0; i < most; i++) {
        const struct wd_export_instance *from = &tree->instances[i];
        if ((from->across < 0) != mirrored)
            continue;
        place_instance(from, translation[count], rotation[count], scale[count]);
        id[count++] = (float)from->id;
    }
    const struct wd_glb_array arrays[] = {
        {translation, count, 3, WD_GLB_FLOAT, WD_GLB_NO_TARGET, true},
        {rotation, count, 4, WD_GLB_FLOAT, WD_GLB_NO_TARGET, false},
        {scale, count, 3, WD_GLB_FLOAT, WD_GLB_NO_TARGET, false},
        {id, count, 1, WD_GLB_FLOAT, WD_GLB_NO_TARGET, false},
    };
    static const char *const names[] = {"TRANSLATION", "ROTATION", "SCALE", "_TREE_ID"};
    json_t *attributes = count ? json_object() : NULL;
    for (int i = 0; i < 4 && count; i++)
        json_object_set_new(attributes, names[i], json_integer(wd_glb_accessor(glb, &arrays[i])));
    free(translation);
    free(rotation);
    free(scale);
    free(id);
    return attributes;
}

/* What the nodes of a tree's levels share. */
struct level_node {
    const struct wd_export_tree *tree;
    json_t *instances; /* NULL: a tree alone */
    bool mirrored;
};

static json_t *make_node(struct wd_glb *glb, const struct level_node *of, int mesh, uint32_t level)
{
    const struct wd_export_tree *tree = of->tree;
    char *name = wd_format("%s%s LOD%u", tree->name, of->mirrored ? " mirrored" : "", level);
    json_t *node = json_pack("{s:s,s:i}", "name", name, "mesh", mesh);
    free(name);
    if (tree->place_m != 0)
        json_object_set_new(node, "translation", json_pack("[f,f,f]", tree->place_m, 0.0, 0.0));
    if (of->mirrored)
        json_object_set_new(node, "scale", json_pack("[i,i,i]", -1, 1, 1));
    if (of->instances) {
        json_object_set_new(node, "extensions",
                            json_pack("{s:{s:O}}", "EXT_mesh_gpu_instancing", "attributes",
                                      of->instances));
        wd_glb_use(glb, "EXT_mesh_gpu_instancing");
    }
    return node;
}

/* Nodes of the lower levels stand outside the scene; the first one names them (MSFT_lod). */
static void link_levels(struct wd_glb *glb, json_t *first, const int *nodes, uint32_t count)
{
    static const double coverage[] = {0.3, 0.05, 0.01, 0.0};
    json_t *ids = json_array(), *screen = json_array();
    for (uint32_t i = 1; i < count; i++)
        json_array_append_new(ids, json_integer(nodes[i]));
    for (uint32_t i = 0; i < count; i++)
        json_array_append_new(screen, json_real(i + 1 < count ? coverage[i] : 0.0));
    json_t *extensions = json_object_get(first, "extensions");
    if (!extensions) {
        extensions = json_object();
        json_object_set_new(first, "extensions", extensions);
    }
    json_object_set_new(extensions, "MSFT_lod", json_pack("{s:o}", "ids", ids));
    json_object_set_new(first, "extras", json_pack("{s:o}", "MSFT_screencoverage", screen));
    wd_glb_use(glb, "MSFT_lod");
}

static void put_nodes(struct wd_glb *glb, const struct level_node *of, const int *meshes,
                      json_t *roots)
{
    int nodes[WD_EXPORT_LEVELS] = {0};
    uint32_t count = of->tree->level_count;
    for (uint32_t level = 0; level < count; level++)
        nodes[level] = wd_glb_add(glb, "nodes", make_node(glb, of, meshes[level], level));
    json_t *list = json_object_get(glb->root, "nodes");
    if (count > 1)
        link_levels(glb, json_array_get(list, (size_t)nodes[0]), nodes, count);
    json_array_append_new(roots, json_integer(nodes[0]));
}

static bool put_tree(struct export *export, const struct wd_export_tree *tree, json_t *roots)
{
    int meshes[WD_EXPORT_LEVELS];
    for (uint32_t level = 0; level < tree->level_count; level++) {
        char *name = wd_format("%s LOD%u", tree->name, level);
        meshes[level] = put_mesh(export, tree->levels[level], tree->species, name);
        free(name);
        if (meshes[level] < 0)
            return false;
    }
    if (!tree->instances)
        put_nodes(&export->glb, &(struct level_node){tree, NULL, false}, meshes, roots);
    for (int mirrored = 0; mirrored < 2 && tree->instances; mirrored++) {
        json_t *instances = put_instances(&export->glb, tree, mirrored);
        if (instances)
            put_nodes(&export->glb, &(struct level_node){tree, instances, mirrored}, meshes, roots);
        json_decref(instances);
    }
    return true;
}

static void put_ground(struct wd_glb *glb, const struct wd_export_ground *ground, json_t *roots)
{
    size_t count = ground->vertex_count;
    float(*position)[3] = wd_alloc_array(count, sizeof *position);
    float(*normal)[3] = wd_alloc_array(count, sizeof *normal);
    for (size_t i = 0; i < count; i++) {
        turn(ground->positions_m[i], position[i]);
        turn(ground->normals[i], normal[i]);
    }
    const struct wd_glb_array arrays[] = {
        {position, count, 3, WD_GLB_FLOAT, WD_GLB_VERTICES, true},
        {normal, count, 3, WD_GLB_FLOAT, WD_GLB_VERTICES, false},
        {ground->indices, ground->index_count, 1, WD_GLB_UINT, WD_GLB_INDICES, false},
    };
    const float *c = ground->color;
    int material = wd_glb_add(
        glb, "materials",
        json_pack("{s:s,s:{s:[f,f,f,f],s:f,s:f}}", "name", "ground", "pbrMetallicRoughness",
                  "baseColorFactor", (double)c[0], (double)c[1], (double)c[2], 1.0,
                  "metallicFactor", 0.0, "roughnessFactor", 1.0));
    int places = wd_glb_accessor(glb, &arrays[0]), normals = wd_glb_accessor(glb, &arrays[1]);
    int indices = wd_glb_accessor(glb, &arrays[2]);
    int mesh = wd_glb_add(glb, "meshes",
                          json_pack("{s:s,s:[{s:{s:i,s:i},s:i,s:i}]}", "name", "ground",
                                    "primitives", "attributes", "POSITION", places, "NORMAL",
                                    normals, "indices", indices, "material", material));
    json_array_append_new(roots, json_integer(wd_glb_add(glb, "nodes",
                                                         json_pack("{s:s,s:i}", "name", "ground",
                                                                   "mesh", mesh))));
    free(position);
    free(normal);
}

/* --- the whole --------------------------------------------------------------------------- */

static bool check_size(const struct wd_export *what, const char *path, const struct wd_log *log)
{
    enum { VERTEX_BYTES = 36, INSTANCE_BYTES = 44, GROUND_BYTES = 24 };
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < what->tree_count; i++) {
        const struct wd_export_tree *tree = &what->trees[i];
        bytes += (uint64_t)tree->instance_count * INSTANCE_BYTES;
        for (uint32_t level = 0; level < tree->level_count; level++)
            bytes += (uint64_t)tree->levels[level]->vertex_count * VERTEX_BYTES +
                     (uint64_t)tree->levels[level]->index_count * 4;
    }
    if (what->ground)
        bytes += (uint64_t)what->ground->vertex_count * GROUND_BYTES +
                 (uint64_t)what->ground->index_count * 4;
    return bytes < max_bytes ||
           wd_error(log, "%s: needs %.1f GB; a GLB of at most %.1f GB is written: take fewer "
                    "species, variants or trees", path, (double)bytes / 1e9,
                    (double)max_bytes / 1e9);
}

static bool check_ids(const struct wd_export *what, const char *path, const struct wd_log *log)
{
    for (uint32_t i = 0; i < what->tree_count; i++)
        for (uint32_t k = 0; k < what->trees[i].instance_count; k++)
            if (what->trees[i].instances[k].id > max_id)
                return wd_error(log, "%s: has a tree with the id %u; a GLB holds ids up to %u: take fewer trees",
                                path, what->trees[i].instances[k].id, max_id);
    return true;
}

static void put_scene(struct wd_glb *glb, const struct wd_export *what, json_t *roots)
{
    json_t *scene = json_pack("{s:o}", "nodes", roots);
    const double *o = what->origin_m;
    if (what->ground)
        json_object_set_new(scene, "extras",
                            json_pack("{s:[f,f,f],s:s*}", "origin_m", o[0], o[1], o[2], "crs",
                                      what->crs));
    wd_glb_add(glb, "scenes", scene);
    json_object_set_new(glb->root, "scene", json_integer(0));
}

static enum wd_result put_trees(struct export *export, const char *path, json_t *roots,
                                const struct wd_log *log)
{
    const struct wd_export *what = export->what;
    for (uint32_t i = 0; i < what->tree_count; i++) {
        if (!wd_progress_report(what->progress, "writing trees", i, what->tree_count))
            return WD_ERROR_INTERRUPTED;
        if (!put_tree(export, &what->trees[i], roots)) {
            wd_error(log, "%s: no memory for the textures of %s", path, what->trees[i].name);
            return WD_ERROR_MEMORY;
        }
    }
    return WD_OK;
}

enum wd_result wd_export_glb(const struct wd_export *what, const char *path,
                             const struct wd_log *log)
{
    if (!check_size(what, path, log) || !check_ids(what, path, log))
        return WD_ERROR_INPUT;
    struct export export = {.what = what};
    wd_glb_init(&export.glb);
    enum { LINEAR = 9729, LINEAR_MIPMAP_LINEAR = 9987, REPEAT = 10497 };
    export.sampler = wd_glb_add(&export.glb, "samplers",
                                json_pack("{s:i,s:i,s:i,s:i}", "magFilter", LINEAR, "minFilter",
                                          LINEAR_MIPMAP_LINEAR, "wrapS", REPEAT, "wrapT", REPEAT));
    json_t *roots = json_array();
    enum wd_result result = put_trees(&export, path, roots, log);
    if (what->ground)
        put_ground(&export.glb, what->ground, roots);
    put_scene(&export.glb, what, roots);
    if (result == WD_OK)
        result = wd_glb_write(&export.glb, path, what->progress, log);
    wd_glb_finish(&export.glb);
    free(export.materials);
    return result;
}
