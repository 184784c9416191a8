/* import_parts.h: the steps of an import. */
#ifndef WD_TREE_IMPORT_PARTS_H
#define WD_TREE_IMPORT_PARTS_H

#include "tree/import.h"

/* A corner of a triangle; three follow one another. */
struct wd_import_corner {
    uint32_t vertex, material; /* of the file */
    float uv[2];               /* without whole turns */
    int leaf;                  /* 0 wood, 1 leaf: index into wd_tree_import.looks */
};

struct wd_import_work {
    struct wd_tree_import *import;
    const struct wd_species *species;
    const struct wd_model_file *file;
    const struct wd_model_materials *materials;
    struct wd_import_corner *corners;
    size_t corner_count, wood_corners;
    size_t degenerate;   /* triangles left out for want of area */
    size_t broken_normals; /* corners whose normal is not finite */
    int up;              /* enum wd_model_axis */
    float metres_a_unit;
    const struct wd_log *log;
};

/* Fills `corners` with at most `most_triangles` triangles (more are simplified first) and lays out
 * the looks. False where a position is not finite, or nothing is left. free(corners). */
bool wd_import_collect(struct wd_import_work *work, size_t most_triangles);

/* Makes an indexed mesh of `count` corners, equal ones shared; takes and frees both arrays. */
void wd_import_index(struct wd_tree_mesh *mesh, struct wd_tree_vertex *corners, uint32_t *indices,
                     size_t count);

/* Gives every vertex its openness to the sky through the model's own leaves. */
void wd_import_shade(struct wd_tree_mesh *mesh);

/* Colours the texels that no triangle of indices [begin, end) uses like those around them. */
void wd_import_fill(uint8_t *rgba, uint32_t size, const struct wd_tree_mesh *mesh, uint32_t begin,
                    uint32_t end);

/* Fills the figures of a model from its full mesh. */
void wd_import_measure(struct wd_tree_model *model);

#endif
