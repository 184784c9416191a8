/* The sky for shaders: shared/air.h by shorter names. Expects `frame` (wd_frame_uniforms);
 * the sky itself only where SKY_MAP names its map's sampler. */
#include "shared/air.h"
#include "shared/sky_map.h"

#ifdef SKY_MAP
vec3 sky_radiance(vec3 direction)
{
    if (frame.sky_is_map == 0u)
        return wd_sky_toward(direction);
    vec2 at = wd_sky_map_place(direction, frame.sky_turn).xy;
    float half_texel = 0.5 / float(textureSize(SKY_MAP, 0).y);
    at.y = clamp(at.y, half_texel, 1.0 - half_texel); /* poles do not join */
    return textureLod(SKY_MAP, at, 0.0).rgb;
}
#endif

vec3 sun_disc(vec3 direction)
{
    return wd_sun_disc_toward(direction);
}
