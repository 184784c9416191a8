#include "tree/crown_shade.h"

#include <math.h>

#include "base/dmath.h"
#include "shared/sky_rings.h"
#include "tree/silhouette.h"

enum { RINGS = WD_SKY_RINGS, PLACES = 8, SIDES = 48, ABOUT = 3 };
static const double sines[RINGS] = {WD_SKY_RING_SINES}, weights[RINGS] = {WD_SKY_RINGS_LEVEL};
/* Distances from the axis, in radii of the crown. */
static const double distances[PLACES] = {0.06, 0.2, 0.4, 0.6, 0.8, 1.0, 1.3, 1.7};
static const double OVER_M = 0.3;

/* --- what the mesh leaves -------------------------------------------------------------------- */

/* Sums by area over triangles. */
struct moments {
    double area, z, z2, r2;
};

static void add_triangle(struct moments *sum, const struct wd_tree_mesh *mesh, const uint32_t corners[3])
{
    struct wd_vec3 p[3];
    for (int k = 0; k < 3; k++)
        p[k] = wd_v3_of(mesh->vertices[corners[k]].position_m);
    struct wd_vec3 middle = wd_v3_scale(wd_v3_add(p[0], wd_v3_add(p[1], p[2])), 1 / 3.0f);
    double area = (double)wd_v3_length(wd_v3_cross(wd_v3_sub(p[1], p[0]), wd_v3_sub(p[2], p[0])));
    double z = (double)middle.z;
    sum->area += area;
    sum->z += area * z;
    sum->z2 += area * z * z;
    sum->r2 += area * (double)(middle.x * middle.x + middle.y * middle.y);
}

/* Of leaves or, where there are none, of all. */
static struct moments moments_of(const struct wd_tree_mesh *mesh)
{
    struct moments sum = {0};
    uint32_t first = mesh->wood_index_count < mesh->index_count ? mesh->wood_index_count : 0;
    for (uint32_t i = first; i + 2 < mesh->index_count; i += 3)
        add_triangle(&sum, mesh, mesh->indices + i);
    return sum;
}

struct measured {
    double radius_m;
    double left[RINGS][PLACES];
};

static bool is_covered(const struct wd_silhouette *view, double x_m, double y_m)
{
    const float place[3] = {(float)x_m, (float)y_m, (float)OVER_M};
    float at[2];
    wd_silhouette_project(view, place, at);
    if (!(at[0] >= 0 && at[1] >= 0 && at[0] < WD_SILHOUETTE && at[1] < WD_SILHOUETTE))
        return false;
    return view->covered[(int)at[1]][(int)at[0] / 8] >> ((int)at[0] % 8) & 1;
}

/* Of a circle about the stem, and of two close to it. */
static double left_of(const struct wd_silhouette *view, double away_m, double step_m)
{
    int covered = 0;
    for (int about = 0; about < ABOUT; about++)
        for (int side = 0; side < SIDES; side++) {
            double turn = 2 * WD_PI * (side + (double)about / ABOUT) / SIDES;
            double radius_m = away_m + step_m * (about - 1);
            covered += is_covered(view, radius_m * wd_dcos(turn), radius_m * wd_dsin(turn));
        }
    return 1 - (double)covered / (SIDES * ABOUT);
}

static void measure(struct measured *measured, const struct wd_tree_mesh *mesh)
{
    struct wd_silhouette views[RINGS];
    for (int ring = 0; ring < RINGS; ring++) {
        double level = sqrt(1 - sines[ring] * sines[ring]), turn = 2.39996323 * ring;
        wd_silhouette_init(&views[ring], mesh, WD_V3((float)(level * wd_dcos(turn)), (float)(level * wd_dsin(turn)),
                                                     (float)sines[ring]));
    }
    wd_silhouette_cover(views, RINGS, mesh, 0, mesh->index_count);
    for (int ring = 0; ring < RINGS; ring++)
        for (int i = 0; i < PLACES; i++)
            measured->left[ring][i] = left_of(&views[ring], distances[i] * measured->radius_m, 0.04 * measured->radius_m);
}

/* --- the fit --------------------------------------------------------------------------------- */

double wd_crown_shade_leaves(const struct wd_crown_shade *shade, int ring, double away_m, double over_m)
{
    enum { WAYS = 8 }; /* on one side; the other is the same */
    double rise = sines[ring], level = sqrt(1 - rise * rise), sum = 0;
    double radius = (double)shade->radius_m, half = (double)shade->half_m;
    double dx = level / radius, dz = rise / half, ss = dx * dx + dz * dz;
    double z = (over_m - (double)shade->middle_m) / half, away = away_m / radius;
    for (int way = 0; way < WAYS; way++) {
        double along = wd_dcos(WD_PI * (way + 0.5) / WAYS) * away * dx + z * dz;
        double root2 = along * along - ss * (away * away + z * z - 1);
        if (root2 <= 0) {
            sum += 1;
            continue;
        }
        double root = sqrt(root2), way_m = (fmax(root - along, 0) - fmax(-root - along, 0)) / ss;
        sum += wd_dexp(-(double)shade->per_m * way_m);
    }
    return sum / WAYS;
}

static double error_of(const struct wd_crown_shade *shade, const struct measured *measured)
{
    double sum = 0;
    for (int ring = 0; ring < RINGS; ring++)
        for (int i = 0; i < PLACES; i++) {
            double left = wd_crown_shade_leaves(shade, ring, distances[i] * measured->radius_m, OVER_M);
            sum += weights[ring] * (left - measured->left[ring][i]) * (left - measured->left[ring][i]);
        }
    return sum;
}

/* By the steps of a compass, each number in turn, smaller where none brings the fit nearer. */
static struct wd_crown_shade fit(struct wd_crown_shade shade, const struct measured *measured)
{
    enum { NUMBERS = 4, ROUNDS = 40 };
    double best = error_of(&shade, measured), step = 0.3;
    for (int round = 0; round < ROUNDS && step > 0.01; round++) {
        bool nearer = false;
        for (int k = 0; k < 2 * NUMBERS; k++) {
            struct wd_crown_shade tried = shade;
            float factor = (float)(k & 1 ? 1 / (1 + step) : 1 + step);
            float *numbers[NUMBERS] = {&tried.radius_m, &tried.half_m, &tried.middle_m, &tried.per_m};
            *numbers[k / 2] *= factor;
            double error = error_of(&tried, measured);
            if (error < best) {
                best = error;
                shade = tried;
                nearer = true;
            }
        }
        step *= nearer ? 1 : 0.5;
    }
    return shade;
}

/* An even ellipsoid's variance of height is a fifth of half its height squared, its mean squared distance from the axis two
 * fifths of its radius squared; half of its leaves' area stands across a ray. */
struct wd_crown_shade wd_crown_shade_of(const struct wd_tree_mesh *mesh)
{
    struct moments sum = moments_of(mesh);
    if (!(sum.area > 0))
        return (struct wd_crown_shade){.radius_m = 1, .half_m = 1, .middle_m = 1};
    double middle_m = sum.z / sum.area, variance_m2 = fmax(sum.z2 / sum.area - middle_m * middle_m, 0);
    double radius_m = fmax(sqrt(2.5 * sum.r2 / sum.area), 0.05), half_m = fmax(sqrt(5 * variance_m2), 0.05);
    double volume_m3 = 4 / 3.0 * WD_PI * radius_m * radius_m * half_m;
    struct measured measured = {.radius_m = radius_m};
    measure(&measured, mesh);
    const struct wd_crown_shade even = {(float)radius_m, (float)half_m, (float)fmax(middle_m, 0.05),
                                        (float)(0.25 * sum.area / volume_m3)};
    return fit(even, &measured);
}
