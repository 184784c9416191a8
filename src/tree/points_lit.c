/* Which ways over the sky a tree itself leaves open at points of its surface. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "shared/sun_ways.h"
#include "tree/points.h"
#include "tree/silhouette.h"

enum { TOGETHER = 8 }; /* pictures */

/* Leaves are no plane all through, nor is bark: so far before it nothing hides a point; small plants have small
 * leaves. */
static const float CLEAR_M = 0.02f, CLEAR_PX = 0.3f, MOST_TILT = 6.0f;

struct four_points {
    struct wd_four_vec3 place, face;
    wd_four_ints one_sided;
};

/* What is nearest to the sky's end of a way. */
struct picture {
    const struct wd_silhouette *frame;
    struct wd_silhouette_axes axes;
    const float *front;
};

static struct four_points *fours_of(const struct wd_tree_points *points)
{
    struct four_points *fours = wd_alloc_array(points->count / 4 + 1, sizeof *fours);
    for (size_t i = 0; i < points->count; i++) {
        const struct wd_tree_point *point = &points->points[i];
        struct four_points *four = &fours[i / 4];
        const float *p = point->position_m;
        float face[3];
        wd_unpack_normal(point->face, face);
        four->place.x[i % 4] = p[0], four->place.y[i % 4] = p[1], four->place.z[i % 4] = p[2];
        four->face.x[i % 4] = face[0], four->face.y[i % 4] = face[1], four->face.z[i % 4] = face[2];
        four->one_sided[i % 4] = point->kind & WD_POINT_ONE_SIDED ? -1 : 0;
    }
    return fours;
}

/* Pictures hold what is nearest at the middles of their pixels: how much nearer than the point the plane
 * that it lies on is there. `right` and `up`: pixels from the point to the middle. */
static inline wd_four nearer_m(const struct wd_silhouette *frame, const struct wd_four_vec3 *face,
                               wd_four right, wd_four up)
{
    wd_four toward = wd_four_dot(face, frame->toward);
    wd_four tilt = -(right * wd_four_dot(face, frame->right) + up * wd_four_dot(face, frame->up));
    wd_four most = MOST_TILT * (wd_four_abs(right) + wd_four_abs(up));
    wd_four rise = wd_four_choose(wd_four_abs(toward) > 1e-3f, tilt / toward, most);
    return wd_four_min(wd_four_max(rise, -most), most) / frame->scale;
}

static inline wd_four_ints are_lit(const struct four_points *points, const struct picture *picture)
{
    const wd_four none = {0};
    const struct wd_silhouette_axes *axes = &picture->axes;
    wd_four x = wd_four_dot(&points->place, axes->axis[0]) - axes->low[0];
    wd_four y = wd_four_dot(&points->place, axes->axis[1]) - axes->low[1];
    wd_four toward = wd_four_dot(&points->place, axes->axis[2]) - axes->low[2];
    wd_four_ints framed = (x >= none) & (x < WD_SILHOUETTE) & (y >= none) & (y < WD_SILHOUETTE);
    wd_four_ints column = wd_four_truncate(x), row = wd_four_truncate(y);
    wd_four_ints at = (row & framed) * WD_SILHOUETTE + (column & framed);
    wd_four right = wd_four_convert(column) + 0.5f - x, up = wd_four_convert(row) + 0.5f - y;
    float clear_m = fminf(CLEAR_M, CLEAR_PX / picture->frame->scale);
    const float *front = picture->front;
    wd_four nearest = {front[at[0]], front[at[1]], front[at[2]], front[at[3]]};
    wd_four most = toward + nearer_m(picture->frame, &points->face, right, up) + clear_m;
    wd_four_ints behind = points->one_sided &
                          (wd_four_dot(&points->face, picture->frame->toward) <= none);
    /* what is not framed, corners of a box, has little of a crown before it */
    return ((nearest <= most) | ~framed) & ~behind;
}

/* Bits of the ways from `first` on. */
WD_FOUR_TWICE
static void open_ways(uint32_t *open, const struct four_points *fours, size_t count,
                      const struct picture *pictures, uint32_t first, uint32_t ways)
{
    for (size_t i = 0; i < count; i += 4) {
        wd_four_ints lit = {0};
        uint32_t bits[4];
        for (uint32_t k = 0; k < ways; k++)
            lit |= are_lit(&fours[i / 4], &pictures[k]) & (int32_t)(1u << (first + k));
        memcpy(bits, &lit, sizeof bits);
        for (size_t k = 0; k < 4 && i + k < count; k++)
            open[i + k] |= bits[k];
    }
}

void wd_tree_points_open(uint32_t *open, const struct wd_tree_points *points,
                         const struct wd_tree_mesh *mesh, const struct wd_vec3 *ways, uint32_t count)
{
    struct wd_silhouette frames[TOGETHER];
    struct picture pictures[TOGETHER];
    struct four_points *fours = fours_of(points);
    float *fronts = wd_alloc_array((size_t)TOGETHER * WD_SILHOUETTE_FRONT, sizeof *fronts);
    memset(open, 0, points->count * sizeof *open);
    for (uint32_t first = 0; first < count; first += TOGETHER) {
        uint32_t some = count - first < TOGETHER ? count - first : TOGETHER;
        for (uint32_t k = 0; k < some; k++) {
            wd_silhouette_init(&frames[k], mesh, ways[first + k]);
            pictures[k] = (struct picture){&frames[k], wd_silhouette_axes_of(&frames[k]),
                                           fronts + (size_t)k * WD_SILHOUETTE_FRONT};
        }
        wd_silhouette_front(frames, (int)some, mesh, fronts);
        open_ways(open, fours, points->count, pictures, first, some);
    }
    free(fours);
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
