/* view.h: the camera of a frame, its frustum, and the cascades of the sun. */
#ifndef WD_FRAME_VIEW_H
#define WD_FRAME_VIEW_H

#include "scene/scene.h"
#include "shared/frame.h"
#include "weald/forest.h"

/* Half-spaces in rel: a point is inside where dot(plane.xyz, p) + plane.w >= 0. */
struct wd_frustum {
    float planes[6][4];
    uint32_t count;
};

enum wd_side { WD_OUTSIDE, WD_PARTLY, WD_INSIDE };
/* A box in rel. */
enum wd_side wd_frustum_box(const struct wd_frustum *frustum, const float min[3],
                            const float max[3]);

/* What methods and passes need to know on the CPU about one view (the camera or a cascade). */
struct wd_view {
    struct wd_camera camera;
    double eye_m[3];            /* local frame: rel = local - eye */
    struct wd_frustum frustum;
    float clip_from_rel[4][4];
    float pixels_per_radian;    /* of the picture: size on screen = size / distance * this */
    uint32_t width, height;
    uint32_t cascade;           /* for shadow views: 0..WD_CASCADES - 1 */
    float lod_scale;            /* factor on the distances of the levels of detail */
};

#endif
