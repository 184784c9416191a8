/* Gains: how large discs must be so that n of them show as much of a tree as the mesh does.
 *
 * Discs of area A/n each cover too much: leaves overlap in depth and lie at a slant, and a disc
 * wider than the branch it stands for covers what is beside it. Both gains of a count are found by
 * drawing: the mesh and windows of discs from the same sides, with depth, until discs cover as many
 * pixels as the mesh and show as much wood between the leaves. */
#include <stdlib.h>
#include <string.h>

#include "base/dmath.h"
#include "base/memory.h"
#include "shared/hash.h"
#include "shared/sun_ways.h"
#include "tree/points.h"
#include "tree/silhouette.h"

enum { PIXELS = WD_SILHOUETTE * WD_SILHOUETTE, FIRST_ROUNDS = 4, ROUNDS = 2, MOST_VIEWS = 3 };
/* Discs much larger than their share of the surface would be a tree's only look. */
static const float LEAST_GAIN = 0.02f, MOST_GAIN = 4;

/* What a picture shows: pixels, those of them that are wood or the lower side of leaves, and the
 * sum of their openness to the sky. */
struct shown {
    double covered, wood, lower, openness;
};
enum { NOTHING, LEAF, LEAF_BELOW, WOOD };

/* A picture with depth. What it shows is counted while it is drawn: it is looked at some thousand
 * times, mostly with few discs in it. */
struct canvas {
    struct wd_silhouette frame;
    float *nearest; /* along frame.toward, where there is something */
    uint8_t *kind;
    uint8_t *openness;
    uint32_t counts[WOOD + 1], openness_sum;
};

/* A disc as a view sees it. */
struct facet {
    float at[2], toward, facing;
    uint8_t seen, openness; /* seen: 1 where nothing of the tree lies before it */
};

struct plan {
    const struct wd_disc_class *classes[2]; /* wood, leaves */
    struct canvas views[MOST_VIEWS];
    struct facet *facets[MOST_VIEWS][2]; /* [view][class]; a facet a disc */
    int view_count;
    float nearer_m;    /* what nothing of the tree hides */
    struct shown mesh; /* over all views */
};

static void clear(struct canvas *canvas)
{
    memset(canvas->kind, NOTHING, PIXELS);
    memset(canvas->openness, 0, PIXELS);
    memset(canvas->counts, 0, sizeof canvas->counts);
    canvas->openness_sum = 0;
}

static bool hidden(const struct canvas *canvas, int i, float toward)
{
    return canvas->kind[i] != NOTHING && toward <= canvas->nearest[i];
}

static void put(struct canvas *canvas, int i, float toward, uint8_t kind, uint8_t openness)
{
    canvas->counts[canvas->kind[i]]--; /* of nothing's count nothing is asked */
    canvas->counts[kind]++;
    canvas->openness_sum += openness - (uint32_t)canvas->openness[i];
    canvas->nearest[i] = toward;
    canvas->kind[i] = kind;
    canvas->openness[i] = openness;
}

static void add_shown(struct shown *shown, const struct canvas *canvas, double weight)
{
    const uint32_t *counts = canvas->counts;
    shown->covered += weight * (double)(counts[LEAF] + counts[LEAF_BELOW] + counts[WOOD]);
    shown->wood += weight * (double)counts[WOOD];
    shown->lower += weight * (double)counts[LEAF_BELOW];
    shown->openness += weight * (double)canvas->openness_sum;
}

/* --- the mesh ---------------------------------------------------------------------------- */

struct corner {
    float at[2], toward, uv[2];
    uint32_t openness;
};

static float across(const struct corner *a, const struct corner *b, float x, float y)
{
    return (b->at[0] - a->at[0]) * (y - a->at[1]) - (b->at[1] - a->at[1]) * (x - a->at[0]);
}

static float least(float a, float b, float c)
{
    return fminf(a, fminf(b, c));
}

static float most(float a, float b, float c)
{
    return fmaxf(a, fmaxf(b, c));
}

/* Which side of a leaf is seen: as shaders/lib/look.glsl has it, in a picture that is mirrored. */
static uint8_t side_of(const struct corner *a, const struct corner *b, const struct corner *c,
                       float area)
{
    float turn = (b->uv[0] - a->uv[0]) * (c->uv[1] - a->uv[1]) -
                 (b->uv[1] - a->uv[1]) * (c->uv[0] - a->uv[0]);
    return turn * area < 0 ? LEAF : LEAF_BELOW;
}

static void draw_triangle(struct canvas *canvas, const struct corner *a, const struct corner *b,
                          const struct corner *c, bool wood)
{
    float area = across(a, b, c->at[0], c->at[1]);
    uint8_t kind = wood ? WOOD : side_of(a, b, c, area);
    uint8_t openness = (uint8_t)((a->openness + b->openness + c->openness) / 3);
    int x0 = wd_silhouette_pixel(least(a->at[0], b->at[0], c->at[0]));
    int x1 = wd_silhouette_pixel(most(a->at[0], b->at[0], c->at[0]));
    int y0 = wd_silhouette_pixel(least(a->at[1], b->at[1], c->at[1]));
    int y1 = wd_silhouette_pixel(most(a->at[1], b->at[1], c->at[1]));
    if (x0 >= x1 || y0 >= y1 || !(fabsf(area) > 1e-9f))
        return;
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) {
            float px = (float)x + 0.5f, py = (float)y + 0.5f;
            float of_c = across(a, b, px, py) / area, of_a = across(b, c, px, py) / area;
            float of_b = 1 - of_a - of_c;
            float toward = of_a * a->toward + of_b * b->toward + of_c * c->toward;
            int i = y * WD_SILHOUETTE + x;
            if (of_a < 0 || of_b < 0 || of_c < 0 || hidden(canvas, i, toward))
                continue;
            put(canvas, i, toward, kind, openness);
        }
}

static struct corner corner_of(const struct canvas *canvas, const float p[3])
{
    struct corner corner;
    wd_silhouette_project(&canvas->frame, p, corner.at);
    corner.toward = wd_v3_dot(WD_V3(p[0], p[1], p[2]), canvas->frame.toward);
    return corner;
}

static void draw_mesh(struct canvas *canvas, const struct wd_tree_mesh *mesh)
{
    struct corner *corners = wd_alloc_array((size_t)mesh->vertex_count + 1, sizeof *corners);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        corners[i] = corner_of(canvas, mesh->vertices[i].position_m);
        corners[i].openness = mesh->vertices[i].tint >> 24;
        wd_unpack_uv(mesh->vertices[i].uv, corners[i].uv);
    }
    for (uint32_t i = 0; i + 2 < mesh->index_count; i += 3)
        draw_triangle(canvas, &corners[mesh->indices[i]], &corners[mesh->indices[i + 1]],
                      &corners[mesh->indices[i + 2]], i < mesh->wood_index_count);
    free(corners);
}

/* --- discs ------------------------------------------------------------------------------- */

/* Drawn as the squares of equal area that shaders/lib/splat_draw.glsl draws. */
static void draw_disc(struct canvas *canvas, const struct facet *facet, float toward, float radius,
                      uint8_t kind)
{
    float half = radius * 0.886227f;
    int x0 = wd_silhouette_pixel(facet->at[0] - half);
    int x1 = wd_silhouette_pixel(facet->at[0] + half);
    int y0 = wd_silhouette_pixel(facet->at[1] - half);
    int y1 = wd_silhouette_pixel(facet->at[1] + half);
    for (int y = y0; y < y1; y++)
        for (int i = y * WD_SILHOUETTE + x0; i < y * WD_SILHOUETTE + x1; i++)
            if (!hidden(canvas, i, toward))
                put(canvas, i, toward, kind, facet->openness);
}

/* Over the mean of faces of every direction, for leaves. */
static float facing_of(const struct wd_tree_point *point, struct wd_vec3 toward)
{
    float n[3];
    wd_unpack_normal(point->face, n);
    float cosine = wd_v3_dot(WD_V3(n[0], n[1], n[2]), toward);
    return point->kind & WD_POINT_ONE_SIDED ? fmaxf(cosine, 0) : 2 * fabsf(cosine);
}

static struct facet *facets_of(const struct canvas *canvas, const struct wd_tree_points *discs)
{
    struct facet *facets = wd_alloc_array(discs->count + 1, sizeof *facets);
    uint32_t eye = wd_sun_mix(canvas->frame.toward);
    for (size_t i = 0; i < discs->count; i++) {
        const struct wd_tree_point *point = &discs->points[i];
        struct corner middle = corner_of(canvas, point->position_m);
        uint32_t way = wd_sun_way_by_lot(eye, wd_hash2((uint32_t)i, 0x1e5));
        facets[i] = (struct facet){{middle.at[0], middle.at[1]}, middle.toward,
                                   facing_of(point, canvas->frame.toward),
                                   discs->lit[i] >> way & 1, (uint8_t)(point->albedo >> 24)};
    }
    return facets;
}

static size_t disc_count(const struct plan *plan, int class, size_t count)
{
    const struct wd_disc_class *discs = plan->classes[class];
    size_t wanted = (size_t)((float)count * discs->share + 0.5f);
    wanted = wanted > 0 ? wanted : 1;
    return discs->area_m2 > 0 ? wanted < discs->discs->count ? wanted : discs->discs->count : 0;
}

/* A window of one class that begins anywhere. */
static void draw_window(struct plan *plan, int view, int class, size_t count, float gain,
                        uint32_t window)
{
    struct canvas *canvas = &plan->views[view];
    const size_t all = plan->classes[class]->discs->count;
    size_t wanted = disc_count(plan, class, count);
    if (!wanted)
        return;
    float squared = gain * plan->classes[class]->area_m2 / (float)WD_PI / (float)wanted;
    size_t at = wd_hash2(window, (uint32_t)count) % all;
    float close = wd_disc_close((float)count), nearer_m = (1 - close) * plan->nearer_m;
    for (size_t i = 0; i < wanted; i++, at = at + 1 < all ? at + 1 : 0) {
        const struct facet *facet = &plan->facets[view][class][at];
        float seen = facet->seen, facing = facet->facing * wd_disc_open(seen, close);
        draw_disc(canvas, facet, facet->toward + seen * nearer_m,
                  sqrtf(squared * facing) * canvas->frame.scale, class == 0 ? WOOD : LEAF);
    }
}

/* Few discs differ more from window to window: a fifth where there are sixteen. The mean over all
 * windows and views is known to 2 %. */
static uint32_t window_count(size_t count)
{
    return count < 32 ? 48 : count < 100 ? 16 : count < 1000 ? 4 : 1;
}

static struct shown show_discs(struct plan *plan, size_t count, const float gains[2])
{
    struct shown shown = {0};
    uint32_t windows = window_count(count);
    for (int view = 0; view < plan->view_count; view++)
        for (uint32_t i = 0; i < windows; i++) {
            clear(&plan->views[view]);
            for (int class = 0; class < 2; class++)
                draw_window(plan, view, class, count, gains[class],
                            i * MOST_VIEWS + (uint32_t)view);
            add_shown(&shown, &plan->views[view], 1.0 / windows);
        }
    return shown;
}

/* --- fitting ----------------------------------------------------------------------------- */

static float nearer(float gain, double wanted, double found, float power)
{
    float ratio = found > 0 ? wd_clampf((float)(wanted / found), 0.5f, 2) : 2;
    return wd_clampf(gain * wd_clampf(1 + power * (ratio - 1), 0.4f, 2.5f), LEAST_GAIN, MOST_GAIN);
}

/* Coverage grows with about the root of a gain. Without leaves wood has to cover all. */
static void fit(struct plan *plan, size_t count, int rounds, float gains[2])
{
    bool leaves = plan->classes[1]->area_m2 > 0;
    for (int round = 0; round < rounds; round++) {
        struct shown discs = show_discs(plan, count, gains);
        gains[0] = nearer(gains[0], plan->mesh.wood, discs.wood, 1.2f);
        if (leaves)
            gains[1] = nearer(gains[1], plan->mesh.covered, discs.covered, 1.6f);
    }
}

/* Few discs hide less of the dark within. */
static float light_gain(struct plan *plan, size_t count, const float gains[2])
{
    struct shown discs = show_discs(plan, count, gains);
    double wanted = plan->mesh.openness * discs.covered, found = discs.openness * plan->mesh.covered;
    return found > 0 ? wd_clampf((float)(wanted / found), 0.5f, 2) : 1;
}

/* From many discs to few: what suits twice as many is where to begin. */
static void fit_side(struct plan *plan, struct wd_disc_fit *fits, int side)
{
    float gains[2] = {1, 1};
    double leaves = plan->mesh.covered - plan->mesh.wood;
    for (int k = WD_POINT_GAINS - 1; k >= 0; k--) {
        size_t count = (size_t)WD_POINT_LEAST << k;
        fit(plan, count, k == WD_POINT_GAINS - 1 ? FIRST_ROUNDS : ROUNDS, gains);
        fits->wood.gains[side][k] = gains[0];
        fits->leaf.gains[side][k] = gains[1];
        fits->light.gains[side][k] = light_gain(plan, count, gains);
    }
    fits->lower[side] = leaves > 0 ? (float)(plan->mesh.lower / leaves) : 0;
}

static void plan_init(struct plan *plan, const struct wd_tree_mesh *mesh, float elevation_deg,
                      int view_count)
{
    double elevation = (double)elevation_deg * WD_PI / 180;
    float level = (float)wd_dcos(elevation), up = (float)wd_dsin(elevation);
    plan->view_count = view_count;
    plan->mesh = (struct shown){0};
    for (int i = 0; i < view_count; i++) {
        struct canvas *canvas = &plan->views[i];
        double turn = 0.4 + 2 * WD_PI * i / view_count;
        wd_silhouette_init(&canvas->frame, mesh,
                           WD_V3(level * (float)wd_dcos(turn), level * (float)wd_dsin(turn), up));
        canvas->nearest = wd_alloc_array(PIXELS, sizeof *canvas->nearest);
        canvas->kind = wd_alloc(PIXELS);
        canvas->openness = wd_alloc(PIXELS);
        clear(canvas);
        draw_mesh(canvas, mesh);
        add_shown(&plan->mesh, canvas, 1);
        for (int class = 0; class < 2; class++)
            plan->facets[i][class] = facets_of(canvas, plan->classes[class]->discs);
    }
}

static void plan_finish(struct plan *plan)
{
    for (int i = 0; i < plan->view_count; i++) {
        free(plan->views[i].nearest);
        free(plan->views[i].kind);
        free(plan->views[i].openness);
        free(plan->facets[i][0]);
        free(plan->facets[i][1]);
    }
}

void wd_disc_fit(struct wd_disc_fit *fits, const struct wd_disc_class *wood,
                 const struct wd_disc_class *leaves, const struct wd_tree_mesh *mesh)
{
    static const float elevations_deg[WD_GAIN_SIDES] = {4, 45, 90};
    struct plan plan = {.classes = {wood, leaves},
                        .nearer_m = WD_DISC_NEARER * (mesh->max_m[0] - mesh->min_m[0])};
    for (int side = 0; side < WD_GAIN_SIDES; side++) {
        plan_init(&plan, mesh, elevations_deg[side], side < 2 ? MOST_VIEWS : 1);
        fit_side(&plan, fits, side);
        plan_finish(&plan);
    }
}
