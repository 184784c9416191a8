/* model_reduce.h: fewer triangles for imported meshes, whose leaves come in no known order. */
#ifndef WD_TREE_MODEL_REDUCE_H
#define WD_TREE_MODEL_REDUCE_H

#include "tree/mesh.h"

/* Wood is simplified to about `wood_triangles`. Leaves that hang together are kept or dropped whole:
 * a fair sample, enlarged so that leaf area is kept, of about `leaf_triangles`; foliage that hangs
 * together in a few large pieces is simplified instead. */
void wd_tree_mesh_reduce_import(struct wd_tree_mesh *reduced, const struct wd_tree_mesh *full,
                                size_t wood_triangles, size_t leaf_triangles);

#endif
