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

static struct shows look_from_all(const struct wd_tree_point *point,
                                  const struct wd_tree_sides *sides,
                                  const struct wd_silhouette_axes axes[VIEWS])
{
    struct shows shows = {0};
    float n[3], at[3];
    wd_unpack_normal(point->normal, n);
    for (int view = 0; view < VIEWS; view++) {
        const struct wd_silhouette *frame = &sides->frames[view];
        const float *front = sides->fronts + (size_t)view * WD_SILHOUETTE_FRONT;
        float facing = wd_maxf(wd_v3_dot(wd_v3_of(n), frame->toward), 0);
        wd_silhouette_place(&axes[view], point->position_m, at);
        int x = (int)wd_clampf(at[0], 0, WD_SILHOUETTE - 1);
        int y = (int)wd_clampf(at[1], 0, WD_SILHOUETTE - 1);
        shows.all += facing;
        if (front[y * WD_SILHOUETTE + x] <= at[2] + rise_px(facing) / frame->scale)
            shows.seen += facing;
    }
    return shows;
}

void wd_tree_sides_init(struct wd_tree_sides *sides, const struct wd_tree_mesh *mesh)
{
    static const float elevations_deg[2] = {8, 45};
    sides->frames = wd_alloc_array(VIEWS, sizeof *sides->frames);
    sides->fronts = wd_alloc_array((size_t)VIEWS * WD_SILHOUETTE_FRONT, sizeof *sides->fronts);
    for (int view = 0; view < VIEWS; view++) {
        double up = (double)elevations_deg[view / ROUND] * WD_PI / 180;
        double turn = 0.2 + 2 * WD_PI * view / ROUND;
        float level = (float)wd_dcos(up);
        wd_silhouette_init(&sides->frames[view], mesh,
                           WD_V3(level * (float)wd_dcos(turn), level * (float)wd_dsin(turn),
                                 (float)wd_dsin(up)));
    }
    wd_silhouette_front(sides->frames, VIEWS, mesh, sides->fronts);
}

void wd_tree_sides_finish(struct wd_tree_sides *sides)
{
    free(sides->frames);
    free(sides->fronts);
    *sides = (struct wd_tree_sides){0};
}

void wd_tree_points_seen(float *shares, const struct wd_tree_points *points,
                         const struct wd_tree_sides *sides)
{
    struct wd_silhouette_axes axes[VIEWS];
    for (int view = 0; view < VIEWS; view++)
        axes[view] = wd_silhouette_axes_of(&sides->frames[view]);
    for (size_t i = 0; i < points->count; i++) {
        const struct wd_tree_point *point = &points->points[i];
        struct shows shows = {0};
        if (!(point->kind & WD_POINT_LEAF))
            shows = look_from_all(point, sides, axes);
        shares[i] = shows.all > 0 ? shows.seen / shows.all : 0;
    }
}
