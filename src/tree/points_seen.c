/* How much of a tree's bark is seen past its leaves and other wood. */
#include <stdlib.h>

#include "base/dmath.h"
#include "base/memory.h"
#include "tree/points.h"
#include "tree/silhouette.h"

enum { ROUND = 5, VIEWS = 2 * ROUND };

/* What a point shows of itself, and what it would show if nothing stood before it: over all views. */
struct shows {
    float seen, all;
};

/* Pixels hold what is nearest at their middles: a point's own surface may be so much nearer there. */
static float rise_px(float facing)
{
    return fminf(0.3f + 0.7f * sqrtf(fmaxf(1 - facing * facing, 0)) / fmaxf(facing, 0.1f), 2);
}

static void look_at(struct shows *shows, const struct wd_tree_points *points,
                    const struct wd_silhouette *frame, const float *front)
{
    const struct wd_silhouette_axes axes = wd_silhouette_axes_of(frame);
    for (size_t i = 0; i < points->count; i++) {
        const struct wd_tree_point *point = &points->points[i];
        float n[3], at[3];
        if (point->kind & WD_POINT_LEAF)
            continue;
        wd_unpack_normal(point->normal, n);
        float facing = fmaxf(wd_v3_dot(WD_V3(n[0], n[1], n[2]), frame->toward), 0);
        wd_silhouette_place(&axes, point->position_m, at);
        int x = (int)wd_clampf(at[0], 0, WD_SILHOUETTE - 1);
        int y = (int)wd_clampf(at[1], 0, WD_SILHOUETTE - 1);
        shows[i].all += facing;
        if (front[y * WD_SILHOUETTE + x] <= at[2] + rise_px(facing) / frame->scale)
            shows[i].seen += facing;
    }
}

void wd_tree_points_seen(float *shares, const struct wd_tree_points *points,
                         const struct wd_tree_mesh *mesh)
{
    static const float elevations_deg[2] = {8, 45};
    struct shows *shows = wd_alloc_array(points->count + 1, sizeof *shows);
    float *fronts = wd_alloc_array((size_t)VIEWS * WD_SILHOUETTE_FRONT, sizeof *fronts);
    struct wd_silhouette frames[VIEWS];
    for (int view = 0; view < VIEWS; view++) {
        double up = (double)elevations_deg[view / ROUND] * WD_PI / 180;
        double turn = 0.2 + 2 * WD_PI * view / ROUND;
        float level = (float)wd_dcos(up);
        wd_silhouette_init(&frames[view], mesh,
                           WD_V3(level * (float)wd_dcos(turn), level * (float)wd_dsin(turn),
                                 (float)wd_dsin(up)));
    }
    wd_silhouette_front(frames, VIEWS, mesh, fronts);
    for (int view = 0; view < VIEWS; view++)
        look_at(shows, points, &frames[view], fronts + (size_t)view * WD_SILHOUETTE_FRONT);
    for (size_t i = 0; i < points->count; i++)
        shares[i] = shows[i].all > 0 ? shows[i].seen / shows[i].all : 0;
    free(fronts);
    free(shows);
}
