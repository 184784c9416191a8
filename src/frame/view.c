#define CGLM_ALL_UNALIGNED
#include "frame/view.h"

#include <math.h>
#include <string.h>

#include <cglm/mat4.h>

#include "world/surroundings.h"

/* Of a picture of 600 lines that is 60 degrees high. */
static const float REFERENCE_PIXELS_PER_RADIAN = 519.615242f;

enum wd_side wd_frustum_box(const struct wd_frustum *frustum, const float min[3], const float max[3])
{
    enum wd_side side = WD_INSIDE;
    for (uint32_t i = 0; i < frustum->count; i++) {
        const float *plane = frustum->planes[i];
        float nearest = plane[3], farthest = plane[3];
        for (int k = 0; k < 3; k++) {
            float a = plane[k] * min[k], b = plane[k] * max[k];
            nearest += a < b ? a : b;
            farthest += a < b ? b : a;
        }
        if (farthest < 0.0f)
            return WD_OUTSIDE;
        if (nearest < 0.0f)
            side = WD_PARTLY;
    }
    return side;
}

void wd_matrix_multiply(float result[4][4], float a[4][4], float b[4][4])
{
    mat4 left, right, product;
    memcpy(left, a, sizeof left);
    memcpy(right, b, sizeof right);
    glm_mat4_mul(left, right, product);
    memcpy(result, product, sizeof product);
}

void wd_matrix_invert(float result[4][4], float m[4][4])
{
    mat4 from, inverse;
    memcpy(from, m, sizeof from);
    glm_mat4_inv(from, inverse);
    memcpy(result, inverse, sizeof inverse);
}

static void set_row(float matrix[4][4], int row, const double axis[3], double factor, double last)
{
    for (int k = 0; k < 3; k++)
        matrix[k][row] = (float)(axis[k] * factor);
    matrix[3][row] = (float)last;
}

/* The plane that holds the eye and the frustum's side in direction `side`. */
static void add_side_plane(struct wd_frustum *frustum, const double forward[3], const double side[3],
                           double half_extent)
{
    double length = sqrt(1.0 + half_extent * half_extent);
    float *plane = frustum->planes[frustum->count++];
    for (int k = 0; k < 3; k++)
        plane[k] = (float)((forward[k] * half_extent - side[k]) / length);
    plane[3] = 0.0f;
}

/* Both sides along an axis, along which the picture of `size_px` is shifted by `offset_px`: by whole pixels, with half
 * of one to spare, so that all places in a pixel share a frustum. */
static void add_side_planes(struct wd_frustum *frustum, const double forward[3], const double axis[3],
                            double half_extent, float offset_px, uint32_t size_px)
{
    const double back[3] = {-axis[0], -axis[1], -axis[2]};
    double spare = 1.0 / size_px, shift = 2.0 * round((double)offset_px) / size_px;
    add_side_plane(frustum, forward, axis, half_extent * (1.0 + spare - shift));
    add_side_plane(frustum, forward, back, half_extent * (1.0 + spare + shift));
}

struct wd_half_view wd_half_view_of(const struct wd_view *view)
{
    double height = tan(view->camera.fov_rad * 0.5);
    return (struct wd_half_view){height * view->width / view->height, height};
}

void wd_view_init(struct wd_view *view, const struct wd_view_params *params)
{
    double right[3], forward[3], up[3];
    wd_camera_axes(&params->camera, right, forward, up);
    *view = (struct wd_view){.camera = params->camera,
                             .width = params->width,
                             .height = params->height,
                             .samples = params->samples ? params->samples : 1};
    memcpy(view->eye_m, params->camera.position_m, sizeof view->eye_m);
    const struct wd_half_view half = wd_half_view_of(view);
    view->pixels_per_radian = (float)(params->height * 0.5 / half.height);
    view->lod_scale = fmaxf(view->pixels_per_radian / REFERENCE_PIXELS_PER_RADIAN, 1.0f);
    /* clip = (x / half.width, -y / half.height, near, distance): y down, depth = near / distance */
    set_row(view->clip_from_rel, 0, right, 1.0 / half.width, 0.0);
    set_row(view->clip_from_rel, 1, up, -1.0 / half.height, 0.0);
    set_row(view->clip_from_rel, 2, forward, 0.0, params->near_m);
    set_row(view->clip_from_rel, 3, forward, 1.0, 0.0);
    for (int k = 0; k < 3; k++) {
        view->clip_from_rel[k][0] += (float)(forward[k] * 2.0 * params->offset_px[0] / params->width);
        view->clip_from_rel[k][1] += (float)(forward[k] * 2.0 * params->offset_px[1] / params->height);
    }
    add_side_planes(&view->frustum, forward, right, half.width, params->offset_px[0], params->width);
    add_side_planes(&view->frustum, forward, up, half.height, -params->offset_px[1], params->height);
    float *near = view->frustum.planes[view->frustum.count++];
    for (int k = 0; k < 3; k++)
        near[k] = (float)forward[k];
    near[3] = -params->near_m;
}
