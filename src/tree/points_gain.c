/* Gains: how large discs must be so that n of them cover as much of a picture as the mesh does.
 *
 * Discs of area A/n each cover too much: leaves overlap in depth and lie at a slant, and a disc
 * wider than the branch it stands for covers what is beside it. Discs of one count differ by their
 * facing alone, so that a pixel is covered when the least of squared distance over facing is below
 * the squared radius; the radius that covers as many pixels as the mesh is a quantile of that. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "tree/points.h"
#include "tree/silhouette.h"

enum { MAX_BINS = 1 << 12, LEVEL_TURNS = 4 };

struct plan {
    struct wd_silhouette tree, wood; /* of the whole mesh, of its wood */
    uint8_t *wood_discs;             /* covered by them */
    float *distance; /* pixels squared over facing: to the nearest point of the class at hand */
};

static void plan_init(struct plan *plan, const struct wd_tree_mesh *mesh, struct wd_vec3 toward)
{
    size_t pixels = (size_t)WD_SILHOUETTE * WD_SILHOUETTE;
    wd_silhouette_init(&plan->tree, mesh, toward);
    wd_silhouette_init(&plan->wood, mesh, toward);
    wd_silhouette_cover(&plan->tree, mesh, 0, mesh->index_count);
    wd_silhouette_cover(&plan->wood, mesh, 0, mesh->wood_index_count);
    plan->wood_discs = wd_alloc(pixels);
    plan->distance = wd_alloc_array(pixels, sizeof(float));
}

static void plan_finish(struct plan *plan)
{
    wd_silhouette_finish(&plan->tree);
    wd_silhouette_finish(&plan->wood);
    free(plan->wood_discs);
    free(plan->distance);
}

static void spread_point(float *distance, const float at[2], float facing, float reach)
{
    int x0 = wd_silhouette_pixel(at[0] - reach), x1 = wd_silhouette_pixel(at[0] + reach);
    int y0 = wd_silhouette_pixel(at[1] - reach), y1 = wd_silhouette_pixel(at[1] + reach);
    float scale = 1 / facing;
    for (int y = y0; y < y1; y++) {
        float dy = (float)y + 0.5f - at[1];
        float *row = distance + y * WD_SILHOUETTE;
        for (int x = x0; x < x1; x++) {
            float dx = (float)x + 0.5f - at[0], d = (dx * dx + dy * dy) * scale;
            row[x] = d < row[x] ? d : row[x];
        }
    }
}

static float facing_of(const struct wd_tree_point *point, struct wd_vec3 toward)
{
    float n[3];
    wd_unpack_normal(point->normal, n);
    float cosine = wd_v3_dot(WD_V3(n[0], n[1], n[2]), toward);
    return point->kind & WD_POINT_ONE_SIDED ? cosine : fabsf(cosine);
}

static void measure_distances(struct plan *plan, const struct wd_tree_point *points, size_t count,
                              uint32_t class, float reach)
{
    for (size_t i = 0; i < (size_t)WD_SILHOUETTE * WD_SILHOUETTE; i++)
        plan->distance[i] = 1e12f;
    for (size_t i = 0; i < count; i++) {
        float at[2], facing = facing_of(&points[i], plan->tree.toward);
        if (!(points[i].kind & class) || !(facing > 1e-3f))
            continue;
        wd_silhouette_project(&plan->tree, points[i].position_m, at);
        spread_point(plan->distance, at, facing, reach * sqrtf(facing));
    }
}

/* Distances of the pixels that discs have to cover, in bins. */
struct quantile {
    uint32_t bins[MAX_BINS + 1];
    size_t wanted;
};

/* Leaves have what wood leaves free. */
static void count_distances(struct quantile *quantile, const struct plan *plan, uint32_t class,
                            float scale)
{
    const struct wd_silhouette *wanted = class == WD_POINT_LEAF ? &plan->tree : &plan->wood;
    for (size_t i = 0; i < (size_t)WD_SILHOUETTE * WD_SILHOUETTE; i++) {
        quantile->wanted += wanted->covered[i];
        if (class == WD_POINT_LEAF && plan->wood_discs[i]) {
            quantile->wanted -= quantile->wanted > 0;
            continue;
        }
        float bin = sqrtf(plan->distance[i]) * scale;
        quantile->bins[bin < MAX_BINS ? (int)bin : MAX_BINS]++;
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

/* Gain of a class for the first `count` points over all plans of one view; 0 where they do not cover
 * as much as the mesh however far discs reach: few points of stems, seen from straight above. */
static float calibrate_class(const struct wd_tree_points *points, struct plan *plans,
                             int plan_count, size_t count, uint32_t class)
{
    struct quantile *quantile = wd_alloc(sizeof *quantile);
    float each = (points->leaf_area_m2 + points->wood_area_m2) / (float)count / (float)WD_PI;
    float most = 1.5f, radius = 0, pixels_per_m = plans[0].tree.scale;
    for (; radius == 0 && most < 40; most *= 3) {
        float reach = sqrtf(most * each) * pixels_per_m, scale = (float)MAX_BINS / reach;
        *quantile = (struct quantile){0};
        for (int i = 0; i < plan_count; i++) {
            size_t window = (size_t)i * count; /* another sample for every plan */
            if (window + count > points->count)
                window = 0;
            measure_distances(&plans[i], points->points + window, count, class, reach);
            count_distances(quantile, &plans[i], class, scale);
        }
        radius = quantile->wanted ? quantile_radius(quantile, scale) : 1e-3f;
    }
    free(quantile);
    for (int i = 0; class == WD_POINT_ONE_SIDED && i < plan_count; i++)
        for (size_t pixel = 0; pixel < (size_t)WD_SILHOUETTE * WD_SILHOUETTE; pixel++)
            plans[i].wood_discs[pixel] = plans[i].distance[pixel] <= radius * radius;
    return radius > 0 ? radius * radius / (pixels_per_m * pixels_per_m * each) : 0;
}

/* Counts without a gain take that of the next larger one, the largest that of the next smaller. */
static void fill_gaps(float *gains)
{
    for (int k = WD_POINT_GAINS - 2; k >= 0; k--)
        gains[k] = gains[k] > 0 ? gains[k] : gains[k + 1];
    gains[0] = gains[0] > 0 ? gains[0] : 1;
    for (int k = 1; k < WD_POINT_GAINS; k++)
        gains[k] = gains[k] > 0 ? gains[k] : gains[k - 1];
}

static void calibrate_view(struct wd_tree_points *points, struct plan *plans, int plan_count,
                           float *wood, float *leaf)
{
    for (int k = 0; k < WD_POINT_GAINS; k++) {
        size_t count = (size_t)WD_POINT_LEAST << k;
        wood[k] = leaf[k] = 0;
        if (k > 0 && count > points->count) /* never drawn */
            continue;
        count = count < points->count ? count : points->count;
        wood[k] = calibrate_class(points, plans, plan_count, count, WD_POINT_ONE_SIDED);
        leaf[k] = calibrate_class(points, plans, plan_count, count, WD_POINT_LEAF);
    }
    fill_gaps(wood);
    fill_gaps(leaf);
}

void wd_tree_points_calibrate(struct wd_tree_points *points, const struct wd_tree_mesh *mesh)
{
    static const struct wd_vec3 turns[LEVEL_TURNS] = {
        {1, 0, 0}, {0.6f, 0.8f, 0}, {0, 1, 0}, {-0.8f, 0.6f, 0}};
    struct plan level[LEVEL_TURNS], above;
    for (int i = 0; i < LEVEL_TURNS; i++)
        plan_init(&level[i], mesh, turns[i]);
    plan_init(&above, mesh, WD_V3(0, 0, 1));
    calibrate_view(points, level, LEVEL_TURNS, points->wood.level, points->leaf.level);
    calibrate_view(points, &above, 1, points->wood.above, points->leaf.above);
    for (int i = 0; i < LEVEL_TURNS; i++)
        plan_finish(&level[i]);
    plan_finish(&above);
}
