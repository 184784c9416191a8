/* sun.h: the sun's place, its light and the sky's, from time of day and air. */
#ifndef WD_WORLD_SUN_H
#define WD_WORLD_SUN_H

#include "scene/scene.h"
#include "shared/frame.h"
#include "weald/forest.h"
#include "world/sky_map.h"

/* Fills sun_direction, sun_cos_radius, sun_irradiance and the sky members of `*uniforms`; `at`: where the
 * sun stands, NULL: where the scene has it. Where twilight has become fainter than it, the full moon takes
 * the sun's place: opposite the sun and 35 degrees up. Where there is a map (else NULL) it is the sky, and its sun is
 * the sun unless the scene keeps its own. Camera and fog are to be known: fog over the camera dims sun and sky, but no
 * map. */
void wd_sun_fill(struct wd_frame_uniforms *uniforms, const struct wd_scene *scene, const struct wd_sun *at,
                 const struct wd_sky_map *map);
/* Where the scene has it. */
struct wd_sun wd_sun_of(const struct wd_scene *scene);

#endif
