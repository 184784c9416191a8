/* Gains: how large discs must be so that n of them cover as much of a picture as the mesh does.
 *
 * Discs of area A/n each, as many as stand for all leaves, cover too much: leaves overlap in depth
 * and lie at a slant, discs face the viewer. All discs of one count have the same radius, so that a
 * pixel is covered when its nearest point is nearer than that radius; the radius that covers as
 * many pixels as the mesh is therefore a quantile of the distances to the nearest point. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "tree/points.h"
#include "tree/silhouette.h"

enum { MAX_BINS = 1 << 12, LEVEL_TURNS = 2 };

struct plan {
    struct wd_silhouette tree, wood; /* of the whole mesh, of its wood */
    float *leaf_distance, *distance; /* squared, pixels: to the nearest point of leaves, of all */
};

static void plan_init(struct plan *plan, const struct wd_tree_mesh *mesh, struct wd_vec3 toward)
{
    size_t pixels = (size_t)WD_SILHOUETTE * WD_SILHOUETTE;
    wd_silhouette_init(&plan->tree, mesh, toward);
    wd_silhouette_init(&plan->wood, mesh, toward);
    wd_silhouette_cover(&plan->tree, mesh, 0, mesh->index_count);
    wd_silhouette_cover(&plan->wood, mesh, 0, mesh->wood_index_count);
    plan->leaf_distance = wd_alloc_array(pixels, sizeof(float));
    plan->distance = wd_alloc_array(pixels, sizeof(float));
}

static void plan_finish(struct plan *plan)
{
    wd_silhouette_finish(&plan->tree);
    wd_silhouette_finish(&plan->wood);
    free(plan->leaf_distance);
    free(plan->distance);
}

static void spread_point(float *distance, const float at[2], float reach)
{
    int x0 = wd_silhouette_pixel(at[0] - reach), x1 = wd_silhouette_pixel(at[0] + reach);
    int y0 = wd_silhouette_pixel(at[1] - reach), y1 = wd_silhouette_pixel(at[1] + reach);
    for (int y = y0; y < y1; y++) {
        float dy = (float)y + 0.5f - at[1];
        float *row = distance + y * WD_SILHOUETTE;
        for (int x = x0; x < x1; x++) {
            float dx = (float)x + 0.5f - at[0], d = dx * dx + dy * dy;
            row[x] = d < row[x] ? d : row[x];
        }
    }
}

static bool faces(const struct wd_tree_point *point, struct wd_vec3 toward)
{
    float n[3];
    wd_unpack_normal(point->normal, n);
    return wd_v3_dot(WD_V3(n[0], n[1], n[2]), toward) > 0;
}

static void measure_distances(struct plan *plan, const struct wd_tree_point *points, size_t count,
                              float reach)
{
    size_t pixels = (size_t)WD_SILHOUETTE * WD_SILHOUETTE;
    for (size_t i = 0; i < pixels; i++)
        plan->leaf_distance[i] = 1e12f;
    for (int pass = 0; pass < 2; pass++) { /* leaves first */
        for (size_t i = 0; i < count; i++) {
            bool leaf = points[i].kind & WD_POINT_LEAF;
            float at[2];
            wd_silhouette_project(&plan->tree, points[i].position_m, at);
            if (leaf && pass == 0)
                spread_point(plan->leaf_distance, at, reach);
            else if (!leaf && pass == 1 && faces(&points[i], plan->tree.toward))
                spread_point(plan->distance, at, reach);
        }
        if (pass == 0)
            memcpy(plan->distance, plan->leaf_distance, pixels * sizeof(float));
    }
}

/* Distances of the pixels that discs have to cover, in bins. */
struct quantile {
    uint32_t bins[MAX_BINS + 1];
    size_t wanted;
};

static void count_distances(struct quantile *quantile, const struct plan *plan,
                            enum wd_point_use use, float scale)
{
    const float *distance = use == WD_POINTS_ALL ? plan->distance : plan->leaf_distance;
    for (size_t i = 0; i < (size_t)WD_SILHOUETTE * WD_SILHOUETTE; i++) {
        if (use == WD_POINTS_LEAVES && plan->wood.covered[i])
            continue; /* drawn anyway */
        float bin = sqrtf(distance[i]) * scale;
        quantile->bins[bin < MAX_BINS ? (int)bin : MAX_BINS]++;
        quantile->wanted += plan->tree.covered[i];
    }
}

/* The radius in pixels, or 0 where points within reach do not suffice. */
static float quantile_radius(const struct quantile *quantile, float scale)
{
    size_t below = 0;
    for (int bin = 0; bin < MAX_BINS; bin++) {
        if (below + quantile->bins[bin] >= quantile->wanted) {
            float part = (float)(quantile->wanted - below) / fmaxf((float)quantile->bins[bin], 1);
            return ((float)bin + part) / scale;
        }
        below += quantile->bins[bin];
    }
    return 0;
}

/* Gains of both uses for `count` points over all plans of one view. Discs reach out as far as the
 * gain may become; seldom is that not enough. */
static void calibrate_count(const struct wd_tree_points *points, struct plan *plans, int plan_count,
                            size_t count, float gain[WD_POINT_USES])
{
    struct quantile *quantile = wd_alloc(sizeof *quantile);
    float each = (points->leaf_area_m2 + points->wood_area_m2) / (float)count / (float)WD_PI;
    bool found = false;
    for (float most = 1.5f; !found && most < 40; most *= 3) {
        found = true;
        float reach_m = sqrtf(most * each), scale = (float)MAX_BINS / (reach_m * plans[0].tree.scale);
        for (int i = 0; i < plan_count; i++)
            measure_distances(&plans[i], points->points, count, reach_m * plans[i].tree.scale);
        for (int use = 0; use < WD_POINT_USES; use++) {
            *quantile = (struct quantile){0};
            for (int i = 0; i < plan_count; i++)
                count_distances(quantile, &plans[i], (enum wd_point_use)use, scale);
            float radius = quantile_radius(quantile, scale) / plans[0].tree.scale;
            gain[use] = radius > 0 ? radius * radius / each : most;
            found = found && radius > 0;
        }
    }
    free(quantile);
}

void wd_tree_points_calibrate(struct wd_tree_points *points, const struct wd_tree_mesh *mesh)
{
    for (int view = 0; view < WD_POINT_VIEWS; view++) {
        struct plan plans[LEVEL_TURNS];
        int plan_count = view == WD_POINTS_LEVEL ? LEVEL_TURNS : 1;
        for (int i = 0; i < plan_count; i++)
            plan_init(&plans[i], mesh,
                      view == WD_POINTS_ABOVE ? WD_V3(0, 0, 1) : WD_V3(i == 0, i == 1, 0));
        for (int k = 0; k < WD_POINT_GAINS; k++) {
            float gain[WD_POINT_USES];
            size_t count = (size_t)WD_POINT_LEAST << k;
            if (k > 0 && count > points->count) { /* never drawn */
                for (int use = 0; use < WD_POINT_USES; use++)
                    points->gain[use][view][k] = points->gain[use][view][k - 1];
                continue;
            }
            count = count < points->count ? count : points->count;
            calibrate_count(points, plans, plan_count, count, gain);
            for (int use = 0; use < WD_POINT_USES; use++)
                points->gain[use][view][k] = gain[use];
        }
        for (int i = 0; i < plan_count; i++)
            plan_finish(&plans[i]);
    }
}
