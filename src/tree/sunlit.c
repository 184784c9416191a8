#include "tree/sunlit.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "shared/crown.h"
#include "shared/wax.h"
#include "tree/leaves_open.h"

enum { POINTS = 4096, EYES = 21, STEPS = 16, LOW_WAYS = 8, NEAR_EACH = 4 /* way of the sun */, CELLS = 10 };

/* Eyes stand between the sun's ways: of what an eye sees that looks along one of these, all would be lit. */
static const uint32_t eyes_on_ring[WD_EYE_RINGS] = {5, 6, 5, 4, 1};
enum { LEVEL_EYE = 5 }; /* the first one 10 degrees up */
static const float EYE_OFF = 0.04f, EYE_HIGHEST_SINE = 0.9976f;

struct eye {
    struct wd_vec3 toward;
    uint32_t ring;
    float turn; /* of a whole one */
};

static void place_eyes(struct eye eyes[EYES])
{
    for (uint32_t ring = 0, i = 0; ring < WD_EYE_RINGS; ring++)
        for (uint32_t k = 0; k < eyes_on_ring[ring]; k++, i++) {
            float sine = fminf(WD_EYE_RING_SINE(ring), EYE_HIGHEST_SINE);
            float level = sqrtf(1 - sine * sine);
            float turn = ((float)k + EYE_OFF) / (float)eyes_on_ring[ring], rad = 6.2831853f * turn;
            eyes[i] = (struct eye){WD_V3(level * cosf(rad), level * sinf(rad), sine), ring, turn};
        }
}

/* From the ground, on the sun's rings but upside down: few, for they count little. */
static const uint32_t low_on_ring[] = {3, 3, 2};
static const float LOW_OFF = 0.11f;

/* Of all ways up or down those that a ring stands for. */
static const float ring_share[WD_SUN_RINGS] = {0.374f, 0.354f, 0.213f, 0.059f};
static const float low_ring_share[] = {0.374f, 0.354f, 0.272f};

static void place_sky_ways(struct wd_sky_way ways[WD_SUN_WAYS + LOW_WAYS])
{
    uint32_t i = 0;
    for (uint32_t ring = 0; ring < WD_SUN_RINGS; ring++)
        for (uint32_t k = 0; k < WD_SUN_RING_COUNT(ring); k++, i++)
            ways[i] = (struct wd_sky_way){wd_sun_way(i), 2 * ring_share[ring] / (float)WD_SUN_RING_COUNT(ring)};
    for (uint32_t ring = 0; ring < sizeof low_on_ring / sizeof low_on_ring[0]; ring++)
        for (uint32_t k = 0; k < low_on_ring[ring]; k++, i++) {
            float rad = 6.2831853f * ((float)k + LOW_OFF * (float)(1 + ring)) / (float)low_on_ring[ring];
            float sine = WD_SUN_RING_SINE(ring), level = sqrtf(1 - sine * sine);
            ways[i] = (struct wd_sky_way){WD_V3(level * cosf(rad), level * sinf(rad), -sine),
                                          2 * low_ring_share[ring] / (float)low_on_ring[ring]};
        }
}

/* Light from above and from below, of a side of leaves or wood, then of the other: what comes to it, and
 * what shared/sunlit.h would say without its table. */
struct skylit {
    float comes[WD_SKYLIT_KINDS], told[WD_SKYLIT_KINDS];
};

/* What all points send from one way of the sun to one eye. */
enum {
    SEEN,                   /* area of leaves toward the eye */
    REFLECTED, TRANSMITTED,
    BY_DEPTH,               /* the same by depth, of the leaf's own place and side; */
    DEEP, CARD,             /* its area by depth, and by depth of the place of a card */
    WOOD, WOOD_DEEP,        /* of the wood seen, and the same by depth; */
    WOOD_LEFT,              /* its area by depth */
    MIRRORED,               /* by the wax of leaves */
    LIT,                    /* reflected and transmitted, and */
    WOOD_LIT,               /* the wood, where those are over a cloud's (over_cloud) */
    UPPER,                  /* area of upper sides of leaves, */
    UPPER_REFLECTED, UPPER_TRANSMITTED, /* and what eyes see of these of the sun */
    SENT
};

struct sent {
    float of[SENT];
};

struct fit {
    struct eye eyes[EYES];
    struct wd_vec3 suns[WD_SUN_WAYS];
    struct wd_vec3 middle_m, radii_m; /* of the crown */
    float curve[2];                   /* of wd_crown_lit */
    struct wd_sky_way sky[WD_SUN_WAYS + LOW_WAYS];
    const uint32_t *views;            /* of each point, which of the eyes see it, then which of the ways from
                                         below are open */
    struct sent sent[EYES][WD_SUN_WAYS];
    struct skylit skylit[WD_SKYLIT_PLACES];
    float crown_seen[WD_EYE_RINGS], crown_wood[WD_EYE_RINGS]; /* area toward eyes above the lowest living branch */
    float below_seen[WD_EYE_RINGS], stem[WD_EYE_RINGS];       /* and below it */
    float leaf_seen[WD_EYE_RINGS], leaf_open[WD_EYE_RINGS];   /* of leaves, and times their openness */
};

static void set_crown(struct fit *fit, const struct wd_tree_model *model)
{
    float deep_m = fmaxf(0.5f * (model->height_m - model->crown_base_m), 0.1f);
    float radius_m = fmaxf(model->crown_radius_m, 0.1f);
    fit->middle_m = WD_V3(0, 0, 0.5f * (model->height_m + model->crown_base_m));
    fit->radii_m = WD_V3(radius_m, radius_m, deep_m);
}

/* The place that a card's texel stands for, seen from far away. */
static struct wd_vec3 card_place(const struct fit *fit, struct wd_vec3 p, struct wd_vec3 toward)
{
    const float far_m = 1000;
    struct wd_vec3 eye = wd_v3_add(p, wd_v3_scale(toward, far_m));
    struct wd_vec3 place = wd_crown_card_place(wd_v3_sub(fit->middle_m, eye), fit->radii_m,
                                               wd_v3_scale(toward, -1));
    return wd_v3_sub(wd_v3_add(place, eye), fit->middle_m);
}

/* Turned as the path tracer turns it: out of the side that the eye sees. */
static void turn_to_eye(struct wd_vec3 *face, struct wd_vec3 *normal, struct wd_vec3 toward)
{
    if (wd_v3_dot(*face, toward) < 0)
        *face = wd_v3_scale(*face, -1);
    if (wd_v3_dot(*normal, *face) < 0)
        *normal = wd_v3_scale(*normal, -1);
    if (wd_v3_dot(*normal, toward) <= 0)
        *normal = *face;
}

struct shown {
    struct wd_vec3 place, face, normal; /* place: from the crown's middle */
    float openness;
    float left[WD_SUN_WAYS]; /* of the sun, by depth */
    uint32_t lit, low;
};

/* Upper sides have a mean leaf's roughness. */
static float wax_mirrors(struct wd_vec3 normal, struct wd_vec3 eye, struct wd_vec3 sun)
{
    const float alpha2 = 0.0625f;
    struct wd_vec3 half_way = wd_v3_unit(wd_v3_add(eye, sun));
    return wd_wax_mirrors(fmaxf(wd_v3_dot(normal, eye), 0.05f), wd_v3_dot(normal, sun), wd_v3_dot(normal, half_way),
                          wd_v3_dot(half_way, eye), alpha2);
}

/* What depth leaves of the sun to a card's place where it shows a leaf so open. */
static float card_left(const struct fit *fit, struct wd_vec3 place, float openness, uint32_t way)
{
    float path_m = wd_crown_path_m(place, fit->radii_m, fit->suns[way]);
    return wd_crown_lit(wd_crown_through(fit->radii_m, path_m, openness), fit->curve[0], fit->curve[1]);
}

static void send_leaf(struct fit *fit, const struct shown *point, uint32_t eye, float mixed)
{
    struct wd_vec3 toward = fit->eyes[eye].toward, face = point->face, normal = point->normal;
    turn_to_eye(&face, &normal, toward);
    float area = wd_v3_dot(face, toward), area_above = wd_v3_dot(point->face, toward);
    struct wd_vec3 card = card_place(fit, wd_v3_add(point->place, fit->middle_m), toward);
    for (uint32_t way = 0; way < WD_SUN_WAYS; way++) {
        struct sent *sent = &fit->sent[eye][way];
        struct wd_vec3 sun = fit->suns[way];
        float cosine = wd_v3_dot(normal, sun);
        bool behind = wd_v3_dot(face, sun) < 0, lost = behind != (cosine < 0);
        float side = lost ? 0 : area * fabsf(cosine);
        sent->of[SEEN] += area;
        float lit = side * wd_sun_way_lit(point->lit, way);
        sent->of[behind ? TRANSMITTED : REFLECTED] += lit;
        if (area_above > 0) {
            sent->of[UPPER] += area;
            sent->of[behind ? UPPER_TRANSMITTED : UPPER_REFLECTED] += lit;
        }
        sent->of[BY_DEPTH] += side * point->left[way];
        sent->of[DEEP] += area * point->left[way];
        sent->of[CARD] += area * card_left(fit, card, mixed, way);
        if (area_above > 0 && !behind && cosine > 0 && wd_sun_way_lit(point->lit, way) > 0)
            sent->of[MIRRORED] += area * wax_mirrors(normal, toward, sun);
    }
}

static void send_wood(struct fit *fit, const struct shown *point, uint32_t eye)
{
    float area = fmaxf(wd_v3_dot(point->face, fit->eyes[eye].toward), 0);
    for (uint32_t way = 0; way < WD_SUN_WAYS; way++) {
        struct sent *sent = &fit->sent[eye][way];
        float side = area * fmaxf(wd_v3_dot(point->normal, fit->suns[way]), 0);
        sent->of[WOOD] += side * wd_sun_way_lit(point->lit, way);
        sent->of[WOOD_DEEP] += side * point->left[way];
        sent->of[WOOD_LEFT] += area * point->left[way];
    }
}

static struct shown shown_at(const struct fit *fit, const struct wd_tree_points *points, size_t i)
{
    const struct wd_tree_point *point = &points->points[i];
    float face[3], normal[3];
    wd_unpack_normal(point->face, face);
    wd_unpack_normal(point->normal, normal);
    struct shown shown = {wd_v3_sub(wd_v3_of(point->position_m), fit->middle_m), wd_v3_of(face),
                          wd_v3_of(normal), (float)(point->albedo >> 24) / 255, {0},
                          points->lit[i], fit->views[i] >> EYES};
    for (uint32_t way = 0; way < WD_SUN_WAYS; way++)
        shown.left[way] = wd_crown_through(
            fit->radii_m, wd_crown_path_m(shown.place, fit->radii_m, fit->suns[way]),
            shown.openness);
    return shown;
}

/* `up`: the share of a sky without horizon that it would see. */
static void tell(struct skylit *of, float up, float openness, float area)
{
    float above = area * wd_skylit_above(openness), below = area * wd_skylit_below(openness);
    memcpy(of->told, (float[]){up * above, (1 - up) * above, (1 - up) * below, up * below},
           sizeof of->told);
}

/* Of the point's face and of its other side, as the path tracer's scatter light: about the normal `n`, and
 * what of that lies beyond the surface is mirrored back. */
static struct skylit skylit_at(const struct fit *fit, const struct shown *point, struct wd_vec3 n)
{
    struct skylit of = {0};
    for (uint32_t i = 0; i < WD_SUN_WAYS + LOW_WAYS; i++) {
        bool low = i >= WD_SUN_WAYS;
        if (!(low ? point->low >> (i - WD_SUN_WAYS) & 1 : point->lit >> i & 1))
            continue;
        struct wd_vec3 toward = fit->sky[i].toward;
        float rise = wd_v3_dot(point->face, toward), side = rise < 0 ? -1 : 1;
        float along = side * wd_v3_dot(n, toward);
        float mirrored = along - 2 * fabsf(rise) * wd_v3_dot(n, point->face);
        of.comes[2 * low + (rise < 0)] +=
            fit->sky[i].brings * (fmaxf(along, 0) + fmaxf(mirrored, 0));
    }
    tell(&of, 0.5f + 0.5f * n.z, point->openness, 1);
    return of;
}

/* What an eye sees of it: `area` toward the eye, negative of the other side. */
static struct skylit seen_of(const struct skylit *of, float area)
{
    struct skylit seen;
    for (uint32_t k = 0; k < WD_SKYLIT_KINDS; k++) {
        uint32_t from = area < 0 ? k ^ 1 : k;
        seen.comes[k] = fabsf(area) * of->comes[from];
        seen.told[k] = fabsf(area) * of->told[from];
    }
    return seen;
}

/* A cloud's normal is the same for all leaves that an eye sees. */
static void tell_cloud(struct skylit *seen, const struct shown *point, float eye_sine, float area)
{
    float up = 0.5f + 0.5f * wd_leaves_seen_up(eye_sine);
    tell(seen, up, point->openness, fabsf(area));
}

static void add_skylight(struct skylit *sum, const struct skylit *seen)
{
    for (uint32_t k = 0; k < WD_SKYLIT_KINDS; k++) {
        sum->comes[k] += seen->comes[k];
        sum->told[k] += seen->told[k];
    }
}

/* As turn_to_eye has it: an eye that is beyond the leaf by its normal sees it flat. */
static void send_skylight(struct fit *fit, const struct shown *point, uint32_t seen, bool wood)
{
    struct wd_vec3 n = point->normal, face = point->face;
    n = wd_v3_dot(n, face) < 0 ? wd_v3_scale(n, -1) : n;
    const struct skylit bent = skylit_at(fit, point, n), flat = skylit_at(fit, point, face);
    for (uint32_t i = 0; i < EYES; i++) {
        const struct eye *eye = &fit->eyes[i];
        float area = wd_v3_dot(face, eye->toward);
        if (!(seen >> i & 1) || (wood && area <= 0))
            continue;
        struct skylit of = seen_of(wd_v3_dot(n, eye->toward) * area <= 0 ? &flat : &bent, area);
        add_skylight(&fit->skylit[(wood ? WD_SKYLIT_WOOD : WD_SKYLIT_LEAVES) + eye->ring], &of);
        if (wood)
            continue;
        fit->leaf_seen[eye->ring] += fabsf(area);
        fit->leaf_open[eye->ring] += fabsf(area) * point->openness;
        tell_cloud(&of, point, eye->toward.z, area);
        add_skylight(&fit->skylit[WD_SKYLIT_CLOUDS + eye->ring], &of);
    }
}

/* Area that all eyes see. */
static float seen_by_eyes(const struct fit *fit, size_t point, struct wd_vec3 face)
{
    float seen = 0;
    for (uint32_t i = 0; i < EYES; i++)
        seen += fabsf(wd_v3_dot(face, fit->eyes[i].toward)) * (float)(fit->views[point] >> i & 1);
    return seen;
}

/* Share of what leaves scatter, as much to any way, that meets others of the tree. */
static float find_recollision(const struct fit *fit, const struct wd_tree_points *points, const struct shown *shown)
{
    double all = 0, hidden = 0;
    for (size_t i = 0; i < points->count; i++)
        for (uint32_t way = 0; way < WD_SUN_WAYS + LOW_WAYS && points->points[i].kind & WD_POINT_LEAF; way++) {
            bool low = way >= WD_SUN_WAYS;
            bool open = low ? shown[i].low >> (way - WD_SUN_WAYS) & 1 : shown[i].lit >> way & 1;
            float share = fit->sky[way].brings * fabsf(wd_v3_dot(shown[i].face, fit->sky[way].toward));
            all += (double)share;
            hidden += open ? 0 : (double)share;
        }
    return all > 0 ? (float)(hidden / all) : 0;
}

/* A sky of radiance 1 + k (1 - 1.5 z), z the sine of the elevation, is as bright on level ground as one of 1, and on an
 * upright face brighter by LOW_UPRIGHT k. Of what eyes see, each leaf by both sides: how much more of it comes than of
 * an even one, over that without the tree's leaves. */
static const float LOW_UPRIGHT = 0.3634f;

static float find_low_sky(const struct fit *fit, const struct wd_tree_points *points, const struct shown *shown)
{
    double all[2] = {0}, comes[2] = {0};
    for (size_t i = 0; i < points->count; i++) {
        double seen = (double)seen_by_eyes(fit, i, shown[i].face);
        for (uint32_t way = 0; way < WD_SUN_WAYS && points->points[i].kind & WD_POINT_LEAF; way++) {
            double share = seen * (double)fit->sky[way].brings, rise = (double)fit->sky[way].toward.z;
            share *= (double)fabsf(wd_v3_dot(shown[i].face, fit->sky[way].toward));
            double open = (double)wd_sun_way_lit(shown[i].lit, way);
            all[0] += share, all[1] += share * rise;
            comes[0] += share * open, comes[1] += share * rise * open;
        }
    }
    return comes[0] > 0 ? 1.5f / LOW_UPRIGHT * (float)(all[1] / all[0] - comes[1] / comes[0]) : 0;
}

static float find_flatness(const struct wd_tree_points *points)
{
    double sum = 0;
    size_t leaves = 0;
    for (size_t i = 0; i < points->count; i++) {
        if (!(points->points[i].kind & WD_POINT_LEAF))
            continue;
        float face[3];
        wd_unpack_normal(points->points[i].face, face);
        sum += (double)fabsf(face[2]);
        leaves++;
    }
    return leaves ? (float)(sum / (double)leaves) : 0;
}

/* How many places are lit of those where depth leaves as much of the sun: 1 - exp(-a x^b), a line through
 * logarithms. Whichever way the eye and the sun are, it is nearly the same curve. */
static void fit_curve(struct fit *fit, const struct wd_tree_points *points,
                      const struct shown *shown)
{
    double all[STEPS] = {0}, lit[STEPS] = {0}, n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (size_t i = 0; i < points->count; i++) {
        if (!(points->points[i].kind & WD_POINT_LEAF))
            continue;
        for (uint32_t way = 0; way < WD_SUN_WAYS; way++) {
            int step = (int)fminf(shown[i].left[way] * STEPS, STEPS - 1);
            float side = fabsf(wd_v3_dot(shown[i].face, fit->suns[way]));
            all[step] += (double)side;
            lit[step] += (double)(side * wd_sun_way_lit(shown[i].lit, way));
        }
    }
    for (int step = 0; step < STEPS; step++) {
        if (all[step] <= 0 || lit[step] <= 0.002 * all[step] || lit[step] >= 0.998 * all[step])
            continue;
        double x = log((step + 0.5) / STEPS), y = log(-log(1 - lit[step] / all[step]));
        double weight = lit[step];
        n += weight, sx += weight * x, sy += weight * y;
        sxx += weight * x * x, sxy += weight * x * y;
    }
    double spread = n * sxx - sx * sx;
    fit->curve[1] = spread > 1e-9 * n * n ? (float)fmin(fmax((n * sxy - sx * sy) / spread, 0.5), 4) : 1;
    fit->curve[0] = n > 0 ? (float)exp((sy - (double)fit->curve[1] * sx) / n) : 1;
}

/* A texel of a picture has the mean openness of all that it shows, leaves and wood: that of a cell of the crown's outline,
 * as the eye sees it. */
struct cell {
    float open, area;
};

struct cells {
    struct wd_vec3 right, up;
    float per_m;
    struct cell of[CELLS][CELLS];
};

static struct cell *cell_at(struct cells *cells, struct wd_vec3 place)
{
    float x = wd_v3_dot(place, cells->right) * cells->per_m, y = wd_v3_dot(place, cells->up) * cells->per_m;
    int row = (int)wd_clampf(y + 0.5f * CELLS, 0, CELLS - 1);
    return &cells->of[row][(int)wd_clampf(x + 0.5f * CELLS, 0, CELLS - 1)];
}

static void fill_cells(struct cells *cells, const struct fit *fit, const struct wd_tree_points *points,
                       const struct shown *shown, uint32_t eye)
{
    struct wd_vec3 toward = fit->eyes[eye].toward;
    float half_m = 1.1f * fmaxf(fit->radii_m.x, fit->radii_m.z);
    *cells = (struct cells){.right = wd_v3_side(toward), .per_m = 0.5f * CELLS / half_m};
    cells->up = wd_v3_cross(cells->right, toward);
    for (size_t i = 0; i < points->count; i++) {
        if (!(fit->views[i] >> eye & 1))
            continue;
        float area = wd_v3_dot(shown[i].face, toward);
        area = points->points[i].kind & WD_POINT_LEAF ? fabsf(area) : fmaxf(area, 0);
        struct cell *cell = cell_at(cells, shown[i].place);
        cell->open += area * shown[i].openness;
        cell->area += area;
    }
}

static float mixed_openness(struct cells *cells, struct wd_vec3 place)
{
    const struct cell *cell = cell_at(cells, place);
    return cell->area > 0 ? cell->open / cell->area : 1;
}

/* What eyes see of the crown and below it, and of wood there. */
static void count_wood(struct fit *fit, const struct shown *point, uint32_t seen, bool wood)
{
    bool below = point->place.z <= -fit->radii_m.z;
    float *all = below ? fit->below_seen : fit->crown_seen, *of_wood = below ? fit->stem : fit->crown_wood;
    for (uint32_t i = 0; i < EYES; i++) {
        float area = wd_v3_dot(point->face, fit->eyes[i].toward);
        if (!(seen >> i & 1) || (wood && area <= 0))
            continue;
        all[fit->eyes[i].ring] += fabsf(area);
        of_wood[fit->eyes[i].ring] += wood ? area : 0;
    }
}

static void send(struct fit *fit, const struct wd_tree_points *points, const struct shown *all)
{
    struct cells *cells = wd_alloc_array(EYES, sizeof *cells);
    for (uint32_t eye = 0; eye < EYES; eye++)
        fill_cells(&cells[eye], fit, points, all, eye);
    for (size_t i = 0; i < points->count; i++) {
        struct shown shown = all[i];
        for (uint32_t way = 0; way < WD_SUN_WAYS; way++)
            shown.left[way] = wd_crown_lit(shown.left[way], fit->curve[0], fit->curve[1]);
        send_skylight(fit, &shown, fit->views[i], !(points->points[i].kind & WD_POINT_LEAF));
        count_wood(fit, &shown, fit->views[i], !(points->points[i].kind & WD_POINT_LEAF));
        for (uint32_t eye = 0; eye < EYES; eye++)
            if (fit->views[i] >> eye & 1 && points->points[i].kind & WD_POINT_LEAF)
                send_leaf(fit, &shown, eye, mixed_openness(&cells[eye], shown.place));
            else if (fit->views[i] >> eye & 1)
                send_wood(fit, &shown, eye);
    }
    free(cells);
}

/* Least squares, each way by how much of its light is seen from above. */
static void fit_wax(float wax[2], const struct fit *fit)
{
    double n = 0, sx = 0, sxx = 0, sy = 0, sxy = 0;
    for (uint32_t eye = LEVEL_EYE; eye < EYES; eye++)
        for (uint32_t way = 0; way < WD_SUN_WAYS; way++) {
            const struct sent *sent = &fit->sent[eye][way];
            float sides = sent->of[REFLECTED] + sent->of[TRANSMITTED];
            if (sides <= 1e-4f * sent->of[SEEN])
                continue;
            double weight = (double)(sides / sent->of[SEEN]), y = (double)(sent->of[MIRRORED] / (sides * WD_WAX));
            double x = (double)wd_cloud_wax_rise(wd_v3_dot(fit->eyes[eye].toward, fit->suns[way]));
            n += weight, sx += weight * x, sxx += weight * x * x;
            sy += weight * y, sxy += weight * x * y;
        }
    double spread = n * sxx - sx * sx;
    double rise = spread > 1e-9 * n * n ? fmax((n * sxy - sx * sy) / spread, 0) : 0;
    wax[0] = n > 0 ? (float)fmax((sy - rise * sx) / n, 0) : 0;
    wax[1] = (float)rise;
}

/* Steps of half a turn between an eye and a way of the sun. */
static float steps_apart(const struct eye *eye, uint32_t sun_ring, uint32_t way)
{
    float sun = (float)(way - WD_SUN_RING_FIRST(sun_ring)) / (float)WD_SUN_RING_COUNT(sun_ring);
    float apart = fabsf(eye->turn - sun);
    return 2 * (WD_SUNLIT_TURNS - 1) * fminf(apart, 1 - apart);
}

static float angle_of(float cosine)
{
    return acosf(fminf(fmaxf(cosine, -1), 1));
}

/* What a model sends over what wd_cloud_*, wd_wood_reflects and wd_sunlit_hot tell. */
static struct sent over_cloud(const struct sent *sent, struct wd_vec3 eye, struct wd_vec3 sun)
{
    struct sent over = *sent;
    float cosine = wd_v3_dot(eye, sun), angle = angle_of(cosine), hot = wd_sunlit_hot(angle);
    float level = sqrtf((1 - eye.z * eye.z) * (1 - sun.z * sun.z));
    float turned = level > 1e-4f ? (eye.x * sun.x + eye.y * sun.y) / level : 1;
    float reflects = hot * (wd_cloud_reflects(cosine, angle) + WD_CLOUD_LEAST);
    float transmits = hot * (wd_cloud_transmits(cosine, angle) + WD_CLOUD_LEAST);
    over.of[LIT] = (sent->of[REFLECTED] + sent->of[TRANSMITTED]) / hot;
    over.of[WOOD_LIT] = sent->of[WOOD] / hot;
    over.of[REFLECTED] /= reflects;
    over.of[TRANSMITTED] /= transmits;
    over.of[WOOD] /= hot * wd_wood_reflects(cosine, angle, turned, angle_of(turned), level);
    return over;
}

/* Least squares: what a table that is mixed between steps is to hold, so that it comes nearest to all that
 * was sent. A triangle of normal equations: of each step, and of it and the next. */
struct steps {
    double own[WD_SUNLIT_TURNS], next[WD_SUNLIT_TURNS], sums[WD_SUNLIT_TURNS][SENT];
};

static void add_sent(struct steps *steps, const struct sent *sent, float apart)
{
    uint32_t step = (uint32_t)fminf(apart, WD_SUNLIT_TURNS - 2);
    double on = (double)apart - step, here = 1 - on;
    steps->own[step] += here * here;
    steps->own[step + 1] += on * on;
    steps->next[step] += here * on;
    for (int k = 0; k < SENT; k++) {
        steps->sums[step][k] += here * (double)sent->of[k];
        steps->sums[step + 1][k] += on * (double)sent->of[k];
    }
}

static void solve(struct sent sent[WD_SUNLIT_TURNS], struct steps *steps)
{
    for (uint32_t i = 1; i < WD_SUNLIT_TURNS; i++) {
        double share = steps->next[i - 1] / steps->own[i - 1];
        steps->own[i] -= share * steps->next[i - 1];
        for (int k = 0; k < SENT; k++)
            steps->sums[i][k] -= share * steps->sums[i - 1][k];
    }
    for (uint32_t i = WD_SUNLIT_TURNS; i-- > 0;)
        for (int k = 0; k < SENT; k++) {
            double on = i + 1 < WD_SUNLIT_TURNS ? steps->next[i] * steps->sums[i + 1][k] : 0;
            steps->sums[i][k] = (steps->sums[i][k] - on) / steps->own[i];
            sent[i].of[k] = fmaxf((float)steps->sums[i][k], 0);
        }
}

/* What is sent from a ring of the sun to one of eyes, by the angle between both. */
static void sent_between(struct sent sent[WD_SUNLIT_TURNS], const struct fit *fit, uint32_t eye_ring, uint32_t sun_ring)
{
    struct steps steps = {0};
    uint32_t first = WD_SUN_RING_FIRST(sun_ring), end = first + WD_SUN_RING_COUNT(sun_ring);
    bool overhead = eye_ring + 1 == WD_EYE_RINGS || sun_ring + 1 == WD_SUN_RINGS;
    for (uint32_t eye = 0; eye < EYES; eye++)
        for (uint32_t way = first; way < end && fit->eyes[eye].ring == eye_ring; way++) {
            const struct sent over = over_cloud(&fit->sent[eye][way], fit->eyes[eye].toward, fit->suns[way]);
            for (uint32_t turn = 0; turn < (overhead ? WD_SUNLIT_TURNS : 1); turn++)
                add_sent(&steps, &over,
                         overhead ? (float)turn : steps_apart(&fit->eyes[eye], sun_ring, way));
        }
    solve(sent, &steps);
}

/* Where too little is seen to tell: 1. */
static float ratio(float of, float over, float seen)
{
    return over > 1e-4f * seen && over > 0 ? fminf(of / over, 8) : 1;
}

/* How many more of the leaves' places that eyes see are lit along some ways of the sun if nothing nearer than `clear_m` hides it. */
static float lit_past(const struct fit *fit, const struct wd_tree_points *points, const struct wd_tree_mesh *mesh,
                      float clear_m)
{
    struct wd_vec3 ways[WD_SUN_WAYS / NEAR_EACH];
    uint32_t *open = wd_alloc_array(points->count + 1, sizeof *open);
    double lit = 0, past = 0;
    for (uint32_t i = 0; i < WD_SUN_WAYS / NEAR_EACH; i++)
        ways[i] = wd_sun_way(NEAR_EACH * i);
    wd_tree_points_open(open, points, mesh, clear_m, ways, WD_SUN_WAYS / NEAR_EACH);
    for (size_t i = 0; i < points->count; i++) {
        if (!(points->points[i].kind & WD_POINT_LEAF))
            continue;
        float face[3];
        wd_unpack_normal(points->points[i].face, face);
        float seen = seen_by_eyes(fit, i, wd_v3_of(face));
        for (uint32_t k = 0; k < WD_SUN_WAYS / NEAR_EACH; k++) {
            float side = seen * fabsf(wd_v3_dot(wd_v3_of(face), ways[k]));
            lit += (double)(side * wd_sun_way_lit(points->lit[i], NEAR_EACH * k));
            past += (double)(side * wd_sun_way_lit(open[i], k));
        }
    }
    free(open);
    return lit > 0 ? (float)(past / lit - 1) : 0;
}

/* A power of the distance through two of them. */
static void fit_near(float near[2], const struct fit *fit, const struct wd_tree_points *points, const struct wd_tree_mesh *mesh)
{
    float less = fmaxf(lit_past(fit, points, mesh, 0.25f * WD_NEAR_SHADE_M), 1e-3f);
    near[0] = fmaxf(lit_past(fit, points, mesh, WD_NEAR_SHADE_M), 0);
    near[1] = near[0] > less ? fminf(fmaxf(0.5f * log2f(near[0] / less), 0.3f), 2) : 1;
}

/* Points of the surface, and with them all leaves. */
static void light(struct wd_tree_points *points, struct wd_tree_model *model, const struct fit *fit)
{
    size_t count = points->count;
    wd_leaves_open_add(points, model);
    wd_tree_points_light(points, &model->full);
    wd_leaves_open_set(model, points, count, fit->sky);
    points->count = count;
}

static void fill_place(float *to, const float *of)
{
    for (int side = 0; side < 2; side++) {
        to[2 * WD_SUNLIT_CARDS + side] = ratio(of[REFLECTED + side], of[CARD], of[SEEN]);
        to[2 * WD_SUNLIT_DEEP + side] = ratio(of[REFLECTED + side], of[DEEP], of[SEEN]);
    }
    to[2 * WD_SUNLIT_WOOD] = ratio(of[WOOD_LIT], of[WOOD_DEEP], of[SEEN]);
    to[2 * WD_SUNLIT_WOOD + 1] = ratio(of[WOOD], of[WOOD_LEFT], of[SEEN]);
    to[2 * WD_SUNLIT_LEAVES] = ratio(of[LIT], of[BY_DEPTH], of[SEEN]);
}

static void fill_table(struct wd_tree_model *model, const struct fit *fit)
{
    struct sent sent[WD_SUNLIT_TURNS];
    for (uint32_t sun = 0; sun < WD_SUN_RINGS; sun++)
        for (uint32_t eye = 0; eye < WD_EYE_RINGS; eye++) {
            sent_between(sent, fit, eye, sun);
            for (uint32_t turn = 0; turn < WD_SUNLIT_TURNS; turn++)
                fill_place(model->sunlit[wd_sunlit_place(eye, sun, turn)], sent[turn].of);
        }
}

/* Share of upper sides, of few that are as likely the one as the other. */
static float upper_share(float upper, float all, float seen)
{
    float few = 0.01f * seen;
    return (upper + 0.5f * few) / fmaxf(all + few, 1e-9f);
}

/* What is mirrored to eyes on a ring over what `wax` tells. */
static float mirrored_on(const float wax[2], const struct fit *fit, uint32_t ring)
{
    float mirrored = 0, told = 0, seen = 0;
    for (uint32_t eye = 0; eye < EYES; eye++)
        for (uint32_t way = 0; way < WD_SUN_WAYS && fit->eyes[eye].ring == ring; way++) {
            const float *sent = fit->sent[eye][way].of;
            float rise = wd_cloud_wax_rise(wd_v3_dot(fit->eyes[eye].toward, fit->suns[way]));
            told += WD_WAX * (wax[0] + wax[1] * rise) * (sent[REFLECTED] + sent[TRANSMITTED]);
            mirrored += sent[MIRRORED], seen += sent[SEEN];
        }
    return fminf(ratio(mirrored, told, seen), WD_UPPER_MIRRORS_MOST);
}

/* What is mirrored of an even sky to eyes on a ring, over what comes of it to the sides that they see. */
static float sky_mirrored_on(const struct fit *fit, uint32_t ring)
{
    float mirrored = 0, comes = fit->skylit[WD_SKYLIT_CLOUDS + ring].comes[0];
    for (uint32_t eye = 0; eye < EYES; eye++)
        for (uint32_t way = 0; way < WD_SUN_WAYS && fit->eyes[eye].ring == ring; way++)
            mirrored += fit->sky[way].brings * fit->sent[eye][way].of[MIRRORED];
    return fminf(ratio(mirrored, comes, fit->leaf_seen[ring]), WD_UPPER_SKY_WAX_MOST);
}

static void fill_upper(struct wd_tree_model *model, const struct fit *fit)
{
    for (uint32_t ring = 0; ring < WD_EYE_RINGS; ring++) {
        float of[WD_UPPER_SUNS][SENT] = {{0}}, upper = 0, seen = 0;
        for (uint32_t eye = 0; eye < EYES; eye++)
            for (uint32_t way = 0; way < WD_SUN_RING_FIRST(WD_UPPER_SUNS) && fit->eyes[eye].ring == ring; way++) {
                uint32_t sun = way < WD_SUN_RING_FIRST(1) ? 0 : way < WD_SUN_RING_FIRST(2) ? 1 : 2;
                for (int k = 0; k < SENT; k++)
                    of[sun][k] += fit->sent[eye][way].of[k];
            }
        for (uint32_t sun = 0; sun < WD_UPPER_SUNS; sun++) {
            const float *sent = of[sun];
            upper += sent[UPPER], seen += sent[SEEN];
            model->upper[ring][WD_UPPER_REFLECTS + sun] =
                upper_share(sent[UPPER_REFLECTED], sent[REFLECTED], sent[SEEN]);
            model->upper[ring][WD_UPPER_TRANSMITS + sun] =
                upper_share(sent[UPPER_TRANSMITTED], sent[TRANSMITTED], sent[SEEN]);
        }
        model->upper[ring][WD_UPPER_MIRRORS] = mirrored_on(model->cloud_wax, fit, ring);
        model->upper[ring][WD_UPPER_SKY_WAX] = sky_mirrored_on(fit, ring);
        model->upper[ring][WD_UPPER_OPEN] = fit->leaf_open[ring] / fmaxf(fit->leaf_seen[ring], 1e-9f);
        model->upper[ring][WD_UPPER_SEEN] = upper_share(upper, seen, seen);
        model->wood_seen[ring] = fit->crown_wood[ring] / fmaxf(fit->crown_seen[ring], 1e-9f);
        model->stem_seen[ring] = fit->stem[ring] / fmaxf(fit->crown_seen[ring] + fit->below_seen[ring], 1e-9f);
    }
}

void wd_tree_sunlit_fit(struct wd_tree_model *model)
{
    static const uint8_t any[4 * WD_LOOK_LAYERS] = {0};
    const struct wd_point_look look = {any, 1};
    struct wd_tree_points points;
    struct fit *fit = wd_alloc(sizeof *fit);
    struct wd_vec3 ways[EYES + LOW_WAYS];
    memset(fit, 0, sizeof *fit);
    place_eyes(fit->eyes);
    place_sky_ways(fit->sky);
    set_crown(fit, model);
    for (uint32_t i = 0; i < WD_SUN_WAYS; i++)
        fit->suns[i] = wd_sun_way(i);
    for (uint32_t i = 0; i < EYES; i++)
        ways[i] = fit->eyes[i].toward;
    for (uint32_t i = 0; i < LOW_WAYS; i++)
        ways[EYES + i] = fit->sky[WD_SUN_WAYS + i].toward;
    if (wd_tree_points_build(&points, &model->full, &look, POINTS)) {
        uint32_t *views = wd_alloc_array(points.count, sizeof *views);
        fit->views = views;
        light(&points, model, fit);
        wd_tree_points_open(views, &points, &model->full, 0, ways, EYES + LOW_WAYS);
        struct shown *shown = wd_alloc_array(points.count, sizeof *shown);
        for (size_t i = 0; i < points.count; i++)
            shown[i] = shown_at(fit, &points, i);
        fit_curve(fit, &points, shown);
        model->recollision = find_recollision(fit, &points, shown);
        model->flatness = find_flatness(&points);
        model->low_sky = find_low_sky(fit, &points, shown);
        fit_near(model->near_shade, fit, &points, &model->full);
        send(fit, &points, shown);
        free(shown);
        free(views);
    }
    memcpy(model->sun_curve, fit->curve, sizeof fit->curve);
    fit_wax(model->cloud_wax, fit);
    wd_tree_points_finish(&points);
    fill_table(model, fit);
    fill_upper(model, fit);
    for (uint32_t k = 0; k < WD_SKYLIT_PLACES * WD_SKYLIT_KINDS; k++) {
        uint32_t place = k / WD_SKYLIT_KINDS, kind = k % WD_SKYLIT_KINDS;
        const struct skylit *sum = &fit->skylit[place];
        model->skylit[place][kind] = ratio(sum->comes[kind], sum->told[kind], 0);
    }
    free(fit);
}
