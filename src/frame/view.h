/* view.h: the camera of a frame, its frustum, and the cascades of the sun. */
#ifndef WD_FRAME_VIEW_H
#define WD_FRAME_VIEW_H

#include "scene/scene.h"
#include "shared/frame.h"
#include "weald/forest.h"

enum { WD_FRUSTUM_PLANES = 12, WD_FRUSTUM_SIDES = 4, WD_SLICE_SIDES = 8 };

/* Half-spaces in rel: a point is inside where dot(plane.xyz, p) + plane.w >= 0. A camera's begin with
 * its four sides. */
struct wd_frustum {
    float planes[WD_FRUSTUM_PLANES][4];
    uint32_t count;
};

enum wd_side { WD_OUTSIDE, WD_PARTLY, WD_INSIDE };
/* A box in rel. */
enum wd_side wd_frustum_box(const struct wd_frustum *frustum, const float min[3],
                            const float max[3]);

static inline double wd_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* What methods and passes need to know on the CPU about one view (the camera or a cascade). */
struct wd_view {
    struct wd_camera camera;
    double eye_m[3];            /* local frame: rel = local - eye */
    struct wd_frustum frustum;
    float clip_from_rel[4][4];
    float pixels_per_radian;    /* of the picture: size on screen = size / distance * this */
    uint32_t width, height;
    uint32_t samples;           /* pictures averaged into one: leaves thin out later for it */
    uint32_t cascade;           /* for shadow views: 0..WD_CASCADES - 1 */
    float lod_scale;            /* factor on the distances of the levels of detail, which are meant for
                                   pictures of 600 lines that are 60 degrees high: in larger ones and
                                   through longer lenses levels change at the same size in pixels;
                                   smaller ones, where it is 1, keep their trees */
    struct wd_cascade_box {     /* of shadow views: what the map holds */
        double right[3], up[3], toward[3]; /* its axes, local frame */
        double center[3];       /* along them, metres; the last: where depth begins */
        double radius, depth;   /* along right and up; along toward */
        bool calm;              /* see wd_cascades_params.calm_m */
        float slice[WD_SLICE_SIDES][3]; /* a x + b y + c >= 0 in clip coordinates, |(a, b)| = 1, where a
                                           thing may shade what the camera sees of the slice; 0: where
                                           there are fewer sides, or all of the map is wanted */
    } box;
};

struct wd_view_params {
    struct wd_camera camera;
    uint32_t width, height;
    float near_m;
    uint32_t samples;   /* 0 counts as 1 */
    float offset_px[2]; /* of this sample: within its pixel, -0.5..0.5, and by its place on the lens */
};
/* Nearest that cameras see, metres along the view axis; depth is this over the distance. */
#define WD_NEAR_M 0.1f

/* Half of the width and of the height of what a camera's view sees a metre ahead, metres. */
struct wd_half_view {
    double width, height;
};
struct wd_half_view wd_half_view_of(const struct wd_view *view);

/* A camera's view. */
void wd_view_init(struct wd_view *view, const struct wd_view_params *params);

/* Parallel-split shadow maps (Zhang et al. 2006), stabilised: a cascade holds the bounding sphere
 * of its slice of the view frustum, in a frame fixed to the world, moved by whole texels. */
struct wd_cascades_params {
    const struct wd_view *view;
    const double *eye_m;     /* that matrices and planes count from; NULL: the view's */
    float sun_direction[3];  /* unit, toward the sun */
    float distance_m;        /* at which the last cascade ends */
    float near_m;
    float nearest_m;         /* distance of the nearest thing that the camera may see */
    float farthest_m;        /* along its axis, of the farthest ground that it sees, or infinite */
    uint32_t size;           /* texels a side */
    double max_z_m;          /* of everything that casts, local frame */
    double min_z_m;          /* of the ground */
    double max_height_m;     /* of a tree */
    /* Cascades with texels at least so large are calm: they show trees as the mean wind bends them, hold
     * all of their box, and move in steps of a sixteenth of it: a camera that moves little changes
     * nothing, and the map can be kept. 0: none is; nor is the first where leaves are near. */
    double calm_m;
};
/* Fills the shadow members of `*uniforms` and one view a cascade. */
void wd_cascades_init(struct wd_view cascades[WD_CASCADES], struct wd_frame_uniforms *uniforms,
                      const struct wd_cascades_params *params);

/* One map in place of the cascades (the OSG paper's kind), for comparison: the first view; look-ups take
 * the first at any distance. Its clip coordinates have a w, which texels and depths in metres go by. */
void wd_perspective_map_init(struct wd_view *map, struct wd_frame_uniforms *uniforms,
                             const struct wd_cascades_params *params);

/* Matrices are columns of rows, as GLSL's. */
void wd_matrix_multiply(float result[4][4], float a[4][4], float b[4][4]);
void wd_matrix_invert(float result[4][4], float m[4][4]);

#endif
