/* near.h: trees whose leaves are so near the eye that the twigs they stand for are seen
 * (tree/leaf_spray.h): each has a mesh of these beside its model's, of which the leaves that are twigs are hidden. */
#ifndef WD_REFERENCE_NEAR_H
#define WD_REFERENCE_NEAR_H

#include "reference/models.h"
#include "reference/view.h"
#include "shared/frame.h"

struct wd_trace_near_tree {
    uint32_t tree;       /* index */
    float transform[12]; /* of the model into the frame of rays: columns x, y, z, translation */
    struct wd_trace_near_leaf *leaves; /* in the order of their indices */
    size_t count, capacity;
    struct wd_trace_model *twigs; /* NULL where none of its leaves is one after all */
    uint32_t *hidden;             /* a bit for each leaf of the model; NULL where there are no twigs */
};

struct wd_trace_near {
    struct wd_trace_near_tree *trees; /* in the order of their indices */
    size_t count, capacity;
};

/* Adds the tree where some leaf of it may be near the eye, the origin; indices must rise. */
void wd_trace_near_add(struct wd_trace_near *near, const struct wd_trace_model *model,
                       const struct wd_tree *tree, uint32_t index, const float transform[12]);

struct wd_trace_near_scene {
    const struct wd_trace_models *models;
    const struct wd_tree *trees; /* of the world */
    const struct wd_trace_view *view;
    const struct wd_frame_uniforms *frame;
};

/* Makes the twigs of the trees added, and their scenes: leaves that are near, and are in the picture or throw their shadow on
 * what is near there, are twigs, by the rule that pictures are drawn with; plain ones (wd_leaf_spray_shade_mesh) where their
 * leaves are less than half a pixel wide; fewer, the nearest, where all of them were more than four million triangles
 * (pictures: WD_SPRAY_BUDGET of methods/spray_draw.h). */
void wd_trace_near_build(struct wd_trace_near *near, const struct wd_trace_near_scene *scene);
void wd_trace_near_finish(struct wd_trace_near *near); /* accepts {0} */

/* The twigs of a tree that has some. Thread-safe. */
const struct wd_trace_model *wd_trace_near_twigs(const struct wd_trace_near *near, uint32_t tree);

/* Whether a triangle of a tree's model is of a leaf that is a twig. `tree`: any index. Thread-safe. */
bool wd_trace_near_hides(const struct wd_trace_near *near, const struct wd_trace_model *model, uint32_t tree,
                         uint32_t triangle);

#endif
