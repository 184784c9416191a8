/* The sky for shaders: shared/air.h by shorter names. Expects `frame` (wd_frame_uniforms). */
#include "shared/air.h"

vec3 sky_radiance(vec3 direction)
{
    return wd_sky_toward(direction);
}

vec3 sun_disc(vec3 direction)
{
    return wd_sun_disc_toward(direction);
}

vec3 apply_fog(vec3 radiance, vec3 direction, float length_m, float sunlit)
{
    return wd_fog_apply(radiance, direction, length_m, sunlit);
}
