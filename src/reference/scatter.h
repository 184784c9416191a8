/* scatter.h: how matter scatters light: diffuse reflection, diffuse transmission through leaves, and
 * the sheen of their waxy upper side. */
#ifndef WD_REFERENCE_SCATTER_H
#define WD_REFERENCE_SCATTER_H

#include "reference/sampler.h"
#include "reference/surface.h"

/* Light from `light` that goes on to `eye` (unit, away from the surface), over the light's
 * irradiance on a surface that faces it: the scattering function times the cosine. */
struct wd_vec3 wd_scatter_toward(const struct wd_surface *surface, struct wd_vec3 eye,
                                 struct wd_vec3 light);

/* A direction that light may have come from, and what of it goes on to the eye: an unbiased sample
 * of the scattering. False where the sample came to nothing. */
struct wd_scattered {
    struct wd_vec3 direction;
    struct wd_vec3 weight;
};
bool wd_scatter_sample(struct wd_scattered *scattered, const struct wd_surface *surface,
                       struct wd_vec3 eye, struct wd_sampler *sampler);

/* With which density, per steradian, wd_scatter_sample chooses a direction, and the scattering times
 * the cosine there, as its samples have it in the mean. */
struct wd_scatter_density {
    float per_sr;
    struct wd_vec3 scattered;
};
struct wd_scatter_density wd_scatter_density_of(const struct wd_surface *surface,
                                                struct wd_vec3 eye, struct wd_vec3 light);

#endif
