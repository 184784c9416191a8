/* surface.h: what a ray meets: place, directions and matter, with the same looks that rasterised
 * pictures are drawn with. */
#ifndef WD_REFERENCE_SURFACE_H
#define WD_REFERENCE_SURFACE_H

#include "reference/scene.h"

struct wd_surface {
    struct wd_vec3 place;     /* camera-relative */
    struct wd_vec3 flat;      /* the triangle's normal, on the eye's side; unit */
    struct wd_vec3 normal;    /* for shading, on the eye's side; unit */
    struct wd_vec3 outward;   /* as the picture's normal layer shows it, before it is turned to the eye */
    bool sheet;               /* a leaf, seen from either side */
    struct wd_vec3 albedo;
    struct wd_vec3 transmittance; /* diffuse, to the other side; 0 but for leaves */
    bool glossy;              /* the waxy upper side of a leaf */
    float coat_alpha;         /* its roughness: GGX's alpha */
    float offset_m;           /* how far from the surface rays begin */
};

/* `pixel_rad`: angle that a pixel spans, for detail of the ground; 0: for light that has been
 * scattered, which sees the ground coarsely. */
void wd_surface_at(struct wd_surface *surface, const struct wd_trace_scene *scene,
                   const struct wd_trace_ray *ray, const struct wd_trace_hit *hit,
                   float pixel_rad);

/* A ray that leaves the surface; `direction` may point to either side. */
struct wd_trace_ray wd_surface_leave(const struct wd_surface *surface, struct wd_vec3 direction);

#endif
