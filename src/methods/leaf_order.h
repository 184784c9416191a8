/* leaf_order.h: the leaves of full meshes in progressive order, so that any share of a crown is a
 * prefix of an index list (row W5). */
#ifndef WD_METHODS_LEAF_ORDER_H
#define WD_METHODS_LEAF_ORDER_H

#include "forest/forest.h"
#include "shared/dissolve.h"

struct wd_leaf_range {
    uint32_t first_index, index_count; /* in `indices`; they count from the mesh's first vertex */
    uint32_t first_vertex, vertex_count; /* first: a multiple of WD_MESH_ALIGNMENT */
};

struct wd_leaf_order {
    struct wd_buffer vertices; /* struct wd_tree_vertex[] of all full meshes; bound model by model */
    struct wd_buffer indices; /* uint32_t[]: leaves of all full meshes, leaf by leaf */
    struct wd_buffer places;  /* struct wd_leaf_place[], parallel to the vertices */
    struct wd_leaf_range *ranges; /* by model */
};

/* Grows the models once more, or takes them from the cache. A leaf is what hangs together by its
 * triangles. */
bool wd_leaf_order_init(struct wd_leaf_order *order, struct wd_gpu *gpu,
                        struct wd_forest_device *forest);
void wd_leaf_order_finish(struct wd_leaf_order *order, struct wd_gpu *gpu); /* accepts {0} */

#endif
