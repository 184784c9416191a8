#ifndef WD_LIB_DITHER
#define WD_LIB_DITHER
/* Interleaved gradient noise (Jimenez 2014): neighbouring cells differ as much as they can, so that of a
 * few cells as many lie below a share as it says. */
float dither(vec2 cell)
{
    return fract(52.9829189 * fract(dot(cell, vec2(0.06711056, 0.00583715))));
}

/* The same pattern from another place on, for what must not know of each other. */
float dither_from(uvec2 cell, uint random)
{
    return dither(vec2((cell + uvec2(random >> 24, random >> 16)) & 255u));
}

#endif
