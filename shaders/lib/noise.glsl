/* Noise for shaders: shared/noise.h in vectors. Expects `frame` (wd_frame_uniforms). */
#include "shared/noise.h"

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
    /* interleaved gradient noise (Jimenez 2014), moved on by the golden ratio a sample */
    float phase = fract(52.9829189 * fract(dot(vec2(pixel), vec2(0.06711056, 0.00583715))));
    return fract(phase + 0.618033989 * float(salt));
}
