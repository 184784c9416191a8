/* model_file.h: an artist's model as its file holds it: triangles and materials, nothing judged. */
#ifndef WD_TREE_MODEL_FILE_H
#define WD_TREE_MODEL_FILE_H

#include "base/log.h"

/* Axes and units are the file's own (assimp makes glTF, FBX and DAE y up, in metres). */
struct wd_file_vertex {
    float position[3], normal[3];
    float uv[2];   /* (0, 0) is the upper left of a texture */
    uint8_t rgba[4]; /* linear multiplier; white where the file says nothing */
};

struct wd_file_mesh {
    char name[96];
    uint32_t material;
    uint32_t first_index, index_count; /* three a triangle */
};

struct wd_file_material {
    char name[96];
    float color[4];       /* linear, alpha last */
    char texture[512];    /* file beside the model, "*N": embedded image N, or "" */
    char cutout[512];     /* a texture of opacity apart, or "" */
    uint8_t two_sided;
    uint8_t says_alpha, blended; /* whether the file says if alpha counts; and that it does */
};

struct wd_file_image {
    uint64_t offset, size; /* in wd_model_file.bytes: a PNG or JPEG file */
};

struct wd_model_file {
    const struct wd_file_vertex *vertices;
    const uint32_t *indices;
    const struct wd_file_mesh *meshes;
    const struct wd_file_material *materials;
    const struct wd_file_image *images;
    const uint8_t *bytes;
    uint32_t vertex_count, index_count, mesh_count, material_count, image_count;
    uint32_t stray_points, stray_lines; /* left out */
    void *block;     /* holds all of it */
    size_t block_size;
};

/* Reads a model in a process of its own with limits on time and memory: what a malformed file does
 * to the importing library stays there. Refuses files over 1 GiB and models over 20 million
 * triangles. Indices are in range afterwards; positions may still be NaN. On failure `{0}`. */
bool wd_model_file_read(struct wd_model_file *model, const char *path, const struct wd_log *log);
void wd_model_file_finish(struct wd_model_file *model);

#endif
