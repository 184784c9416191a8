/* path.h: radiance along one ray by path tracing: sun sampled at every place, sky found by the rays
 * that escape, light scattered as often as asked. */
#ifndef WD_REFERENCE_PATH_H
#define WD_REFERENCE_PATH_H

#include "reference/scatter.h"
#include "world/sky_map.h"

/* Radiance of the sky toward a direction, without the sun's disc. */
typedef struct wd_vec3 wd_sky_function(const struct wd_frame_uniforms *frame,
                                       struct wd_vec3 direction);

struct wd_tracer {
    const struct wd_trace_scene *scene;
    wd_sky_function *sky;
    const struct wd_sky_map *sky_map; /* in its place; or NULL */
    uint32_t bounces;     /* times that light, of the sun and of the sky alike, may be scattered */
    float pixel_rad;      /* angle that a pixel spans */
    bool is_sea;          /* water goes on beyond the terrain */
};

struct wd_trace_counts {
    uint64_t rays;
    uint64_t self_hits;   /* of the triangle that the ray has just left: none may happen */
};

/* `from` a place on the camera's lens, `direction` of unit length. With haze. Adds to `*counts`. Thread-safe. */
struct wd_vec3 wd_path_radiance(const struct wd_tracer *tracer, struct wd_vec3 from,
                                struct wd_vec3 direction, struct wd_sampler sampler, struct wd_trace_counts *counts);

#endif
