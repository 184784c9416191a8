/* ground.h: the terrain as rays meet it: each cell's two triangles, found by walking the grid, with
 * no copy of the heights. */
#ifndef WD_REFERENCE_GROUND_H
#define WD_REFERENCE_GROUND_H

#include <embree3/rtcore.h>

#include "world/terrain.h"

struct wd_trace_ground {
    const struct wd_terrain *terrain; /* must outlive this */
    double origin_m[3];               /* of the rays' frame, local */
    RTCScene scene;                   /* of the ground alone */
    RTCGeometry geometry;             /* to be attached to other scenes; its hits' primID is
                                         2 * cell + (1 in the north-western triangle), or
                                         WD_TRACE_WALL + side */
};

/* Walls of earth close the ground at its western, eastern, southern and northern edge. */
#define WD_TRACE_WALL 0xfffffff0u

/* Embree keeps a pointer to `*ground`: it must not move. */
void wd_trace_ground_init(struct wd_trace_ground *ground, RTCDevice device,
                          const struct wd_terrain *terrain, const double origin_m[3]);
void wd_trace_ground_finish(struct wd_trace_ground *ground); /* accepts {0} */

/* The first of the ground on a ray, from `near_m` on; false if there is none before `far_m`. */
struct wd_ground_hit {
    float at_m;
    float normal[3]; /* of the triangle or wall, not of unit length */
    uint32_t triangle;
};
bool wd_trace_ground_hit(const struct wd_terrain *terrain, const double from_m[3],
                         const double direction[3], const uint32_t cells[4], double near_m,
                         double far_m, struct wd_ground_hit *hit);

#endif
