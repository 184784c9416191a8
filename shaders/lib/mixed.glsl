/* What a pixel of a picture shows, of a texel's mean of leaves and wood. */
#include "shared/mixed.h"

/* `mean`: linear albedo, and openness; `wood`: whether the pixel is that. */
vec4 unmixed(vec4 mean, float leaf, bool wood, uint ratios)
{
    vec4 ratio = exp2((unpackUnorm4x8(ratios) * 255.0 - 128.0) * (1.0 / WD_MIXED_OCTAVE));
    return min(mean * (wood ? ratio : vec4(1.0)) / mix(ratio, vec4(1.0), leaf), vec4(1.0));
}
