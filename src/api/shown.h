/* shown.h: what a picture tells of itself. */
#ifndef WD_API_SHOWN_H
#define WD_API_SHOWN_H

#include "api/forest.h"
#include "weald/renderer.h"

/* Of a picture whose layers are there: camera, time and `about`, and normals turned toward the eye. */
void wd_picture_settle(struct wd_picture *picture, const struct wd_forest *forest,
                       const struct wd_camera *camera, double time_s);

/* From the local frame to the camera's, x right, y up, looking along -z: rows times this. */
void wd_picture_camera_matrix(float m[4][4], const struct wd_camera *camera);

#endif
