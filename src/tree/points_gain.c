/* Gains: how large discs must be so that n of them show as much of a tree as the mesh does.
 *
 * Discs of area A/n each cover too much: leaves overlap in depth and lie at a slant, and a disc
 * wider than the branch it stands for covers what is beside it. Both gains of a count are found by
 * drawing the mesh and windows of discs from the same sides, with depth, until discs cover as many
 * pixels as the mesh and show as much wood between the leaves. */
#include <stdlib.h>

#include "base/dmath.h"
#include "base/memory.h"
#include "shared/hash.h"
#include "tree/shown.h"

enum { FIRST_ROUNDS = 4, ROUNDS = 2, MOST_VIEWS = 3, MOST_WINDOWS = 48 };
/* Discs much larger than their share of the surface would be a tree's only look. */
static const float LEAST_GAIN = 0.02f, MOST_GAIN = 4;

struct plan {
    const struct wd_disc_class *classes[2]; /* wood, leaves */
    struct wd_faces faces[2];
    struct wd_facet *facets[MOST_VIEWS][2]; /* [view][class] */
    int view_count;
    float scale;          /* pixels a metre */
    float nearer_m;       /* what nothing of the tree hides */
    struct wd_shown mesh; /* over all views */
};

/* So many discs, of whatever size, in all views. */
struct windows {
    struct wd_disc_window of[MOST_VIEWS][MOST_WINDOWS];
    uint32_t count;   /* a view */
    size_t wanted[2]; /* discs of a class in each */
};

/* --- windows ----------------------------------------------------------------------------- */

static size_t disc_count(const struct plan *plan, int class, size_t count)
{
    const struct wd_disc_class *discs = plan->classes[class];
    size_t wanted = (size_t)((float)count * discs->share + 0.5f);
    wanted = wanted > 0 ? wanted : 1;
    return discs->area_m2 > 0 ? wanted < discs->discs->count ? wanted : discs->discs->count : 0;
}

/* Few discs differ more from window to window: a fifth where there are sixteen. The mean over all
 * windows and views is known to 2 %. */
static uint32_t window_count(size_t count)
{
    return count < 32 ? MOST_WINDOWS : count < 100 ? 16 : count < 1000 ? 4 : 1;
}

/* They begin anywhere. */
static void windows_init(struct windows *windows, const struct plan *plan, size_t count)
{
    windows->count = window_count(count);
    for (int class = 0; class < 2; class++)
        windows->wanted[class] = disc_count(plan, class, count);
    for (int view = 0; view < plan->view_count; view++)
        for (uint32_t i = 0; i < windows->count; i++) {
            uint32_t first = wd_hash2(i * MOST_VIEWS + (uint32_t)view, (uint32_t)count);
            struct wd_facet_run runs[2] = {0};
            for (int class = 0; class < 2; class++) {
                size_t all = plan->classes[class]->discs->count;
                if (windows->wanted[class])
                    runs[class] = (struct wd_facet_run){plan->facets[view][class], all, first % all,
                                                        windows->wanted[class]};
            }
            wd_disc_window_init(&windows->of[view][i], runs, wd_disc_close((float)count),
                                plan->nearer_m);
        }
}

static void windows_finish(struct windows *windows, const struct plan *plan)
{
    for (int view = 0; view < plan->view_count; view++)
        for (uint32_t i = 0; i < windows->count; i++)
            wd_disc_window_finish(&windows->of[view][i]);
}

static struct wd_shown show_discs(const struct plan *plan, const struct windows *windows,
                                  const float gains[2])
{
    struct wd_shown sum = {0};
    float squared_m2[2] = {0};
    for (int class = 0; class < 2; class++)
        if (windows->wanted[class])
            squared_m2[class] = gains[class] * plan->classes[class]->area_m2 / (float)WD_PI /
                                (float)windows->wanted[class];
    for (int view = 0; view < plan->view_count; view++)
        for (uint32_t i = 0; i < windows->count; i++) {
            struct wd_shown shown = wd_shown_discs(&windows->of[view][i], squared_m2, plan->scale);
            wd_shown_add(&sum, &shown, 1.0 / windows->count);
        }
    return sum;
}

/* --- fitting ----------------------------------------------------------------------------- */

static float nearer(float gain, double wanted, double found, float power)
{
    float ratio = found > 0 ? wd_clampf((float)(wanted / found), 0.5f, 2) : 2;
    return wd_clampf(gain * wd_clampf(1 + power * (ratio - 1), 0.4f, 2.5f), LEAST_GAIN, MOST_GAIN);
}

/* Coverage grows with about the root of a gain. Without leaves wood has to cover all. */
static void fit(const struct plan *plan, const struct windows *windows, int rounds, float gains[2])
{
    bool leaves = plan->classes[1]->area_m2 > 0;
    for (int round = 0; round < rounds; round++) {
        struct wd_shown discs = show_discs(plan, windows, gains);
        gains[0] = nearer(gains[0], plan->mesh.wood, discs.wood, 1.2f);
        if (leaves)
            gains[1] = nearer(gains[1], plan->mesh.covered, discs.covered, 1.6f);
    }
}

/* Few discs hide less of the dark within. */
static float light_gain(const struct plan *plan, const struct windows *windows,
                        const float gains[2])
{
    struct wd_shown discs = show_discs(plan, windows, gains);
    double wanted = plan->mesh.openness * discs.covered, found = discs.openness * plan->mesh.covered;
    return found > 0 ? wd_clampf((float)(wanted / found), 0.5f, 2) : 1;
}

/* From many discs to few: what suits twice as many is where to begin. */
static void fit_side(const struct plan *plan, struct wd_disc_fit *fits, int side)
{
    float gains[2] = {1, 1};
    double leaves = plan->mesh.covered - plan->mesh.wood;
    struct windows *windows = wd_alloc(sizeof *windows);
    for (int k = WD_POINT_GAINS - 1; k >= 0; k--) {
        windows_init(windows, plan, (size_t)WD_POINT_LEAST << k);
        fit(plan, windows, k == WD_POINT_GAINS - 1 ? FIRST_ROUNDS : ROUNDS, gains);
        fits->wood.gains[side][k] = gains[0];
        fits->leaf.gains[side][k] = gains[1];
        fits->light.gains[side][k] = light_gain(plan, windows, gains);
        windows_finish(windows, plan);
    }
    fits->lower[side] = leaves > 0 ? (float)(plan->mesh.lower / leaves) : 0;
    free(windows);
}

static void look_from(struct plan *plan, const struct wd_tree_mesh *mesh, float elevation_deg,
                      int view_count)
{
    double elevation = (double)elevation_deg * WD_PI / 180;
    float level = (float)wd_dcos(elevation), up = (float)wd_dsin(elevation);
    plan->view_count = view_count;
    plan->mesh = (struct wd_shown){0};
    for (int i = 0; i < view_count; i++) {
        struct wd_silhouette frame;
        double turn = 0.4 + 2 * WD_PI * i / view_count;
        wd_silhouette_init(&frame, mesh,
                           WD_V3(level * (float)wd_dcos(turn), level * (float)wd_dsin(turn), up));
        struct wd_shown shown = wd_shown_mesh(&frame, mesh);
        wd_shown_add(&plan->mesh, &shown, 1);
        plan->scale = frame.scale;
        for (int class = 0; class < 2; class++)
            plan->facets[i][class] = wd_facets_of(&plan->faces[class], &frame);
    }
}

static void look_away(struct plan *plan)
{
    for (int i = 0; i < plan->view_count; i++)
        for (int class = 0; class < 2; class++)
            free(plan->facets[i][class]);
}

void wd_disc_fit(struct wd_disc_fit *fits, const struct wd_disc_class *wood,
                 const struct wd_disc_class *leaves, const struct wd_tree_mesh *mesh)
{
    static const float elevations_deg[WD_GAIN_SIDES] = {4, 45, 90};
    struct plan plan = {.classes = {wood, leaves},
                        .nearer_m = WD_DISC_NEARER * (mesh->max_m[0] - mesh->min_m[0])};
    for (int class = 0; class < 2; class++)
        wd_faces_init(&plan.faces[class], plan.classes[class]->discs);
    for (int side = 0; side < WD_GAIN_SIDES; side++) {
        look_from(&plan, mesh, elevations_deg[side], side < 2 ? MOST_VIEWS : 1);
        fit_side(&plan, fits, side);
        look_away(&plan);
    }
    for (int class = 0; class < 2; class++)
        wd_faces_finish(&plan.faces[class]);
}
