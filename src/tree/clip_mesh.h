/* clip_mesh.h: the closed mesh of a model file, as what a hedge is cut to. */
#ifndef WD_TREE_CLIP_MESH_H
#define WD_TREE_CLIP_MESH_H

#include "tree/grow.h"

struct wd_clip_mesh {
    struct wd_clip_volume volume; /* over the foot, on the ground */
    float size_m[3];              /* width, depth, height */
};

/* Reads a model in metres, y up, and puts the middle of its bounds over the foot. On failure {0},
 * logged with the file's name: what wd_model_file_read refuses, and what wd_clip_grid_init does (a mesh
 * that is not closed, without size, or with broken numbers). The volume keeps `path` as its name. */
bool wd_clip_mesh_read(struct wd_clip_mesh *mesh, const char *path, const struct wd_log *log);
void wd_clip_mesh_finish(struct wd_clip_mesh *mesh); /* accepts {0} */

#endif
