#include "tree/form.h"

/* A dead tree's crown is what its stubs reach in the mean; whole limbs, a few of which are left, reach as far as its
 * envelope, which is so many times as wide. */
static const float LIVING_CROWN = 2.4f;

/* Clear stem of a seedling in a forest, over that of a grown tree. */
static const float YOUNG_CLEAR = 0.12f;

/* Of the envelope. */
static float crown_m(const struct wd_species *species, double dbh_cm)
{
    return (species->form == WD_FORM_SNAG ? LIVING_CROWN : 1) * (float)wd_species_crown_m(species, dbh_cm);
}

/* Crowns that no neighbour has touched: cones of conifers, eggs of broadleaves, and domes of old ones in the open. */
static void shape_crown(struct wd_tree_form *form)
{
    static const float cone[4] = {1, 0.8f, 0.45f, 0.03f}, egg[4] = {0.8f, 1, 0.66f, 0.06f};
    static const float dome[4] = {0.9f, 1, 0.86f, 0.2f}, broad[4] = {0.95f, 1, 0.92f, 0.4f};
    const float *young = form->species->form == WD_FORM_CONIFER ? cone : egg;
    for (int i = 0; i < 4; i++) {
        float own = form->species->crown_shape[i];
        float grown = wd_mixf(own, wd_maxf(own, dome[i]), form->free);
        grown = wd_mixf(grown, wd_maxf(grown, broad[i]), form->dissolved);
        form->crown_shape[i] = wd_mixf(grown, young[i], form->youth);
    }
}

/* Share of its clear stem that a free broadleaf lacks. */
static const float FREE_LOWER = 0.3f;

/* From this apical dominance on, beeches', a free tree keeps its leader. */
static const float LEADS = 0.42f;

/* Of the height, below the heavy limbs of a free one; the ends of these hang lower. */
static float bole_m(const struct wd_tree_form *form)
{
    return form->height_m * wd_mixf(0.13f, 0.22f, wd_hash_unit(wd_hash2(form->key, 0xb01e)));
}

struct wd_tree_form wd_tree_form_of(const struct wd_species *species,
                                    const struct wd_grow_params *params)
{
    float height = params->height_m, open = params->openness;
    double dbh_cm = 100 * (double)params->dbh_m;
    struct wd_random random = wd_random_of(params->seed, 0x7ee5);
    float crown = crown_m(species, dbh_cm);
    crown *= (float)wd_species_open_crown(species, (double)open);
    float youth = params->clip ? 0 : wd_species_youth(species, (double)height);
    if (youth > 0)
        crown = (float)wd_species_young_crown_m(species, (double)height, (double)open, (double)crown);
    crown *= wd_random_range(&random, 0.92f, 1.08f);
    float free = params->clip ? 0 : (1 - youth) * (float)wd_species_free(species, (double)open);
    float typical_crown = crown_m(species, wd_species_dbh_cm(species, (double)species->typical_height_m));
    float grown = wd_minf(height / species->typical_height_m, 1); /* in the open: clear later */
    float shaded = species->crown_base_forest * wd_mixf(1, YOUNG_CLEAR, youth);
    float clear = wd_mixf(shaded, grown * species->crown_base_open, open);
    clear *= 1 - FREE_LOWER * free;
    float length = height * (1 - clear) /
                   (species->typical_height_m * (1 - species->crown_base_forest));
    struct wd_tree_form form = {
        .species = species,
        .key = wd_hash2(params->seed, 0x600d),
        .height_m = height,
        .scale = height / species->typical_height_m,
        .youth = youth,
        .leader = wd_mixf(species->apical_dominance, 1, youth),
        .openness = open,
        .free = free,
        .detail = params->detail,
        .dbh_m = params->dbh_m,
        .crown_base_m = height * clear * wd_random_range(&random, 0.94f, 1.04f),
        .crown_radius_m = 0.5f * crown,
        .spread = 0.5f * (crown / typical_crown + length),
        .lobe_m = wd_clampf(0.3f * crown, 0.5f, 3.0f),
    };
    form.dissolved = wd_smoothf(0.3f, 0.9f, free) * wd_clampf((LEADS - species->apical_dominance) / 0.08f, 0, 1);
    form.bole_m = wd_mixf(form.crown_base_m, wd_maxf(form.crown_base_m, bole_m(&form)), form.dissolved);
    shape_crown(&form);
    return form;
}

void wd_tree_form_clip(struct wd_tree_form *form, const struct wd_clip_grid *clip)
{
    float reach = 0;
    for (int axis = 0; axis < 2; axis++)
        reach = wd_max3f(reach, -clip->min_m[axis], clip->max_m[axis]);
    form->clip = clip;
    form->crown_radius_m = reach;
    form->crown_base_m = form->bole_m = wd_maxf(clip->min_m[2], 0.05f * form->height_m);
}

bool wd_tree_is_cut(const struct wd_tree_form *form, struct wd_vec3 p)
{
    return form->clip && p.z > form->clip->min_m[2] && !wd_clip_inside(form->clip, p);
}

#define FOREST_FOOT 0.6f

/* The four given radii joined by straight lines for a conifer; for a broadleaf their squares are,
 * which rounds the top like a dome. In a forest neighbours shade the crown's foot, which tapers. */
static float profile(const struct wd_tree_form *form, float t)
{
    float place = wd_clampf(t, 0, 1) * 3;
    int i = place >= 2 ? 2 : (int)place;
    float a = form->crown_shape[i], b = form->crown_shape[i + 1], f = place - (float)i;
    if (i == 0)
        a *= wd_mixf(FOREST_FOOT, 1, wd_maxf(form->openness, form->youth));
    if (form->species->form == WD_FORM_CONIFER)
        return wd_mixf(a, b, f);
    return sqrtf(wd_mixf(a * a, b * b, f));
}

static float crown_share(const struct wd_tree_form *form, float z)
{
    return (z - form->crown_base_m) / (form->height_m - form->crown_base_m);
}

float wd_tree_envelope_m(const struct wd_tree_form *form, struct wd_vec3 p)
{
    float t = crown_share(form, p.z);
    if (t < 0 || t > 1)
        return 0;
    struct wd_vec3 out = wd_v3_unit_or(WD_V3(p.x, p.y, 0), WD_V3(1, 0, 0));
    struct wd_vec3 at = wd_v3_mad(WD_V3(0, 0, p.z), out, form->crown_radius_m);
    float bulge = wd_noise3(form->key, wd_v3_scale(at, 1 / form->lobe_m)) - 0.5f;
    return form->crown_radius_m * profile(form, t) *
           (1 + 2 * form->species->crown_lobes * bulge);
}

/* Where the envelope has no bulges it is narrowest. */
static float least_envelope_m(const struct wd_tree_form *form, float share)
{
    float lobes = wd_clampf(form->species->crown_lobes, 0, 1);
    return 0.999f * (1 - lobes) * form->crown_radius_m * profile(form, share);
}

float wd_tree_envelope_share(const struct wd_tree_form *form, struct wd_vec3 p)
{
    float t = crown_share(form, p.z), beyond = 0;
    if (form->clip)
        return wd_clip_inside(form->clip, p) ? 0.5f : 2;
    if (t > 1)
        beyond = (t - 1) * 8;
    if (t < 0)
        beyond = -t * 3;
    float out = sqrtf(p.x * p.x + p.y * p.y);
    if (t >= 0 && t <= 1 && out <= least_envelope_m(form, t))
        return 1;
    struct wd_vec3 at = WD_V3(p.x, p.y, form->crown_base_m +
                                            wd_clampf(t, 0, 1) *
                                                (form->height_m - form->crown_base_m));
    float radius = wd_tree_envelope_m(form, at);
    float least = 0.04f * form->crown_radius_m;
    return out / (radius > least ? radius : least) + beyond;
}

float wd_tree_envelope_reach_m(const struct wd_tree_form *form, struct wd_vec3 p,
                               struct wd_vec3 d, float limit_m)
{
    enum { STEPS = 12 };
    for (int i = 1; i <= STEPS; i++) {
        float distance = limit_m * (float)i / STEPS;
        if (wd_tree_envelope_share(form, wd_v3_mad(p, d, distance)) > 1)
            return distance - 0.5f * limit_m / STEPS;
    }
    return limit_m;
}

struct wd_vec3 wd_tree_crown_direction(const struct wd_tree_form *form, struct wd_vec3 p)
{
    float length = form->height_m - form->crown_base_m;
    float middle = form->crown_base_m + 0.3f * length;
    float rise = (p.z - middle) * 2 * form->crown_radius_m / length;
    return wd_v3_unit(WD_V3(p.x, p.y, rise + 0.15f * form->crown_radius_m));
}
