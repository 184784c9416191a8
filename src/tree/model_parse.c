/* Reading with assimp. Runs in a process of its own (model_file.c): a crash here is a message there,
 * and nothing needs to be freed. */
#include "tree/model_io.h"
#include "tree/model_parts.h"

#include <assimp/cimport.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <math.h>
#include <meshoptimizer.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"

/* One mesh of the scene where a node puts it. */
struct placed {
    const struct aiMesh *mesh;
    struct aiMatrix4x4 transform, normals;
};

struct parse {
    const struct aiScene *scene;
    struct placed *placed;
    size_t placed_count, placed_capacity;
    struct wd_model_header header;
    int file;
    uint8_t *base;
    uint64_t offsets[7];
    unsigned lower_levels; /* nodes that are left out */
};

static _Noreturn void give_up(const struct parse *parse, const char *format, ...)
{
    struct wd_model_header header = {0}; /* not ready */
    va_list args;
    va_start(args, format);
    vsnprintf(header.message, sizeof header.message, format, args);
    va_end(args);
    if (ftruncate(parse->file, 0) == 0 &&
        pwrite(parse->file, &header, sizeof header, 0) == (ssize_t)sizeof header)
        _exit(0);
    _exit(1);
}

/* Copies as much of `text` as fits. */
static void put_text(char *to, size_t size, const char *text)
{
    size_t length = strnlen(text, size - 1);
    memcpy(to, text, length);
    to[length] = '\0';
}

/* Smooth normals with creases take time with the square of loose triangles (of ten millions, half
 * an hour), joining vertices some 600 bytes for each: large files get both from finish_large. */
static bool is_large(const char *path)
{
    const off_t enough = (off_t)64 << 20;
    struct stat status;
    return stat(path, &status) == 0 && status.st_size > enough;
}

/* What assimp warns of, as triangles that it drops, is told: the first of it whole. Not that meshes share
 * vertices, of which each has some that it does not use: nothing is lost. */
static void keep_warning(const char *line, char *user)
{
    static const char mark[] = "Warn,", shared[] = "There are unreferenced vertices";
    struct wd_model_header *header = (void *)user;
    const char *text = strstr(line, ": ");
    if (strncmp(line, mark, strlen(mark)) != 0 || !text || strstr(text, shared))
        return;
    if (header->warning_count++ == 0)
        snprintf(header->message, sizeof header->message, "%.*s", (int)strcspn(text + 2, "\n"),
                 text + 2);
}

static void open_scene(struct parse *parse, const char *path)
{
    const struct aiLogStream warnings = {keep_warning, (void *)&parse->header};
    aiAttachLogStream(&warnings);
    unsigned steps = aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_FlipUVs |
                     aiProcess_ValidateDataStructure;
    if (!is_large(path))
        steps |= aiProcess_GenSmoothNormals | aiProcess_JoinIdenticalVertices;
    if (wd_has_ending(path, ".fbx"))
        steps |= aiProcess_GlobalScale;
    struct aiPropertyStore *store = aiCreatePropertyStore();
    aiSetImportPropertyFloat(store, AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, 70);
    struct wd_model_traits traits;
    struct aiFileIO *io = wd_model_io(path, &traits);
    if (traits.fault && !traits.broken)
        give_up(parse, "is not a model that can be read: %s", traits.fault);
    if (traits.whole_numbers)
        give_up(parse, "has its %s as whole numbers (quantized), which are not read; export it with floats",
                traits.whole_numbers);
    if (traits.skins)
        keep_warning("Warn,: has skins, which are not read: its vertices stand as they are in the file; apply "
                     "the pose before the export for another", (void *)&parse->header);
    parse->scene = aiImportFileExWithProperties(path, steps, io, store);
    if (!parse->scene && traits.fault)
        give_up(parse, "is not a model that can be read: %s", traits.fault);
    free(traits.fault);
    if (!parse->scene && wd_model_has_word(path, "EXT_meshopt_compression"))
        give_up(parse, "is compressed by EXT_meshopt_compression, which is not read; export it without");
    if (!parse->scene)
        give_up(parse, "is not a model that can be read: %s", aiGetErrorString());
    if (!parse->scene->mRootNode || parse->scene->mFlags & AI_SCENE_FLAGS_INCOMPLETE)
        give_up(parse, "holds no whole model");
}

/* --- nodes ------------------------------------------------------------------------------- */

/* Length of a name without the level of detail that it ends with, as Tree_LOD2 does; 0: with none. */
static size_t stem_of_level(const struct aiString *name, unsigned long *level)
{
    static const char mark[] = "lod";
    const char *text = name->data;
    size_t end = strnlen(text, sizeof name->data - 1), stem = end;
    while (stem > 0 && text[stem - 1] >= '0' && text[stem - 1] <= '9')
        stem--;
    if (stem == end || end - stem > 2 || stem < strlen(mark) ||
        strncasecmp(text + stem - strlen(mark), mark, strlen(mark)) != 0)
        return 0;
    *level = strtoul(text + stem, NULL, 10);
    return stem;
}

/* Levels of detail of one tree stand in one place; common exporters write all of them as nodes side by side. */
static bool is_lower_level(const struct aiNode *parent, const struct aiNode *node)
{
    unsigned long level, other;
    size_t stem = stem_of_level(&node->mName, &level);
    for (unsigned i = 0; stem && level && i < parent->mNumChildren; i++) {
        const struct aiString *name = &parent->mChildren[i]->mName;
        if (stem_of_level(name, &other) == stem && other < level &&
            strncasecmp(name->data, node->mName.data, stem) == 0)
            return true;
    }
    return false;
}

/* Turns normals as planes turn, not as arrows: what stretches a surface along an axis tilts them away from it. */
static struct aiMatrix4x4 normal_matrix(const struct aiMatrix4x4 *m)
{
    const float rows[3][3] = {{m->a1, m->a2, m->a3}, {m->b1, m->b2, m->b3}, {m->c1, m->c2, m->c3}};
    float most = 0, out[3][3], side = aiMatrix4Determinant(m) < 0 ? -1 : 1;
    for (int i = 0; i < 9; i++)
        most = fmaxf(most, fabsf(rows[i / 3][i % 3]));
    most = most > 0 ? most : 1;
    for (int i = 0; i < 3; i++) {
        const float *a = rows[(i + 1) % 3], *b = rows[(i + 2) % 3];
        for (int k = 0, l = 1, n = 2; k < 3; k++, l = (l + 1) % 3, n = (n + 1) % 3)
            out[i][k] = side * (a[l] / most * (b[n] / most) - a[n] / most * (b[l] / most));
    }
    return (struct aiMatrix4x4){.a1 = out[0][0], .a2 = out[0][1], .a3 = out[0][2],
                                .b1 = out[1][0], .b2 = out[1][1], .b3 = out[1][2],
                                .c1 = out[2][0], .c2 = out[2][1], .c3 = out[2][2]};
}

static void place(struct parse *parse, const struct aiMesh *mesh,
                  const struct aiMatrix4x4 *transform)
{
    struct wd_model_header *header = &parse->header;
    if (mesh->mPrimitiveTypes & aiPrimitiveType_POINT)
        header->stray_points += mesh->mNumFaces;
    else if (mesh->mPrimitiveTypes & aiPrimitiveType_LINE)
        header->stray_lines += mesh->mNumFaces;
    if (!(mesh->mPrimitiveTypes & aiPrimitiveType_TRIANGLE))
        return;
    uint64_t triangles = header->index_count / 3 + (uint64_t)mesh->mNumFaces;
    if (triangles > WD_MODEL_MAX_TRIANGLES)
        give_up(parse, "has more than %d triangles; reduce it first", WD_MODEL_MAX_TRIANGLES);
    if ((uint64_t)header->vertex_count + mesh->mNumVertices > 3 * (uint64_t)WD_MODEL_MAX_TRIANGLES)
        give_up(parse, "has more than %d vertices; reduce it first", 3 * WD_MODEL_MAX_TRIANGLES);
    if (parse->placed_count >= WD_MODEL_MAX_MESHES)
        give_up(parse, "has more than %d meshes", WD_MODEL_MAX_MESHES);
    if (parse->placed_count == parse->placed_capacity) {
        parse->placed_capacity = parse->placed_capacity ? 2 * parse->placed_capacity : 64;
        parse->placed = realloc(parse->placed, parse->placed_capacity * sizeof *parse->placed);
        if (!parse->placed)
            give_up(parse, "has more meshes than fit into memory");
    }
    parse->placed[parse->placed_count++] = (struct placed){mesh, *transform, normal_matrix(transform)};
    header->vertex_count += mesh->mNumVertices;
    header->index_count += 3 * mesh->mNumFaces;
    header->mesh_count++;
}

static void walk(struct parse *parse, const struct aiNode *node, struct aiMatrix4x4 transform,
                 unsigned depth)
{
    enum { MAX_DEPTH = 1000 };
    if (depth > MAX_DEPTH)
        give_up(parse, "nests nodes deeper than %d", MAX_DEPTH);
    struct aiMatrix4x4 own = node->mTransformation;
    aiMultiplyMatrix4(&transform, &own);
    for (unsigned i = 0; i < node->mNumMeshes; i++)
        place(parse, parse->scene->mMeshes[node->mMeshes[i]], &transform);
    for (unsigned i = 0; i < node->mNumChildren; i++)
        if (is_lower_level(node, node->mChildren[i]))
            parse->lower_levels++;
        else
            walk(parse, node->mChildren[i], transform, depth + 1);
}

/* --- vertices ---------------------------------------------------------------------------- */

static void apply(const struct aiMatrix4x4 *m, const struct aiVector3D *v, float w, float out[3])
{
    out[0] = m->a1 * v->x + m->a2 * v->y + m->a3 * v->z + m->a4 * w;
    out[1] = m->b1 * v->x + m->b2 * v->y + m->b3 * v->z + m->b4 * w;
    out[2] = m->c1 * v->x + m->c2 * v->y + m->c3 * v->z + m->c4 * w;
}

static uint8_t unorm8(float value)
{
    return value >= 1 ? 255 : value > 0 ? (uint8_t)(value * 255 + 0.5f) : 0;
}

static void put_vertex(struct wd_file_vertex *to, const struct placed *from, unsigned i)
{
    const struct aiMesh *mesh = from->mesh;
    apply(&from->transform, &mesh->mVertices[i], 1, to->position);
    if (mesh->mNormals)
        apply(&from->normals, &mesh->mNormals[i], 0, to->normal);
    if (mesh->mTextureCoords[0]) {
        to->uv[0] = mesh->mTextureCoords[0][i].x;
        to->uv[1] = mesh->mTextureCoords[0][i].y;
    }
    const struct aiColor4D *c = mesh->mColors[0] ? &mesh->mColors[0][i] : NULL;
    for (int k = 0; k < 4; k++)
        to->rgba[k] = 255;
    if (c) {
        to->rgba[0] = unorm8(c->r);
        to->rgba[1] = unorm8(c->g);
        to->rgba[2] = unorm8(c->b);
    }
}

/* Of a mesh without: the sum of the triangles around each vertex, by area. */
static void put_normals(struct wd_file_vertex *vertices, const uint32_t *indices, uint32_t first,
                        uint32_t end)
{
    for (uint32_t i = first; i + 2 < end; i += 3) {
        const float *a = vertices[indices[i]].position, *b = vertices[indices[i + 1]].position;
        const float *c = vertices[indices[i + 2]].position;
        float x[3], y[3];
        for (int k = 0; k < 3; k++) {
            x[k] = b[k] - a[k];
            y[k] = c[k] - a[k];
        }
        for (uint32_t corner = i; corner < i + 3; corner++)
            for (int k = 0; k < 3; k++)
                vertices[indices[corner]].normal[k] +=
                    x[(k + 1) % 3] * y[(k + 2) % 3] - x[(k + 2) % 3] * y[(k + 1) % 3];
    }
}

static void put_geometry(struct parse *parse)
{
    struct wd_file_vertex *vertices = (void *)(parse->base + parse->offsets[0]);
    uint32_t *indices = (void *)(parse->base + parse->offsets[1]);
    struct wd_file_mesh *meshes = (void *)(parse->base + parse->offsets[2]);
    uint32_t vertex = 0, index = 0;
    for (size_t i = 0; i < parse->placed_count; i++) {
        const struct placed *placed = &parse->placed[i];
        const struct aiMesh *mesh = placed->mesh;
        bool mirrored = aiMatrix4Determinant(&placed->transform) < 0;
        meshes[i].material = mesh->mMaterialIndex;
        meshes[i].first_index = index;
        put_text(meshes[i].name, sizeof meshes[i].name,
                 mesh->mName.length ? mesh->mName.data : "unnamed");
        for (unsigned v = 0; v < mesh->mNumVertices; v++)
            put_vertex(&vertices[vertex + v], placed, v);
        for (unsigned f = 0; f < mesh->mNumFaces; f++) {
            const struct aiFace *face = &mesh->mFaces[f];
            if (face->mNumIndices != 3)
                continue;
            for (int k = 0; k < 3; k++) { /* a mirroring node turns triangles over */
                if (face->mIndices[k] >= mesh->mNumVertices)
                    give_up(parse, "mesh %s: index %u is out of range: it has %u vertices",
                            meshes[i].name, face->mIndices[k], mesh->mNumVertices);
                indices[index++] = vertex + face->mIndices[mirrored ? 2 - k : k];
            }
        }
        meshes[i].index_count = index - meshes[i].first_index;
        vertex += mesh->mNumVertices;
    }
}

/* Equal vertices become one, and meshes without normals get them. */
static void finish_large(struct parse *parse)
{
    struct wd_file_vertex *vertices = (void *)(parse->base + parse->offsets[0]);
    uint32_t *indices = (void *)(parse->base + parse->offsets[1]);
    const struct wd_file_mesh *meshes = (void *)(parse->base + parse->offsets[2]);
    size_t count = parse->header.index_count;
    uint32_t *own = malloc((count + 1) * sizeof *own);
    if (!own)
        give_up(parse, "has more triangles than fit into memory");
    /* cppcheck-suppress nullPointerRedundantCheck; give_up does not return */
    memcpy(own, indices, count * sizeof *own);
    meshopt_generateShadowIndexBuffer(indices, own, count, vertices, parse->header.vertex_count,
                                      sizeof *vertices, sizeof *vertices);
    free(own);
    for (size_t i = 0; i < parse->placed_count; i++)
        if (!parse->placed[i].mesh->mNormals)
            put_normals(vertices, indices, meshes[i].first_index,
                        meshes[i].first_index + meshes[i].index_count);
}

/* --- materials --------------------------------------------------------------------------- */

static bool get_texture(const struct aiMaterial *material, enum aiTextureType type, char *to,
                        size_t size)
{
    struct aiString path;
    if (aiGetMaterialTexture(material, type, 0, &path, NULL, NULL, NULL, NULL, NULL, NULL) !=
        aiReturn_SUCCESS)
        return false;
    put_text(to, size, path.data);
    return to[0] != '\0';
}

static bool get_name(const struct aiMaterial *material, const char *key, struct aiString *text)
{
    return aiGetMaterialString(material, key, 0, 0, text) == aiReturn_SUCCESS;
}

/* Colours of MTL files multiply textures by the letter, but common exporters leave any number
 * there: with a texture they are not used. */
static void put_material(struct wd_file_material *to, const struct aiMaterial *material, bool gltf)
{
    struct aiString text;
    struct aiColor4D color = {0.5f, 0.5f, 0.5f, 1};
    int two_sided = 0;
    put_text(to->name, sizeof to->name,
             get_name(material, "?mat.name", &text) ? text.data : "unnamed");
    if (!get_texture(material, aiTextureType_BASE_COLOR, to->texture, sizeof to->texture))
        get_texture(material, aiTextureType_DIFFUSE, to->texture, sizeof to->texture);
    get_texture(material, aiTextureType_OPACITY, to->cutout, sizeof to->cutout);
    if (aiGetMaterialColor(material, AI_MATKEY_BASE_COLOR, &color) != aiReturn_SUCCESS)
        aiGetMaterialColor(material, AI_MATKEY_COLOR_DIFFUSE, &color);
    if (to->texture[0] && !gltf)
        color = (struct aiColor4D){1, 1, 1, 1};
    memcpy(to->color, (float[4]){color.r, color.g, color.b, color.a}, sizeof to->color);
    aiGetMaterialIntegerArray(material, AI_MATKEY_TWOSIDED, &two_sided, NULL);
    to->two_sided = two_sided != 0;
    to->says_alpha = gltf || to->cutout[0];
    if (get_name(material, "$mat.gltf.alphaMode", &text))
        to->blended = strcmp(text.data, "OPAQUE") != 0;
    else
        to->blended = to->cutout[0] != '\0';
}

static uint64_t image_bytes(const struct aiTexture *texture)
{
    return texture->mHeight == 0 ? texture->mWidth : 0; /* uncompressed texels are not read */
}

static void put_materials(struct parse *parse)
{
    struct wd_file_material *materials = (void *)(parse->base + parse->offsets[3]);
    struct wd_file_image *images = (void *)(parse->base + parse->offsets[4]);
    const struct aiScene *scene = parse->scene;
    struct aiString text;
    uint64_t at = 0;
    for (unsigned i = 0; i < scene->mNumMaterials; i++) {
        bool gltf = get_name(scene->mMaterials[i], "$mat.gltf.alphaMode", &text);
        put_material(&materials[i], scene->mMaterials[i], gltf);
    }
    for (unsigned i = 0; i < scene->mNumTextures; i++) {
        const struct aiTexture *texture = scene->mTextures[i];
        images[i] = (struct wd_file_image){at, image_bytes(texture)};
        memcpy(parse->base + parse->offsets[5] + at, texture->pcData, images[i].size);
        at += images[i].size;
    }
}

/* --- the whole --------------------------------------------------------------------------- */

void wd_model_parse(const char *path, int file)
{
    struct parse parse = {.file = file};
    struct aiMatrix4x4 identity;
    aiIdentityMatrix4(&identity);
    open_scene(&parse, path);
    walk(&parse, parse.scene->mRootNode, identity, 0);
    const struct aiScene *scene = parse.scene;
    if (parse.lower_levels) {
        char line[128];
        snprintf(line, sizeof line, "Warn,: has lower levels of detail, by their names; left out: %u nodes",
                 parse.lower_levels);
        keep_warning(line, (void *)&parse.header);
    }
    if (parse.header.index_count == 0)
        give_up(&parse, "has no triangles");
    if (scene->mNumMaterials > WD_MODEL_MAX_MATERIALS || scene->mNumTextures > WD_MODEL_MAX_IMAGES)
        give_up(&parse, "has %u materials and %u images; at most %d and %d are read",
                scene->mNumMaterials, scene->mNumTextures, WD_MODEL_MAX_MATERIALS,
                WD_MODEL_MAX_IMAGES);
    parse.header.material_count = scene->mNumMaterials;
    parse.header.image_count = scene->mNumTextures;
    for (unsigned i = 0; i < scene->mNumTextures; i++)
        parse.header.byte_count += image_bytes(scene->mTextures[i]);
    wd_model_layout(&parse.header, parse.offsets);
    if (ftruncate(file, (off_t)parse.offsets[6]))
        give_up(&parse, "does not fit into memory");
    parse.base = mmap(NULL, parse.offsets[6], PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (parse.base == MAP_FAILED)
        give_up(&parse, "does not fit into memory");
    put_geometry(&parse);
    if (is_large(path))
        finish_large(&parse);
    put_materials(&parse);
    parse.header.ready = 1;
    memcpy(parse.base, &parse.header, sizeof parse.header);
}
