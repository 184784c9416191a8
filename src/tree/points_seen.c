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

static void look_from(struct shows *shows, const struct wd_tree_points *points,
                      const struct wd_tree_mesh *mesh, const struct wd_silhouette *frame)
{
    float(*at)[4] = wd_alloc_array((size_t)mesh->vertex_count + 1, sizeof *at);
    float *front = wd_alloc_array(WD_SILHOUETTE * WD_SILHOUETTE + 3, sizeof *front);
    wd_silhouette_front(frame, mesh, at, front);
    for (size_t i = 0; i < points->count; i++) {
        const struct wd_tree_point *point = &points->points[i];
        float n[3], place[2];
        const float *p = point->position_m;
        wd_unpack_normal(point->normal, n);
        float facing = fmaxf(wd_v3_dot(WD_V3(n[0], n[1], n[2]), frame->toward), 0);
        wd_silhouette_project(frame, p, place);
        int x = (int)wd_clampf(place[0], 0, WD_SILHOUETTE - 1);
        int y = (int)wd_clampf(place[1], 0, WD_SILHOUETTE - 1);
        float toward_m = wd_v3_dot(WD_V3(p[0], p[1], p[2]), frame->toward);
        shows[i].all += facing;
        if (front[y * WD_SILHOUETTE + x] <= toward_m + rise_px(facing) / frame->scale)
            shows[i].seen += facing;
    }
    free(at);
    free(front);
}

void wd_tree_points_seen(float *shares, const struct wd_tree_points *points,
                         const struct wd_tree_mesh *mesh)
{
    static const float elevations_deg[2] = {8, 45};
    struct shows *shows = wd_alloc_array(points->count + 1, sizeof *shows);
    for (int view = 0; view < VIEWS; view++) {
        double up = (double)elevations_deg[view / ROUND] * WD_PI / 180;
        double turn = 0.2 + 2 * WD_PI * view / ROUND;
        float level = (float)wd_dcos(up);
        struct wd_silhouette frame;
        wd_silhouette_init(&frame, mesh, WD_V3(level * (float)wd_dcos(turn),
                                               level * (float)wd_dsin(turn), (float)wd_dsin(up)));
        look_from(shows, points, mesh, &frame);
        wd_silhouette_finish(&frame);
    }
    for (size_t i = 0; i < points->count; i++)
        shares[i] = shows[i].all > 0 ? shows[i].seen / shows[i].all : 0;
    free(shows);
}
