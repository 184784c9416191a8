/* spray_draw.h: leaves close to the camera as the twigs that they stand for. */
#ifndef WD_METHODS_SPRAY_DRAW_H
#define WD_METHODS_SPRAY_DRAW_H

#include "methods/tree_draw.h"

bool wd_spray_pipeline_init(struct wd_pipeline *pipeline, struct wd_gpu *gpu);

/* Draws the twigs of the full meshes among the selection's batches, for the camera. The meshes hide
 * the leaves that are drawn here. */
void wd_spray_draw(const struct wd_tree_draw *draw, const struct wd_selection *selection);

#endif
