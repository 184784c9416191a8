/* What a pixel of a picture shows, of a texel's mean of leaves and wood. */
#include "shared/mixed.h"

/* `mean`: linear albedo, and openness; `wood`: whether the pixel is that. */
vec4 unmixed(vec4 mean, float leaf, bool wood, uint ratios)
{
    vec4 own;
    for (uint k = 0u; k < WD_MIXED_KINDS; k++) {
        float ratio = wd_mixed_ratio(ratios, k);
        own[k] = wd_mixed_leaf(mean[k], leaf, ratio) * (wood ? ratio : 1.0);
    }
    return min(own, vec4(1.0));
}
