#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/point_locale.h"
#include "tree/export.h"

struct obj {
    const struct wd_export *what;
    const char *path;
    char *stem;          /* the path without its ending */
    const char *base;    /* the last part of it */
    FILE *text, *library;
    uint64_t vertex_base;
    const struct wd_log *log;
};

static const char *layer_name(uint32_t layer)
{
    return layer == WD_LOOK_BARK ? "wood" : layer == WD_LOOK_FLOWER ? "flower" : "leaf";
}

/* Names in these files end at a blank. */
static char *plain_name(const char *name)
{
    char *copy = wd_strdup(name);
    for (char *c = copy; *c; c++)
        if ((unsigned char)*c <= ' ' || *c == '/' || *c == '%')
            *c = '_';
    return copy;
}

static bool write_bytes(const char *path, const void *bytes, size_t size, const struct wd_log *log)
{
    struct wd_output_file file;
    if (!wd_output_open(&file, path, log))
        return false;
    fwrite(bytes, 1, size, file.stream);
    return wd_output_commit(&file, log);
}

/* --- materials --------------------------------------------------------------------------- */

static bool uses_layer(const struct wd_tree_mesh *mesh, uint32_t layer)
{
    for (uint32_t i = 0; i < mesh->index_count; i += 3)
        if (wd_vertex_layer(mesh->vertices[mesh->indices[i]].kind) == layer)
            return true;
    return false;
}

static bool put_material(struct obj *obj, const struct wd_export_tree *tree, uint32_t layer)
{
    struct wd_export_maps maps;
    char *species = plain_name(tree->species->name);
    const char *part = layer_name(layer);
    bool ok = wd_export_maps_make(&maps, tree->species, layer, WD_EXPORT_TEXTURE);
    char *file = wd_format("%s-%s-%s.png", obj->stem, species, part);
    ok = ok && write_bytes(file, maps.color, maps.color_size, obj->log);
    fprintf(obj->library, "newmtl %s-%s\nKd 1 1 1\nKs 0 0 0\nd 1\nillum 1\n", species, part);
    fprintf(obj->library, "map_Kd %s-%s-%s.png\n", obj->base, species, part);
    if (maps.holes)
        fprintf(obj->library, "map_d -imfchan m %s-%s-%s.png\n", obj->base, species, part);
    if (maps.normal) {
        char *normals = wd_format("%s-%s-%s-normal.png", obj->stem, species, part);
        ok = ok && write_bytes(normals, maps.normal, maps.normal_size, obj->log);
        fprintf(obj->library, "norm %s-%s-%s-normal.png\n", obj->base, species, part);
        free(normals);
    }
    fputc('\n', obj->library);
    wd_export_maps_finish(&maps);
    free(file);
    free(species);
    return ok;
}

static bool first_of_species(const struct wd_export *what, uint32_t index)
{
    for (uint32_t i = 0; i < index; i++)
        if (strcmp(what->trees[i].species->name, what->trees[index].species->name) == 0)
            return false;
    return true;
}

static bool put_materials(struct obj *obj)
{
    static const uint32_t layers[] = {WD_LOOK_BARK, WD_LOOK_LEAF, WD_LOOK_FLOWER};
    bool ok = true;
    for (uint32_t i = 0; i < obj->what->tree_count && ok; i++) {
        if (!first_of_species(obj->what, i))
            continue;
        for (int k = 0; k < 3 && ok; k++)
            if (uses_layer(obj->what->trees[i].levels[0], layers[k]))
                ok = put_material(obj, &obj->what->trees[i], layers[k]);
    }
    return ok;
}

/* --- geometry ---------------------------------------------------------------------------- */

static void put_vertices(struct obj *obj, const struct wd_export_tree *tree)
{
    const struct wd_tree_mesh *mesh = tree->levels[0];
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        const struct wd_tree_vertex *v = &mesh->vertices[i];
        float normal[3], uv[2];
        wd_unpack_normal(v->normal, normal);
        wd_unpack_uv(v->uv, uv);
        fprintf(obj->text, "v %.4f %.4f %.4f %.3g %.3g %.3g\n",
                (double)v->position_m[0] + tree->place_m, (double)v->position_m[2],
                (double)-v->position_m[1], (v->tint & 255) / 255.0, (v->tint >> 8 & 255) / 255.0,
                (v->tint >> 16 & 255) / 255.0);
        fprintf(obj->text, "vt %.5g %.5g\nvn %.4g %.4g %.4g\n", (double)uv[0], 1 - (double)uv[1],
                (double)normal[0], (double)normal[2], (double)-normal[1]);
    }
}

static void put_faces(struct obj *obj, const struct wd_export_tree *tree)
{
    const struct wd_tree_mesh *mesh = tree->levels[0];
    char *species = plain_name(tree->species->name);
    uint32_t layer = UINT32_MAX;
    for (uint32_t i = 0; i + 2 < mesh->index_count; i += 3) {
        uint32_t own = wd_vertex_layer(mesh->vertices[mesh->indices[i]].kind);
        if (own != layer)
            fprintf(obj->text, "usemtl %s-%s\n", species, layer_name(own));
        layer = own;
        fputc('f', obj->text);
        for (uint32_t k = 0; k < 3; k++) {
            unsigned long long at = obj->vertex_base + mesh->indices[i + k] + 1;
            fprintf(obj->text, " %llu/%llu/%llu", at, at, at);
        }
        fputc('\n', obj->text);
    }
    obj->vertex_base += mesh->vertex_count;
    free(species);
}

static bool put_geometry(struct obj *obj)
{
    struct wd_output_file file;
    if (!wd_output_open(&file, obj->path, obj->log))
        return false;
    obj->text = file.stream;
    fprintf(obj->text, "# metres, y up\nmtllib %s.mtl\n", obj->base);
    for (uint32_t i = 0; i < obj->what->tree_count; i++) {
        char *name = plain_name(obj->what->trees[i].name);
        fprintf(obj->text, "o %s\n", name);
        free(name);
        put_vertices(obj, &obj->what->trees[i]);
        put_faces(obj, &obj->what->trees[i]);
    }
    return wd_output_commit(&file, obj->log);
}

static bool put_files(struct obj *obj)
{
    char *library = wd_format("%s.mtl", obj->stem);
    struct wd_output_file file;
    bool ok = wd_output_open(&file, library, obj->log);
    if (ok) {
        obj->library = file.stream;
        ok = put_materials(obj);
        if (ok)
            ok = wd_output_commit(&file, obj->log) && put_geometry(obj);
        else
            wd_output_discard(&file);
    }
    free(library);
    return ok;
}

bool wd_export_obj(const struct wd_export *what, const char *path, const struct wd_log *log)
{
    struct obj obj = {.what = what, .path = path, .stem = wd_strdup(path), .log = log};
    *strrchr(obj.stem, '.') = '\0';
    const char *slash = strrchr(obj.stem, '/');
    obj.base = slash ? slash + 1 : obj.stem;
    struct wd_point_locale point;
    wd_point_locale_enter(&point);
    bool ok = put_files(&obj);
    wd_point_locale_leave(&point);
    free(obj.stem);
    return ok;
}

char *wd_export_obj_beside(const char *path, const char *species, uint32_t index)
{
    static const uint32_t layers[] = {WD_LOOK_BARK, WD_LOOK_LEAF, WD_LOOK_FLOWER};
    if (!wd_has_ending(path, ".obj") || index > 6)
        return NULL;
    int stem = (int)(strrchr(path, '.') - path);
    if (index == 0)
        return wd_format("%.*s.mtl", stem, path);
    char *plain = plain_name(species);
    char *name = wd_format("%.*s-%s-%s%s.png", stem, path, plain, layer_name(layers[(index - 1) / 2]),
                           index % 2 ? "" : "-normal");
    free(plain);
    return name;
}
