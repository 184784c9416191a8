/* Noise for sampling patterns; that of surfaces is in shared/noise.h. */
#include "lib/dither.glsl"

/* White noise of a pixel and sample, for sampling patterns. */
float pixel_noise(uvec2 pixel, uint salt)
{
    /* moved on by the golden ratio a sample */
    return fract(dither(vec2(pixel)) + 0.618033989 * float(salt));
}
