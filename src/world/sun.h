/* sun.h: the sun's place, its light and the sky's, from time of day and air. */
#ifndef WD_WORLD_SUN_H
#define WD_WORLD_SUN_H

#include "scene/scene.h"
#include "shared/frame.h"

/* Fills sun_direction, sun_cos_radius, sun_irradiance and the sky members of `*uniforms`. Where
 * twilight has become fainter than it, the full moon takes the sun's place: opposite the sun and 35
 * degrees up. */
void wd_sun_fill(struct wd_frame_uniforms *uniforms, const struct wd_scene *scene);

#endif
