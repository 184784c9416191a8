#include "tree/model_material.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/color.h"
#include "base/file.h"
#include "base/memory.h"
#include "tree/model_beside.h"

enum { MAX_TEXTURE_BYTES = 256 << 20 };

/* --- pictures ---------------------------------------------------------------------------- */

struct loader {
    struct wd_model_materials *materials;
    const struct wd_model_file *file;
    const char *path;
    const struct wd_log *log;
};

static bool decode_embedded(const struct loader *loader, const char *texture,
                            struct wd_model_image *image, const char **why)
{
    unsigned long index = strtoul(texture + 1, NULL, 10);
    if (index >= loader->file->image_count) {
        *why = "there is no such image in the file";
        return false;
    }
    const struct wd_file_image *from = &loader->file->images[index];
    return wd_model_image_decode(image, loader->file->bytes + from->offset, from->size, why);
}

static bool load_image(const struct loader *loader, const char *texture, const char *material,
                       struct wd_model_image *image)
{
    const char *why = "there is no such file";
    bool ok = false;
    if (texture[0] == '*') {
        ok = decode_embedded(loader, texture, image, &why);
    } else {
        char *path = wd_model_beside(loader->path, texture), *bytes = NULL;
        size_t size;
        if (wd_file_is_plain(path) &&
            wd_file_read(path, MAX_TEXTURE_BYTES, loader->log, &bytes, &size))
            ok = wd_model_image_decode(image, (const uint8_t *)bytes, size, &why);
        free(bytes);
        free(path);
    }
    if (!ok)
        wd_warn(loader->log, "%s: material %s: texture %s cannot be used: %s; its colour stands in",
                loader->path, material, texture, why);
    return ok;
}

/* Alpha of a picture of opacity: its own where it has any, else how light it is. */
static void cut_out(struct wd_model_image *image, const struct wd_model_image *cutout)
{
    size_t count = (size_t)cutout->width * cutout->height;
    bool alpha = false;
    for (size_t i = 0; i < count && !alpha; i++)
        alpha = cutout->rgba[4 * i + 3] != 255;
    for (uint32_t y = 0; y < image->height; y++) {
        for (uint32_t x = 0; x < image->width; x++) {
            size_t row = (size_t)y * cutout->height / image->height;
            size_t column = (size_t)x * cutout->width / image->width;
            const uint8_t *from = cutout->rgba + 4 * (row * cutout->width + column);
            image->rgba[4 * ((size_t)y * image->width + x) + 3] = alpha ? from[3] : from[1];
        }
    }
}

/* Formats without a word on it (all but glTF) leave alpha to the texture: of leaves a hole, of bark often gloss.
 * Holes are clear, and many. */
static bool has_clear_texels(const struct wd_model_image *image)
{
    size_t count = (size_t)image->width * image->height, clear = 0, between = 0;
    for (size_t i = 0; i < count; i++) {
        uint8_t alpha = image->rgba[4 * i + 3];
        clear += alpha < 16;
        between += alpha >= 16 && alpha < 240;
    }
    return clear > count / 20 && clear < count && between < clear;
}

/* Mean of the texels that show; holes get that colour, so that filtering never darkens an edge. */
static void settle(struct wd_model_picture *picture, bool alpha_counts)
{
    struct wd_model_image *image = &picture->image;
    size_t count = (size_t)image->width * image->height, shown = 0;
    double sum[3] = {0};
    for (size_t i = 0; i < count; i++) {
        uint8_t *texel = image->rgba + 4 * i;
        if (!alpha_counts)
            texel[3] = 255;
        if (texel[3] < 128)
            continue;
        shown++;
        for (int k = 0; k < 3; k++)
            sum[k] += (double)wd_srgb_decode(texel[k]);
    }
    uint8_t mean[3];
    for (int k = 0; k < 3; k++) {
        picture->mean[k] = shown ? (float)(sum[k] / (double)shown) : 0.5f;
        mean[k] = wd_srgb_encode(picture->mean[k]);
    }
    picture->holes = shown < count - count / 200;
    for (size_t i = 0; i < count; i++)
        if (image->rgba[4 * i + 3] < 16)
            memcpy(image->rgba + 4 * i, mean, 3);
}

static int find_picture(const struct wd_model_materials *materials,
                        const struct wd_file_material *material)
{
    for (size_t i = 0; i < materials->picture_count; i++)
        if (strcmp(materials->pictures[i].texture, material->texture) == 0 &&
            strcmp(materials->pictures[i].cutout, material->cutout) == 0)
            return (int)i;
    return -1;
}

static int load_picture(const struct loader *loader, const struct wd_file_material *material)
{
    struct wd_model_materials *materials = loader->materials;
    if (!material->texture[0])
        return -1;
    int known = find_picture(materials, material);
    if (known >= 0)
        return known;
    struct wd_model_picture picture = {material->texture, material->cutout, {0}, {0}, false};
    struct wd_model_image cutout;
    if (!load_image(loader, material->texture, material->name, &picture.image))
        return -1;
    if (material->cutout[0] &&
        load_image(loader, material->cutout, material->name, &cutout)) {
        cut_out(&picture.image, &cutout);
        wd_model_image_finish(&cutout);
    }
    settle(&picture, material->blended || (!material->says_alpha && has_clear_texels(&picture.image)));
    *wd_push(materials->pictures, materials->picture_count, materials->picture_capacity) = picture;
    return (int)materials->picture_count - 1;
}

/* --- leaf or wood ------------------------------------------------------------------------ */

static int count_words(const char *name, const char *const *words)
{
    int found = 0;
    for (; *words; words++)
        found += strcasestr(name, *words) != NULL;
    return found;
}

/* Above 0: a leaf. Words in the languages of common model libraries. */
static int score_name(const char *name)
{
    static const char *const leaf[] = {"leaf", "leav", "foliage", "needle", "frond", "petal",
                                       "flower", "grass", "blade", "blatt", "nadel", "feuil",
                                       "hoja", "folha", "twig", "crown", NULL};
    static const char *const wood[] = {"trunk", "bark", "branch", "stem", "wood", "stamm", "rinde",
                                       "tronc", "holz", "root", "log", NULL};
    return count_words(name, leaf) - count_words(name, wood);
}

static bool is_green(const float c[3])
{
    return c[1] > 1.08f * c[0] && c[1] > 1.15f * c[2];
}

static void mean_color(const struct wd_model_materials *materials,
                       const struct wd_model_material *material, float color[3])
{
    for (int k = 0; k < 3; k++)
        color[k] = material->color[k] *
                   (material->picture >= 0 ? materials->pictures[material->picture].mean[k] : 1);
}

/* By how many corners of triangles have a colour. */
static void mean_of_vertices(struct wd_model_materials *materials, const struct wd_model_file *file)
{
    double (*sums)[4] = wd_alloc_array(materials->count + 1, sizeof *sums);
    memset(sums, 0, (materials->count + 1) * sizeof *sums);
    for (uint32_t i = 0; i < file->mesh_count; i++) {
        const struct wd_file_mesh *mesh = &file->meshes[i];
        double *sum = sums[mesh->material];
        for (uint32_t k = 0; k < mesh->index_count; k++)
            for (int c = 0; c < 3; c++)
                sum[c] += file->vertices[file->indices[mesh->first_index + k]].rgba[c];
        sum[3] += 255.0 * mesh->index_count;
    }
    for (size_t i = 0; i < materials->count; i++)
        for (int c = 0; c < 3; c++)
            materials->items[i].vertex_mean[c] = sums[i][3] > 0 ? (float)(sums[i][c] / sums[i][3]) : 1;
    free(sums);
}

/* Not what is white, blue or violet: petals keep their colour. */
static void darken_leaf(struct wd_model_materials *materials, struct wd_model_material *material,
                        float most)
{
    float color[3];
    mean_color(materials, material, color);
    for (int k = 0; k < 3; k++)
        color[k] *= material->vertex_mean[k];
    float luminance = 0.2126f * color[0] + 0.7152f * color[1] + 0.0722f * color[2];
    for (int k = 0; k < 3 && luminance > most && color[1] > 1.3f * color[2]; k++)
        material->color[k] *= most / luminance;
}

static bool looks_like_leaf(const struct wd_model_materials *materials,
                            const struct wd_model_material *material)
{
    float color[3];
    int name = score_name(material->file->name);
    if (material->picture >= 0 && materials->pictures[material->picture].holes)
        return true; /* cards, of twigs with their leaves where the name is that of a branch */
    if (name != 0)
        return name > 0;
    mean_color(materials, material, color);
    return is_green(color) || material->file->two_sided;
}

static bool apply_list(struct wd_model_materials *materials, const char *path, const char *key,
                       const char *const *names, size_t count, bool leaf,
                       const struct wd_log *log)
{
    for (size_t i = 0; i < count; i++) {
        bool found = false;
        for (size_t m = 0; m < materials->count; m++) {
            if (strcasecmp(materials->items[m].file->name, names[i]) == 0) {
                materials->items[m].leaf = leaf;
                found = true;
            }
        }
        char list[512] = "";
        for (size_t m = 0, used = 0; m < materials->count && used < sizeof list; m++)
            used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", m ? ", " : "",
                                     materials->items[m].file->name);
        if (!found)
            return wd_error(log, "%s: no material \"%s\", which \"%s\" names; there are: %s", path,
                            names[i], key, list);
    }
    return true;
}

bool wd_model_materials_init(struct wd_model_materials *materials, const struct wd_model_file *file,
                             const struct wd_species *species, const struct wd_log *log)
{
    const char *path = species->model.file;
    *materials = (struct wd_model_materials){
        .items = wd_alloc_array(file->material_count, sizeof *materials->items),
        .count = file->material_count,
    };
    const struct loader loader = {materials, file, path, log};
    for (uint32_t i = 0; i < file->mesh_count; i++)
        materials->items[file->meshes[i].material].used |= file->meshes[i].index_count > 0;
    for (size_t i = 0; i < materials->count; i++) {
        struct wd_model_material *material = &materials->items[i];
        material->file = &file->materials[i];
        material->picture = material->used ? load_picture(&loader, material->file) : -1;
        for (int k = 0; k < 3; k++)
            material->color[k] = fminf(fmaxf(material->file->color[k], 0), 1); /* 0 of NaN */
        material->leaf = looks_like_leaf(materials, material);
    }
    mean_of_vertices(materials, file);
    bool ok = apply_list(materials, path, "leaves", species->model.leaves,
                         species->model.leaf_count, true, log) &&
              apply_list(materials, path, "wood", species->model.wood, species->model.wood_count,
                         false, log);
    for (size_t i = 0; i < materials->count && ok; i++)
        if (materials->items[i].leaf)
            darken_leaf(materials, &materials->items[i], species->model.leaf_reflectance);
    if (!ok)
        wd_model_materials_finish(materials);
    return ok;
}

void wd_model_materials_finish(struct wd_model_materials *materials)
{
    for (size_t i = 0; i < materials->picture_count; i++)
        wd_model_image_finish(&materials->pictures[i].image);
    free(materials->pictures);
    free(materials->items);
    *materials = (struct wd_model_materials){0};
}
