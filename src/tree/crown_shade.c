#include "tree/crown_shade.h"

#include <math.h>

#include "base/dmath.h"
#include "shared/sky_rings.h"
#include "tree/silhouette.h"

enum { RINGS = WD_SKY_RINGS, CELL = 8 /* pixels */, CELLS = WD_SILHOUETTE / CELL /* a side */ };
static const double sines[RINGS] = {WD_SKY_RING_SINES}, weights[RINGS] = {WD_SKY_RINGS_LEVEL};
static const double OVER_M = 0.3; /* of the places that are shaded, over the foot */

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
    double area = 0.5 * (double)wd_v3_length(wd_v3_cross(wd_v3_sub(p[1], p[0]), wd_v3_sub(p[2], p[0])));
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

/* Rays toward one ring of the sky, and the share of each cell of a picture of them that passes the mesh. */
struct ring {
    struct wd_vec3 right, up, toward;
    double first_m[2], cell_m; /* middle of the first cell along right and up; a cell's side */
    double weight;             /* of a cell: by the ground that its rays come down to */
    float left[CELLS][CELLS];
};

static float left_of(const struct wd_silhouette *view, int column, int row)
{
    int covered = 0;
    for (int y = row * CELL; y < (row + 1) * CELL; y++)
        for (int x = column * CELL; x < (column + 1) * CELL; x++)
            covered += view->covered[y][x / 8] >> (x % 8) & 1;
    return 1 - (float)covered / (CELL * CELL);
}

static void measure(struct ring rings[RINGS], const struct wd_tree_mesh *mesh)
{
    struct wd_silhouette views[RINGS];
    for (int i = 0; i < RINGS; i++) {
        double level = sqrt(1 - sines[i] * sines[i]), turn = 2.39996323 * i;
        wd_silhouette_init(&views[i], mesh, WD_V3((float)(level * wd_dcos(turn)), (float)(level * wd_dsin(turn)),
                                                  (float)sines[i]));
    }
    wd_silhouette_cover(views, RINGS, mesh, 0, mesh->index_count);
    for (int i = 0; i < RINGS; i++) {
        const struct wd_silhouette *view = &views[i];
        struct ring *ring = &rings[i];
        double pixel_m = 1 / (double)view->scale;
        *ring = (struct ring){.right = view->right, .up = view->up, .toward = view->toward, .cell_m = CELL * pixel_m,
                              .weight = weights[i] / sines[i]};
        for (int k = 0; k < 2; k++)
            ring->first_m[k] = (double)view->low[k] + 0.5 * CELL * pixel_m;
        for (int row = 0; row < CELLS; row++)
            for (int column = 0; column < CELLS; column++)
                ring->left[row][column] = left_of(view, column, row);
    }
}

/* --- the fit --------------------------------------------------------------------------------- */

double wd_crown_shade_transmittance(const struct wd_crown_shade *shade, struct wd_vec3 from, struct wd_vec3 toward)
{
    double per_r = 1 / (double)shade->radius_m, per_h = 1 / (double)shade->half_m;
    double over_m = (double)from.z - (double)shade->middle_m;
    const double p[3] = {(double)from.x * per_r, (double)from.y * per_r, over_m * per_h};
    const double d[3] = {(double)toward.x * per_r, (double)toward.y * per_r, (double)toward.z * per_h};
    double along = p[0] * d[0] + p[1] * d[1] + p[2] * d[2], dd = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    double root2 = along * along - dd * (p[0] * p[0] + p[1] * p[1] + p[2] * p[2] - 1);
    if (root2 <= 0)
        return 1;
    double root = sqrt(root2), way_m = (fmax(root - along, 0) - fmax(-root - along, 0)) / dd;
    double per_m = (double)shade->per_m * wd_dexp((double)shade->steeper * ((double)toward.z - (double)WD_SHADE_SINE));
    return wd_dexp(-per_m * way_m);
}

static double lets_to(const struct wd_crown_shade *shade, const struct ring *ring, int column, int row)
{
    struct wd_vec3 at = wd_v3_scale(ring->right, (float)(ring->first_m[0] + column * ring->cell_m));
    at = wd_v3_mad(at, ring->up, (float)(ring->first_m[1] + row * ring->cell_m));
    at = wd_v3_mad(at, ring->toward, ((float)OVER_M - at.z) / ring->toward.z);
    return wd_crown_shade_transmittance(shade, at, ring->toward);
}

enum { NUMBERS = 5, STEPS = 16 };

/* Normal equations of a step that brings the numbers' logarithms nearer, and the last one itself. */
struct normal {
    double a[NUMBERS][NUMBERS], b[NUMBERS], error;
};

static struct wd_crown_shade changed(struct wd_crown_shade shade, const double by[NUMBERS])
{
    float *numbers[] = {&shade.radius_m, &shade.half_m, &shade.middle_m, &shade.per_m};
    for (int k = 0; k < NUMBERS - 1; k++)
        *numbers[k] *= (float)wd_dexp(by[k]);
    shade.steeper += (float)by[NUMBERS - 1];
    return shade;
}

static void add_row(struct normal *normal, double weight, double off, const double slopes[NUMBERS])
{
    normal->error += weight * off * off;
    for (int i = 0; i < NUMBERS; i++) {
        normal->b[i] -= weight * off * slopes[i];
        for (int k = 0; k < NUMBERS; k++)
            normal->a[i][k] += weight * slopes[i] * slopes[k];
    }
}

/* Of single cells, which tell the crown's form, and of all together: gaps lie otherwise in each crown, so that cells alone
 * would have it hide too little as a whole, and stands of such trees with it. */
static struct normal normal_of(const struct wd_crown_shade *shade, const struct ring rings[RINGS])
{
    static const double APART = 0.01;
    struct wd_crown_shade beside[NUMBERS];
    struct normal normal = {0};
    for (int k = 0; k < NUMBERS; k++) {
        double by[NUMBERS] = {0};
        by[k] = APART;
        beside[k] = changed(*shade, by);
    }
    for (const struct ring *ring = rings; ring < rings + RINGS; ring++) {
        double all = 0, all_slopes[NUMBERS] = {0}, slopes[NUMBERS];
        for (int cell = 0; cell < CELLS * CELLS; cell++) {
            int column = cell % CELLS, row = cell / CELLS;
            double lets = lets_to(shade, ring, column, row), off = lets - (double)ring->left[row][column];
            for (int k = 0; k < NUMBERS; k++) {
                slopes[k] = (lets_to(&beside[k], ring, column, row) - lets) / APART;
                all_slopes[k] += slopes[k];
            }
            all += off;
            add_row(&normal, ring->weight, off, slopes);
        }
        add_row(&normal, ring->weight, all, all_slopes);
    }
    return normal;
}

/* No number changes more in a step. */
static const double MOST_STEP = 0.5;

/* Gaussian elimination; the damped matrix is positive definite. A number that would change more is held, and those
 * before it follow from that. */
static void solve(double x[NUMBERS], const struct normal *normal, double damping)
{
    double a[NUMBERS][NUMBERS + 1];
    for (int i = 0; i < NUMBERS; i++) {
        for (int k = 0; k < NUMBERS; k++)
            a[i][k] = normal->a[i][k] * (i == k ? 1 + damping : 1);
        a[i][i] += 1e-9;
        a[i][NUMBERS] = normal->b[i];
    }
    for (int i = 0; i < NUMBERS; i++)
        for (int below = i + 1; below < NUMBERS; below++) {
            double factor = a[below][i] / a[i][i];
            for (int k = i; k <= NUMBERS; k++)
                a[below][k] -= factor * a[i][k];
        }
    for (int i = NUMBERS - 1; i >= 0; i--) {
        x[i] = a[i][NUMBERS];
        for (int k = i + 1; k < NUMBERS; k++)
            x[i] -= a[i][k] * x[k];
        x[i] = fmin(fmax(x[i] / a[i][i], -MOST_STEP), MOST_STEP);
    }
}

/* Levenberg-Marquardt. */
static struct wd_crown_shade fit(struct wd_crown_shade shade, const struct ring rings[RINGS])
{
    struct normal normal = normal_of(&shade, rings);
    double damping = 0.1;
    for (int step = 0; step < STEPS; step++) {
        double by[NUMBERS];
        solve(by, &normal, damping);
        struct wd_crown_shade tried = changed(shade, by);
        struct normal there = normal_of(&tried, rings);
        bool nearer = there.error < normal.error, settled = fabs(there.error - normal.error) < 1e-3 * normal.error;
        damping *= nearer ? 0.2 : 8;
        if (nearer) {
            shade = tried;
            normal = there;
        }
        if (settled)
            break;
    }
    return shade;
}

/* An even ellipsoid's variance of height is a fifth of half its height squared, its mean squared distance from the axis
 * two fifths of its radius squared; half of its leaves' area stands across a ray. */
struct wd_crown_shade wd_crown_shade_of(const struct wd_tree_mesh *mesh)
{
    struct moments sum = moments_of(mesh);
    if (!(sum.area > 0))
        return (struct wd_crown_shade){.radius_m = 1, .half_m = 1, .middle_m = 1};
    double middle_m = sum.z / sum.area, variance_m2 = fmax(sum.z2 / sum.area - middle_m * middle_m, 0);
    double radius_m = fmax(sqrt(2.5 * sum.r2 / sum.area), 0.05), half_m = fmax(sqrt(5 * variance_m2), 0.05);
    double volume_m3 = 4 / 3.0 * WD_PI * radius_m * radius_m * half_m;
    struct ring rings[RINGS];
    measure(rings, mesh);
    const struct wd_crown_shade even = {(float)radius_m, (float)half_m, (float)fmax(middle_m, 0.05),
                                        (float)(0.5 * sum.area / volume_m3), 0};
    return fit(even, rings);
}
