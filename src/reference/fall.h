/* fall.h: trees that are leaves in the air (species of the form "falling"): no two are alike at any
 * time but 0, so that each has a scene of its own. */
#ifndef WD_REFERENCE_FALL_H
#define WD_REFERENCE_FALL_H

#include "reference/scene.h"
#include "shared/fall.h"

/* Whether the leaves of the tree, whose foot is at `foot_m` from the eye, are drawn where they are at
 * frame->time_s; else they are too far off to be told from those of time 0. */
bool wd_trace_falls(const struct wd_trace_model *model, const float foot_m[3]);

/* The tree's leaves at frame->time_s, in the model's frame: release it. */
RTCScene wd_trace_fall_scene(const struct wd_trace_scene *scene, const struct wd_tree *tree);

/* How the leaf has turned that a triangle of the model belongs to. */
struct wd_leaf_fall wd_trace_fall_at(const struct wd_trace_scene *scene, const struct wd_tree *tree,
                                     uint32_t triangle);

/* Foot of a tree as seen from the eye. */
void wd_trace_foot(const struct wd_frame_uniforms *frame, const struct wd_tree *tree,
                   float foot_m[3]);

#endif
