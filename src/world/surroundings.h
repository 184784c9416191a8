/* surroundings.h: what a picture's uniforms know of light, air, water and ground, whoever draws it. */
#ifndef WD_WORLD_SURROUNDINGS_H
#define WD_WORLD_SURROUNDINGS_H

#include "shared/frame.h"
#include "weald/forest.h"
#include "world/world.h"

/* Fills the members of `*uniforms` for sun, sky, fog, wind, water and ground; of the world, terrain
 * and sky count. `sun`: where it stands, NULL: where the scene has it. */
void wd_surroundings_fill(struct wd_frame_uniforms *uniforms, const struct wd_scene *scene,
                          const struct wd_world *world, const struct wd_sun *sun);

/* Splits a place of the local frame into whole millimetres and the rest. */
void wd_surroundings_set_camera(struct wd_frame_uniforms *uniforms, const double position_m[3]);

/* Unit vectors of a camera in the local frame. */
void wd_camera_axes(const struct wd_camera *camera, double right[3], double forward[3],
                    double up[3]);

/* Whether water goes on beyond the terrain, as a sea: where the larger part of the edge lies under
 * its level. */
bool wd_water_is_sea(const struct wd_terrain *terrain, float level_m);

#endif
