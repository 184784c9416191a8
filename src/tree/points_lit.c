/* Which ways over the sky a tree itself leaves open at points of its surface. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "shared/sun_ways.h"
#include "tree/points.h"
#include "tree/silhouette.h"

enum { TOGETHER = 8 }; /* pictures */

/* Leaves are no plane all through, nor is bark. */
static const float CLEAR_M = 0.02f, MOST_TILT = 6.0f;

/* Pictures hold what is nearest at the middles of their pixels: how much nearer than the point the plane
 * that it lies on is there. */
static float nearer_m(const struct wd_silhouette *frame, const float at[3], const float face[3])
{
    struct wd_vec3 n = wd_v3_of(face);
    float right = floorf(at[0]) + 0.5f - at[0], up = floorf(at[1]) + 0.5f - at[1];
    float toward = wd_v3_dot(n, frame->toward);
    float tilt = -(right * wd_v3_dot(n, frame->right) + up * wd_v3_dot(n, frame->up));
    float most = MOST_TILT * (fabsf(right) + fabsf(up));
    float rise = fabsf(toward) > 1e-3f ? tilt / toward : most;
    return wd_clampf(rise, -most, most) / frame->scale;
}

static bool is_lit(const struct wd_tree_point *point, const float face[3],
                   const struct wd_silhouette *frame, const struct wd_silhouette_axes *axes,
                   const float *front)
{
    float at[3];
    if ((point->kind & WD_POINT_ONE_SIDED) && wd_v3_dot(wd_v3_of(face), frame->toward) <= 0)
        return false;
    wd_silhouette_place(axes, point->position_m, at);
    bool framed = at[0] >= 0 && at[0] < WD_SILHOUETTE && at[1] >= 0 && at[1] < WD_SILHOUETTE;
    if (!framed) /* corners of a box, where crowns have little */
        return true;
    int x = (int)at[0], y = (int)at[1];
    return front[y * WD_SILHOUETTE + x] <= at[2] + nearer_m(frame, at, face) + CLEAR_M;
}

void wd_tree_points_open(uint32_t *open, const struct wd_tree_points *points,
                         const struct wd_tree_mesh *mesh, const struct wd_vec3 *ways, uint32_t count)
{
    struct wd_silhouette frames[TOGETHER];
    struct wd_silhouette_axes axes[TOGETHER];
    float *fronts = wd_alloc_array((size_t)TOGETHER * WD_SILHOUETTE_FRONT, sizeof *fronts);
    memset(open, 0, points->count * sizeof *open);
    for (uint32_t first = 0; first < count; first += TOGETHER) {
        uint32_t some = count - first < TOGETHER ? count - first : TOGETHER;
        for (uint32_t k = 0; k < some; k++) {
            wd_silhouette_init(&frames[k], mesh, ways[first + k]);
            axes[k] = wd_silhouette_axes_of(&frames[k]);
        }
        wd_silhouette_front(frames, (int)some, mesh, fronts);
        for (size_t i = 0; i < points->count; i++) {
            const struct wd_tree_point *point = &points->points[i];
            float face[3];
            wd_unpack_normal(point->face, face);
            for (uint32_t k = 0; k < some; k++) {
                const float *front = fronts + (size_t)k * WD_SILHOUETTE_FRONT;
                open[i] |= (uint32_t)is_lit(point, face, &frames[k], &axes[k], front)
                           << (first + k);
            }
        }
    }
    free(fronts);
}

void wd_tree_points_light(struct wd_tree_points *points, const struct wd_tree_mesh *mesh)
{
    struct wd_vec3 ways[WD_SUN_WAYS];
    for (uint32_t way = 0; way < WD_SUN_WAYS; way++)
        ways[way] = wd_sun_way(way);
    points->lit = wd_alloc_array(points->count + 1, sizeof *points->lit);
    wd_tree_points_open(points->lit, points, mesh, ways, WD_SUN_WAYS);
}
