/* wax.h: what a leaf's cuticle mirrors: facets of wax, GGX (Walter et al. 2007). */
#ifndef WD_SHARED_WAX_H
#define WD_SHARED_WAX_H

#include "shared/vec.h"

/* Of light along the normal: refractive index 1.4 (Bousquet et al. 2005, Remote Sensing of Environment 98,
 * measured 1.3 to 1.5 on laurel, beech and hazel leaves). */
#define WD_WAX 0.028f

/* The flatter wax is looked at, the more it mirrors: WD_WAX and of the rest this (Schlick 1994). */
WD_FUNC float wd_grazing(float cosine)
{
    float rest = 1.0f - WD_CLAMP(cosine, 0.0f, 1.0f), rest2 = rest * rest;
    return rest2 * rest2 * rest;
}

WD_FUNC float wd_wax(float cosine)
{
    return WD_WAX + (1.0f - WD_WAX) * wd_grazing(cosine);
}

/* Of facets seen along a way with this cosine to the normal, how much others hide, over what is seen. `alpha2`:
 * GGX's alpha, squared. */
WD_FUNC float wd_facets_hidden(float cosine, float alpha2)
{
    float square = WD_MAX(cosine * cosine, 1e-6f);
    return 0.5f * (WD_SQRT(1.0f + alpha2 * (1.0f - square) / square) - 1.0f);
}

/* What wax mirrors of a light, over a white wall that it meets square on. Cosines: of the normal to the eye and to the
 * light, both above 0, and of the half way between them to the normal and to the eye. */
WD_FUNC float wd_wax_mirrors(float eye, float light, float half_normal, float half_eye, float alpha2)
{
    float spread = half_normal * half_normal * (alpha2 - 1.0f) + 1.0f;
    float open = 1.0f + wd_facets_hidden(eye, alpha2) + wd_facets_hidden(light, alpha2);
    return wd_wax(half_eye) * alpha2 / (spread * spread * open * 4.0f * eye);
}

/* How what a crown's wax mirrors rises from what comes back to the light (0) to what goes on from it (1); `cosine`: of
 * the eye's direction to the light's. */
WD_FUNC float wd_cloud_wax_rise(float cosine)
{
    float apart = 0.5f - 0.5f * cosine;
    return apart * apart * apart;
}

#endif
