/* spray_draw.h: leaves close to the camera as the twigs that they stand for. */
#ifndef WD_METHODS_SPRAY_DRAW_H
#define WD_METHODS_SPRAY_DRAW_H

#include "methods/tree_draw.h"

bool wd_spray_pipeline_init(struct wd_pipeline *pipeline, struct wd_gpu *gpu, enum wd_tree_pass pass);

/* Factor on the reach of twigs: less for pictures of few samples, and so much that those in view, or that shade what is,
 * have at most WD_SPRAY_BUDGET triangles. It follows the camera without jumps larger than one twig. */
#define WD_SPRAY_BUDGET 1500000
float wd_spray_scale(const struct wd_tree_draw *draw, const struct wd_selection *selection);

/* Draws the twigs of the full meshes among the selection's batches. The meshes, drawn with the same scale,
 * hide the leaves that are drawn here. */
void wd_spray_draw(const struct wd_tree_draw *draw, const struct wd_selection *selection,
                   float scale);

#endif
