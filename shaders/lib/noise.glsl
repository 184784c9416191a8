/* Noise for shaders: shared/noise.h in vectors. Expects `frame` (wd_frame_uniforms). */
#include "shared/noise.h"
#include "lib/dither.glsl"

wd_lattice lattice_at(vec2 rel, int bits)
{
    return wd_lattice_at(rel.x, rel.y, bits);
}

vec3 gradient_noise(wd_lattice at, uint salt)
{
    return wd_gradient_noise(at, salt);
}

float noise_share(float footprint_m, int bits)
{
    return wd_noise_share(footprint_m, bits);
}

/* White noise of a pixel and sample, for sampling patterns. */
float pixel_noise(uvec2 pixel, uint salt)
{
    /* moved on by the golden ratio a sample */
    return fract(dither(vec2(pixel)) + 0.618033989 * float(salt));
}
