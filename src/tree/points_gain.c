/* Gains: how large discs must be so that n of them show as much of a tree as the mesh does.
 *
 * Discs of area A/n each cover too much: leaves overlap in depth and lie at a slant, and a disc
 * wider than the branch it stands for covers what is beside it. Both gains of a count are found by
 * drawing the mesh and windows of discs from the same sides, with depth, until discs cover as many
 * pixels as the mesh and show as much wood between the leaves. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/color.h"
#include "base/dmath.h"
#include "base/memory.h"
#include "shared/hash.h"
#include "tree/shown.h"

enum { FIRST_ROUNDS = 5, ROUNDS = 2, MOST_VIEWS = 6, MOST_WINDOWS = 48 };
/* Of 256 discs, about as many as the smallest trees have whose thick wood is there as triangles, and of 2,048, where
 * all of it is. */
enum { AT_THIN = 5, AT_TRIANGLES = 8, AT_BARK = 6 /* of 512: trees of 32 to 64 pixels */ };
/* Discs much larger than their share of the surface would be a tree's only look. */
static const float LEAST_GAIN = 0.02f, MOST_GAIN = 4;

struct plan {
    const struct wd_disc_class *classes[3]; /* wood, leaves, thin wood */
    struct wd_faces faces[3];
    struct wd_facet *facets[MOST_VIEWS][3]; /* [view][class] */
    float thin_share;                       /* of the wood that is seen */
    int view_count;
    const struct wd_tree_mesh *bark;         /* whose wood are the triangles */
    struct wd_silhouette barks[MOST_VIEWS];  /* as each view sees them */
    float scale;          /* pixels a metre */
    float nearer_m;       /* what nothing of the tree hides */
    struct wd_shown meshes[MOST_VIEWS];
};

/* So many discs, of whatever size, in all views or every other one. */
struct windows {
    struct wd_disc_window of[MOST_VIEWS][MOST_WINDOWS];
    int first_view, step;
    struct wd_shown mesh; /* over these views */
    uint32_t count;       /* a view */
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
    return count < 32 ? MOST_WINDOWS : count < 100 ? 16 : count < 1000 ? 6 : count < 5000 ? 2 : 1;
}

/* They begin anywhere. Counts look from other views by turns. */
static void windows_init(struct windows *windows, const struct plan *plan, int k)
{
    size_t count = (size_t)WD_POINT_LEAST << k;
    windows->step = plan->view_count > 1 ? 2 : 1;
    windows->first_view = k % windows->step;
    windows->mesh = (struct wd_shown){0};
    windows->count = window_count(count);
    for (int class = 0; class < 2; class++)
        windows->wanted[class] = disc_count(plan, class, count);
    for (int view = windows->first_view; view < plan->view_count; view += windows->step) {
        wd_shown_add(&windows->mesh, &plan->meshes[view], 1);
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
}

static void windows_finish(struct windows *windows, const struct plan *plan)
{
    for (int view = windows->first_view; view < plan->view_count; view += windows->step)
        for (uint32_t i = 0; i < windows->count; i++)
            wd_disc_window_finish(&windows->of[view][i]);
}

static struct wd_shown show_discs(const struct plan *plan, const struct windows *windows,
                                  const float gains[2], const struct wd_silhouette *before)
{
    struct wd_shown sum = {0};
    float squared_m2[2] = {0};
    for (int class = 0; class < 2; class++)
        if (windows->wanted[class])
            squared_m2[class] = gains[class] * plan->classes[class]->area_m2 / (float)WD_PI /
                                (float)windows->wanted[class];
    for (int view = windows->first_view; view < plan->view_count; view += windows->step)
        for (uint32_t i = 0; i < windows->count; i++) {
            struct wd_shown shown = wd_shown_discs(&windows->of[view][i], squared_m2, plan->scale,
                                                   before ? &before[view] : NULL);
            wd_shown_add(&sum, &shown, 1.0 / windows->count);
        }
    return sum;
}

/* --- fitting ----------------------------------------------------------------------------- */

/* How what is shown grows with a gain: to which power. */
struct growth {
    float power[2];
    float gains[2], shown[2]; /* of the round before; 0: none */
};

static float nearer(struct growth *growth, int class, float gain, double wanted, double found)
{
    float shown = (float)found, before = growth->shown[class], was = growth->gains[class];
    if (before > 0 && shown > 0 && fabsf(gain / was - 1) > 0.02f) {
        double power = wd_dlog((double)(shown / before)) / wd_dlog((double)(gain / was));
        growth->power[class] = wd_clampf((float)power, 0.25f, 1);
    }
    growth->shown[class] = shown;
    growth->gains[class] = gain;
    float ratio = found > 0 ? wd_clampf((float)(wanted / found), 0.5f, 2) : 2;
    float factor = wd_clampf(1 + (ratio - 1) / growth->power[class], 0.4f, 2.5f);
    return wd_clampf(gain * factor, LEAST_GAIN, MOST_GAIN);
}

/* Without leaves wood has to cover all. */
static void fit(const struct plan *plan, const struct windows *windows, int rounds,
                struct growth *growth, float gains[2])
{
    bool leaves = plan->classes[1]->area_m2 > 0;
    growth->shown[0] = growth->shown[1] = 0;
    for (int round = 0; round < rounds; round++) {
        struct wd_shown discs = show_discs(plan, windows, gains, NULL);
        gains[0] = nearer(growth, 0, gains[0], windows->mesh.wood, discs.wood);
        if (leaves)
            gains[1] = nearer(growth, 1, gains[1], windows->mesh.covered, discs.covered);
    }
}

static float openness_gain(double wanted, double found)
{
    return wanted > 0 && found > 0 ? wd_clampf((float)(wanted / found), 0.5f, 2) : 1;
}

/* Few discs hide less of the dark within, and show more of the wood that lies out of it. Of wood, and of all. */
static void light_gains(float light[2], const struct plan *plan, const struct windows *windows,
                        const float gains[2])
{
    const struct wd_shown discs = show_discs(plan, windows, gains, NULL), *mesh = &windows->mesh;
    const double of_mesh[2] = {mesh->openness[0], mesh->openness[0] + mesh->openness[1]};
    const double of_discs[2] = {discs.openness[0], discs.openness[0] + discs.openness[1]};
    light[0] = openness_gain(of_mesh[0] * discs.wood, of_discs[0] * mesh->wood);
    light[1] = openness_gain(of_mesh[1] * discs.covered, of_discs[1] * mesh->covered);
}

static double bark_px(const struct plan *plan, int first, int step)
{
    double bark = 0;
    for (int view = first; view < plan->view_count; view += step)
        bark += (double)wd_silhouette_count(&plan->barks[view]);
    return bark;
}

/* Triangles of bark do not stick out as discs do: factor on the gain of the discs of a class with which these and the
 * triangles alone cover what the mesh does. */
static float past_bark(const struct plan *plan, const float gains[2], int class, int k)
{
    float only[2] = {0};
    struct growth growth = {.power = {0.8f, 0.6f}};
    struct windows *windows = wd_alloc(sizeof *windows);
    struct plan bare = *plan;
    struct wd_disc_class none = {plan->classes[1 - class]->discs, 0, plan->classes[1 - class]->share};
    bare.classes[1 - class] = &none;
    only[class] = gains[class];
    windows_init(windows, &bare, k);
    double bark = bark_px(plan, windows->first_view, windows->step);
    for (int round = 0; round < FIRST_ROUNDS && gains[class] > 0; round++) {
        struct wd_shown discs = show_discs(&bare, windows, only, plan->barks);
        only[class] = nearer(&growth, class, only[class], windows->mesh.covered, discs.covered + bark);
    }
    windows_finish(windows, &bare);
    free(windows);
    return only[class] / gains[class];
}

/* Reduced trees leave out branches and have fewer twigs, which leaves hide where there are any. Nothing where triangles show
 * all that there is, where the search has no end. */
static float bare_thin(const struct plan *plan, const float gains[2])
{
    static const float SURELY = 0.04f; /* of what is seen */
    struct plan thin = *plan;
    double all = 0;
    thin.classes[0] = plan->classes[2];
    for (int view = 0; view < plan->view_count; view++) {
        thin.facets[view][0] = plan->facets[view][2];
        all += plan->meshes[view].covered;
    }
    float left = all > 0 ? (float)(1 - bark_px(plan, 0, 1) / all) : 0;
    return wd_clampf(past_bark(&thin, gains, 0, WD_POINT_GAINS - 1), 0, 1) * wd_clampf(left / SURELY, 0, 1);
}

/* Thin wood lies among leaves, whose discs hide more of it than of all wood: factor on the gain with which its discs
 * show their share. */
static float thin_gain(const struct plan *plan, const float gains[2])
{
    float thin[2] = {gains[0] * plan->thin_share, gains[1]}, first = thin[0];
    struct growth growth = {.power = {0.8f, 0.4f}};
    struct windows *windows = wd_alloc(sizeof *windows);
    struct plan among = *plan;
    among.classes[0] = plan->classes[2];
    for (int view = 0; view < plan->view_count; view++)
        among.facets[view][0] = plan->facets[view][2];
    windows_init(windows, &among, AT_THIN);
    for (int round = 0; round < FIRST_ROUNDS && first > 0; round++) {
        struct wd_shown discs = show_discs(&among, windows, thin, NULL);
        thin[0] = nearer(&growth, 0, thin[0], plan->thin_share * windows->mesh.wood, discs.wood);
    }
    windows_finish(windows, &among);
    free(windows);
    return first > 0 ? wd_clampf(thin[0] / first, 0.5f, 2.5f) : 1;
}

/* Facets whose openness stands for the green albedo of their points. */
static struct wd_facet *facets_of_bark(const struct wd_facet *facets, const struct wd_tree_points *discs, double *sum)
{
    struct wd_facet *bark = wd_alloc_array(discs->count + 1, sizeof *bark);
    memcpy(bark, facets, discs->count * sizeof *bark);
    const float *linear = wd_srgb_table();
    *sum = 0;
    for (size_t i = 0; i < discs->count; i++) {
        bark[i].openness = wd_unorm_encode(linear[(uint8_t)(discs->points[i].albedo >> 8)]);
        *sum += bark[i].openness;
    }
    return bark;
}

/* Leaves hide discs on twigs among them more than those on a bare stem, whose bark may be another. The mesh shows what
 * all discs have in the mean, for they are kept by how much of them is seen: factor on their albedo. */
static float bark_gain(const struct plan *plan, const float gains[2])
{
    const struct wd_tree_points *discs = plan->classes[0]->discs;
    double sum = 0;
    struct plan of_bark = *plan;
    if (!(plan->classes[0]->area_m2 > 0) || discs->count == 0)
        return 1;
    for (int view = 0; view < plan->view_count; view++)
        of_bark.facets[view][0] = facets_of_bark(plan->facets[view][0], discs, &sum);
    struct windows *windows = wd_alloc(sizeof *windows);
    windows_init(windows, &of_bark, AT_BARK);
    const struct wd_shown shown = show_discs(&of_bark, windows, gains, NULL);
    windows_finish(windows, &of_bark);
    free(windows);
    for (int view = 0; view < plan->view_count; view++)
        free(of_bark.facets[view][0]);
    double mean = sum / (double)discs->count;
    return shown.openness[0] > 0 ? wd_clampf((float)(mean * shown.wood / shown.openness[0]), 0.7f, 1.3f) : 1;
}

/* Windows leave chance in each count's gains, which change little from one to the next but where discs
 * cease to be larger and nearer than their share (wd_disc_close). */
static void smooth(float gains[WD_POINT_GAINS])
{
    float before = gains[0];
    for (int k = 1; k < WD_POINT_GAINS - 1; k++) {
        float here = gains[k];
        bool even = wd_disc_close((float)(WD_POINT_LEAST << (k - 1))) ==
                    wd_disc_close((float)(WD_POINT_LEAST << (k + 1)));
        if (even)
            gains[k] = 0.25f * (before + 2 * here + gains[k + 1]);
        before = here;
    }
}

/* From many discs to few: what suits twice as many is where to begin. */
static void fit_side(const struct plan *plan, struct wd_disc_fit *fits, int side)
{
    float gains[2] = {1, 1}, light[2];
    struct growth growth = {.power = {0.8f, 0.4f}};
    struct wd_shown mesh = {0};
    for (int view = 0; view < plan->view_count; view++)
        wd_shown_add(&mesh, &plan->meshes[view], 1);
    double leaves = mesh.covered - mesh.wood;
    struct windows *windows = wd_alloc(sizeof *windows);
    for (int k = WD_POINT_GAINS - 1; k >= 0; k--) {
        windows_init(windows, plan, k);
        fit(plan, windows, k == WD_POINT_GAINS - 1 ? FIRST_ROUNDS : ROUNDS, &growth, gains);
        fits->wood.gains[side][k] = gains[0];
        fits->leaf.gains[side][k] = gains[1];
        light_gains(light, plan, windows, gains);
        fits->wood_light.gains[side][k] = light[0];
        fits->light.gains[side][k] = light[1];
        if (k == AT_THIN)
            fits->thin[side] = thin_gain(plan, gains);
        if (k == AT_BARK && side < 2)
            fits->bark[side] = bark_gain(plan, gains);
        if (k == WD_POINT_GAINS - 1 && side < 2)
            fits->bare_thin[side] = leaves > 0 ? 0 : bare_thin(plan, gains);
        if (k == AT_TRIANGLES)
            fits->past_bark[side] = leaves > 0 ? past_bark(plan, gains, 1, AT_TRIANGLES) : 1;
        windows_finish(windows, plan);
    }
    smooth(fits->wood.gains[side]);
    smooth(fits->leaf.gains[side]);
    fits->lower[side] = leaves > 0 ? (float)(mesh.lower / leaves) : 0;
    free(windows);
}

static void look_from(struct plan *plan, const struct wd_tree_mesh *mesh, float elevation_deg,
                      int view_count)
{
    double elevation = (double)elevation_deg * WD_PI / 180;
    float level = (float)wd_dcos(elevation), up = (float)wd_dsin(elevation);
    plan->view_count = view_count;
    for (int i = 0; i < view_count; i++) {
        struct wd_silhouette frame;
        double turn = 0.4 + 2 * WD_PI * i / view_count;
        wd_silhouette_init(&frame, mesh,
                           WD_V3(level * (float)wd_dcos(turn), level * (float)wd_dsin(turn), up));
        plan->meshes[i] = wd_shown_mesh(&frame, mesh);
        plan->scale = frame.scale;
        wd_silhouette_cover(&frame, 1, plan->bark, 0, plan->bark->wood_index_count);
        plan->barks[i] = frame;
        for (int class = 0; class < 3; class++)
            plan->facets[i][class] = wd_facets_of(&plan->faces[class], &frame);
    }
}

static void look_away(struct plan *plan)
{
    for (int i = 0; i < plan->view_count; i++)
        for (int class = 0; class < 3; class++)
            free(plan->facets[i][class]);
}

void wd_disc_fit(struct wd_disc_fit *fits, const struct wd_disc_class *wood,
                 const struct wd_disc_class *leaves, const struct wd_disc_class *thin, float thin_share,
                 const struct wd_tree_mesh *mesh, const struct wd_tree_mesh *bark)
{
    static const float elevations_deg[WD_GAIN_SIDES] = {4, 45, 90};
    struct plan plan = {.classes = {wood, leaves, thin},
                        .thin_share = thin_share,
                        .bark = bark,
                        .nearer_m = WD_DISC_NEARER * (mesh->max_m[0] - mesh->min_m[0])};
    for (int class = 0; class < 3; class++)
        wd_faces_init(&plan.faces[class], plan.classes[class]->discs);
    for (int side = 0; side < WD_GAIN_SIDES; side++) {
        look_from(&plan, mesh, elevations_deg[side], side < 2 ? MOST_VIEWS : 1);
        fit_side(&plan, fits, side);
        look_away(&plan);
    }
    for (int class = 0; class < 3; class++)
        wd_faces_finish(&plan.faces[class]);
}
