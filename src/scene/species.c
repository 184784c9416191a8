#include "scene/species.h"

#include <math.h>
#include <stdlib.h>

#include "base/dmath.h"
#include "base/file.h"
#include "scene/species_parts.h"

enum { MAX_SPECIES_BYTES = 1 << 20 };
static const float SAPLING = 0.25f; /* the lowest trees of a sapling layer by their typical height */

bool wd_species_load(struct wd_species *species, const char *path, struct wd_arena *arena,
                     const struct wd_log *log)
{
    *species = (struct wd_species){0};
    char *text;
    size_t size;
    if (wd_species_is_model_file(path))
        return wd_species_of_model_file(species, path, arena, log);
    if (!wd_file_read(path, MAX_SPECIES_BYTES, log, &text, &size))
        return false;
    bool model = wd_species_text_has_model(path, text, size);
    const struct wd_keys *keys = model ? &wd_species_model_keys : &wd_species_keys;
    bool ok = wd_keys_read(keys, path, text, size, arena, log, species);
    species->path = wd_arena_strdup(arena, path);
    species->openness = WD_STAND_OPENNESS;
    free(text);
    return ok;
}

double wd_species_height_m(const struct wd_species *species, double dbh_cm)
{
    const struct wd_allometry *a = &species->allometry;
    if (!(dbh_cm > 0))
        return a->diameter_at_m;
    return a->diameter_at_m +
           a->height_a * wd_dpow(1 - wd_dexp(-a->height_b * dbh_cm), a->height_c);
}

double wd_species_crown_m(const struct wd_species *species, double dbh_cm)
{
    const struct wd_allometry *a = &species->allometry;
    const float *box = species->clip_box_m;
    if (box[2] > 0)
        return 2 * (double)(wd_hedge_reach_m(box[0], box[1]) / box[2]) *
               wd_species_height_m(species, dbh_cm);
    if (species->model.crown_share > 0)
        return (double)species->model.crown_share * wd_species_height_m(species, dbh_cm);
    return a->crown_a + a->crown_b * wd_dpow(dbh_cm > 0 ? dbh_cm : 0, a->crown_c);
}

double wd_species_height_at_age_m(const struct wd_species *species, double age_years)
{
    const struct wd_site_curve *g = &species->growth;
    if (!(age_years > 0))
        return 0;
    return g->height_a * wd_dpow(1 - wd_dexp(-g->height_b * age_years), g->height_c);
}

/* Stem of a free broadleaf over that of others in the open, and the least height per diameter that it makes. */
static const double FREE_STEM = 1.2, LEAST_SLENDER = 31;

/* Where a rising function of one variable reaches `value`. */
static double invert(double (*rising)(const struct wd_species *, double),
                     const struct wd_species *species, double value, double low, double high)
{
    for (int i = 0; i < 60; i++) {
        double middle = 0.5 * (low + high);
        if (rising(species, middle) < value)
            low = middle;
        else
            high = middle;
    }
    return 0.5 * (low + high);
}

double wd_species_dbh_cm(const struct wd_species *species, double height_m)
{
    double least = species->allometry.diameter_at_m > 0 ? 0.5 : 0.01;
    return invert(wd_species_height_m, species, height_m, least, 400);
}

double wd_species_age_years(const struct wd_species *species, double height_m)
{
    return invert(wd_species_height_at_age_m, species, height_m, 0.01,
                  species->growth.span_years);
}

/* The nearest height that has a diameter of its own. */
static double sure_height_m(const struct wd_species *species, double height_m)
{
    const struct wd_allometry *a = &species->allometry;
    double least_m = a->diameter_at_m > 0 ? a->diameter_at_m + 0.7 : 0.01 * a->height_a;
    double most_m = a->diameter_at_m + 0.95 * a->height_a;
    return fmin(fmax(height_m, least_m), fmax(most_m, least_m));
}

double wd_species_stem_of_height_cm(const struct wd_species *species, double height_m)
{
    double sure_m = sure_height_m(species, height_m);
    double stem_cm = wd_species_dbh_cm(species, sure_m) * height_m / sure_m;
    if (species->allometry.diameter_at_m > 0) /* saplings: height at most 150 stem diameters */
        stem_cm = fmax(stem_cm, 100.0 / 150.0 * fmin(height_m, 2.0));
    return stem_cm;
}

double wd_species_free(const struct wd_species *species, double openness)
{
    double beyond = fmin(fmax((openness - 0.4) / (1 - 0.4), 0), 1);
    bool broad = species->form == WD_FORM_BROADLEAF && !species->model.file && species->clip_box_m[2] == 0;
    return broad ? beyond * beyond * (3 - 2 * beyond) * fmin(1.6 * (1 - (double)species->apical_dominance), 1) : 0;
}

double wd_species_open_stem(const struct wd_species *species, double height_m, double openness)
{
    double typical_m = (double)species->typical_height_m, ratio = (double)species->stem_open;
    if (height_m < typical_m)
        ratio *= fmax(1, wd_species_stem_of_height_cm(species, typical_m) * height_m /
                             (typical_m * wd_species_stem_of_height_cm(species, height_m)));
    double stoutest = 100 * height_m / (LEAST_SLENDER * wd_species_stem_of_height_cm(species, height_m));
    double thicker = fmin(fmax(stoutest / ratio, 1), FREE_STEM);
    ratio *= 1 + (thicker - 1) * wd_species_free(species, openness);
    return 1 + (ratio - 1) * openness;
}

double wd_species_open_crown(const struct wd_species *species, double openness)
{
    return 1 + ((double)species->crown_open - 1) * openness;
}

double wd_species_crown_of_height_m(const struct wd_species *species, double height_m)
{
    double sure_m = sure_height_m(species, height_m), open = (double)species->openness;
    double crown_m = 0, stem_cm = wd_species_dbh_cm(species, sure_m);
    if (species->clip_box_m[2] > 0 || species->model.file)
        return wd_species_crown_m(species, stem_cm) * height_m / sure_m;
    crown_m = wd_species_crown_m(species, stem_cm * wd_species_open_stem(species, height_m, open));
    crown_m = crown_m * wd_species_open_crown(species, open) * height_m / sure_m;
    return wd_species_young_crown_m(species, height_m, open, crown_m);
}

float wd_species_youth(const struct wd_species *species, double height_m)
{
    bool tree = species->form == WD_FORM_BROADLEAF || species->form == WD_FORM_CONIFER;
    double share = height_m / (double)species->typical_height_m;
    double grown = fmin(fmax((share - 0.17) / (0.45 - 0.17), 0), 1);
    if (!tree || species->model.file || species->clip_box_m[2] > 0)
        return 0;
    return (float)(1 - grown * grown * (3 - 2 * grown));
}

double wd_species_young_crown_m(const struct wd_species *species, double height_m, double openness,
                                double crown_m)
{
    double youth = (double)wd_species_youth(species, height_m);
    double least_m = height_m * (0.3 + 0.15 * openness), most_m = height_m * (0.5 + 0.4 * openness);
    return crown_m + (fmin(fmax(crown_m, least_m), most_m) - crown_m) * youth;
}

float wd_hedge_reach_m(float width_m, float depth_m)
{
    return sqrtf(width_m * depth_m / (float)WD_PI);
}

/* No variant of usual height fits any of the scene's trees. */
static bool are_saplings(const struct wd_species *species)
{
    const float *planted_m = species->planted_m;
    return planted_m[0] > 0 && planted_m[0] < SAPLING * species->typical_height_m &&
           planted_m[1] < WD_HALF_GROWN * species->typical_height_m &&
           wd_species_youth(species, (double)planted_m[0]) > 0;
}

void wd_species_variant_range_m(const struct wd_species *species, float range_m[2])
{
    if (species->clip_box_m[2] > 0) {
        range_m[0] = range_m[1] = species->clip_box_m[2];
        return;
    }
    float low = WD_HALF_GROWN * species->typical_height_m, high = 1.1f * species->typical_height_m;
    if (are_saplings(species)) {
        low = species->planted_m[0];
        high = species->planted_m[1];
    }
    range_m[0] = low > species->height_range_m[0] ? low : species->height_range_m[0];
    range_m[1] = high < species->height_range_m[1] ? high : species->height_range_m[1];
    if (range_m[1] < range_m[0])
        range_m[1] = range_m[0];
}
