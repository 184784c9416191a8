/* model_parts.h: what the reading process hands over, and who fills it in. */
#ifndef WD_TREE_MODEL_PARTS_H
#define WD_TREE_MODEL_PARTS_H

#include "tree/model_file.h"

enum {
    WD_MODEL_MAX_TRIANGLES = 20000000,
    WD_MODEL_MAX_MESHES = 100000,
    WD_MODEL_MAX_MATERIALS = 4096,
    WD_MODEL_MAX_IMAGES = 1024,
};

/* Begins the shared memory; the arrays follow in the order of the counts, each from a multiple of
 * 16 bytes on. */
struct wd_model_header {
    uint32_t ready; /* 1: whole; 0: `message` says why not */
    uint32_t warning_count; /* of a whole one: `message` is the first of so many */
    uint32_t vertex_count, index_count, mesh_count, material_count, image_count;
    uint32_t stray_points, stray_lines;
    uint64_t byte_count;
    char message[480];
};

/* Offsets of vertices, indices, meshes, materials, images, bytes, and of the end. */
void wd_model_layout(const struct wd_model_header *header, uint64_t offsets[7]);

/* Runs assimp and fills the shared memory at `file`. Only for the reading process. */
void wd_model_parse(const char *path, int file);

#endif
