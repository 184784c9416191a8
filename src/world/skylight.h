/* skylight.h: the sky's light summed up for shading: by the surface's normal, and by quarters. */
#ifndef WD_WORLD_SKYLIGHT_H
#define WD_WORLD_SKYLIGHT_H

#include "shared/frame.h"

/* Radiance of the sky toward a unit direction, without the sun's disc. */
typedef struct wd_vec3 wd_skylight_radiance(const void *user, struct wd_vec3 direction);

/* Fills sky_irradiance, sky_form, sky_quarters, sky_slant and sunward of `*frame` by the midpoint rule over the
 * upper hemisphere; nothing comes from below. sun_direction is already set. */
void wd_skylight_fill(struct wd_frame_uniforms *frame, wd_skylight_radiance *radiance,
                      const void *user);

#endif
