/* near.h: trees whose leaves are so near the eye that the twigs they stand for are seen
 * (tree/leaf_spray.h): each has a mesh of its own. */
#ifndef WD_REFERENCE_NEAR_H
#define WD_REFERENCE_NEAR_H

#include "reference/models.h"

struct wd_trace_near_tree {
    uint32_t tree;                 /* index */
    float transform[12];           /* of the model into the frame of rays: columns x, y, z, translation */
    struct wd_trace_model *model;  /* its own; NULL where none of its leaves is near after all */
};

struct wd_trace_near {
    struct wd_trace_near_tree *trees; /* in the order of their indices */
    size_t count, capacity;
};

/* Adds the tree where some leaf of it may be near the eye, the origin; indices must rise. False: none is. */
bool wd_trace_near_add(struct wd_trace_near *near, const struct wd_trace_model *model,
                       const struct wd_tree *tree, uint32_t index, const float transform[12]);

/* Makes the meshes and scenes of the trees added: leaves of models[] that are near are twigs, the same that
 * pictures are drawn with, and fewer where all of them were too many triangles. `trees`: of the world. */
void wd_trace_near_build(struct wd_trace_near *near, const struct wd_trace_models *models,
                         const struct wd_tree *trees);
void wd_trace_near_finish(struct wd_trace_near *near); /* accepts {0} */

/* A tree's own model, or NULL. Thread-safe. */
const struct wd_trace_model *wd_trace_near_model(const struct wd_trace_near *near, uint32_t tree);

#endif
