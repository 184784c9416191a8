/* shown.h: what a picture holds, and what it tells of itself. */
#ifndef WD_API_SHOWN_H
#define WD_API_SHOWN_H

#include "api/forest.h"
#include "weald/renderer.h"

/* Makes room for `layers`, all zero. False, logged, where there is not so much memory: then it has none. */
bool wd_picture_make_room(struct wd_picture *picture, uint32_t width, uint32_t height,
                          uint32_t layers, const struct wd_log *log);

/* What making a picture needs beside it, `bytes_a_pixel` in all; NULL, logged, where that cannot be had. */
void *wd_picture_try_scratch(uint32_t width, uint32_t height, size_t bytes_a_pixel,
                             const struct wd_log *log);

/* Of a picture whose layers are there: camera, sun, time and `about`. */
void wd_picture_settle(struct wd_picture *picture, const struct wd_forest *forest, const struct wd_camera *camera,
                       const struct wd_sun *sun, double time_s);

/* Directions through the middles of a picture's pixels, not of unit length. */
struct wd_rays {
    float first[3], right[3], down[3];
};
void wd_rays_init(struct wd_rays *rays, const struct wd_camera *camera, uint32_t width, uint32_t height);
struct wd_vec3 wd_ray_through(const struct wd_rays *rays, uint32_t x, uint32_t y);

/* From the local frame to the camera's, x right, y up, looking along -z: rows times this. */
void wd_picture_camera_matrix(float m[4][4], const struct wd_camera *camera);

#endif
