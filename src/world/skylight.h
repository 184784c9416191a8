/* skylight.h: the sky's light summed up for shading: by the surface's normal, and by quarters. */
#ifndef WD_WORLD_SKYLIGHT_H
#define WD_WORLD_SKYLIGHT_H

#include "shared/frame.h"
#include "shared/vec.h"

/* The hemisphere is summed up by so many parts of equal size: rings of equal height, from the horizon
 * up, and bearings, from the east counter-clockwise. */
#define WD_SKYLIGHT_RINGS 16
#define WD_SKYLIGHT_BEARINGS 32

/* Direction of a place in a part; 0.5, 0.5 is its middle. */
struct wd_vec3 wd_skylight_direction(float ring, float bearing);

/* Radiance of the sky toward a unit direction, without the sun's disc. */
typedef struct wd_vec3 wd_skylight_radiance(const void *user, struct wd_vec3 direction);

/* Fills sky_irradiance, circumsolar, sky_form, sky_quarters, sky_slant and sunward of `*frame` by the midpoint
 * rule over the parts of the upper hemisphere; nothing comes from below. sun_direction and sun_irradiance are
 * already set: without a sun nothing is circumsolar. */
void wd_skylight_fill(struct wd_frame_uniforms *frame, wd_skylight_radiance *radiance,
                      const void *user);

#endif
