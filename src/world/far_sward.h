/* far_sward.h: what the ground shows of low plants that are too far off to be drawn. */
#ifndef WD_WORLD_FAR_SWARD_H
#define WD_WORLD_FAR_SWARD_H

#include "world/world.h"

/* Fills world->far_sward from the stored plants below WD_CANOPY_CM. */
void wd_far_sward_init(struct wd_world *world, const struct wd_scene *scene);

/* Layers of low plants over a place, those that fade and those that do not. */
float wd_sward_layers_at(const struct wd_world *world, double x_m, double y_m);

#endif
