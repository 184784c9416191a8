#include "tree/grow.h"

#include <math.h>

static bool refuse(const struct wd_species *species, const struct wd_log *log, const char *what,
                   double found, double low, double high)
{
    return wd_error(log, "cannot grow %s with %s %g; allowed is %g to %g", species->name, what,
                    found, low, high);
}

static double open_stem(const struct wd_species *species, const struct wd_grow_params *params,
                        double height_m)
{
    return wd_species_open_stem(species, height_m, (double)params->openness);
}

/* The height whose stem in this much light has the diameter. */
static double height_of_dbh_m(const struct wd_species *species,
                              const struct wd_grow_params *params, double dbh_cm)
{
    double low = 0.01, high = 200;
    for (int i = 0; i < 50; i++) {
        double middle = 0.5 * (low + high);
        double stem_cm = wd_species_stem_of_height_cm(species, middle) *
                         open_stem(species, params, middle);
        if (stem_cm < dbh_cm)
            low = middle;
        else
            high = middle;
    }
    return 0.5 * (low + high);
}

static bool resolve_height(struct wd_grow_params *params, const struct wd_species *species,
                           const struct wd_log *log)
{
    double height = (double)params->height_m, age = (double)params->age_years;
    double dbh_cm = 100 * (double)params->dbh_m, span = species->growth.span_years;
    if (age != 0 && height != 0)
        return wd_error(log, "cannot grow %s %g years old and %g m high; allowed is one of the two",
                        species->name, age, height);
    if (age != 0 && !(age > 0 && age <= span))
        return wd_error(log, "cannot grow %s %g years old; its species file allows 0 to %g",
                        species->name, age, span);
    if (dbh_cm != 0 && !(dbh_cm > 0 && dbh_cm <= 2000))
        return refuse(species, log, "dbh_m", (double)params->dbh_m, 0, 20);
    if (age != 0)
        height = wd_species_height_at_age_m(species, age);
    else if (height == 0 && dbh_cm != 0)
        height = params->openness > 0 ? height_of_dbh_m(species, params, dbh_cm)
                                      : wd_species_height_m(species, dbh_cm);
    else if (height == 0)
        height = (double)species->typical_height_m;
    double low = (double)species->height_range_m[0], high = (double)species->height_range_m[1];
    if (age != 0 || (params->height_m == 0 && dbh_cm != 0)) /* what follows is kept in range */
        height = fmin(fmax(height, low), high);
    if (!(height >= low && height <= high))
        return wd_error(log, "cannot grow %s %g m high; its species file allows %g to %g m",
                        species->name, height, low, high);
    params->height_m = (float)height;
    return true;
}

/* Stems three times as thick or thin as the allometry says are no longer the species' form. */
static bool resolve_dbh(struct wd_grow_params *params, const struct wd_species *species,
                        const struct wd_log *log)
{
    double height = (double)params->height_m, found = (double)params->dbh_m;
    double usual = 0.01 * wd_species_stem_of_height_cm(species, height) *
                   open_stem(species, params, height);
    if (found == 0)
        params->dbh_m = (float)usual;
    else if (!(found >= usual / 3 && found <= usual * 3))
        return wd_error(log, "cannot grow %s %g m high with dbh_m %g; allowed is %.3g to %.3g",
                        species->name, height, found, usual / 3, usual * 3);
    return true;
}

static float clip_top_m(const struct wd_clip_volume *clip)
{
    float top = clip->triangle_count ? -INFINITY : clip->max_m[2];
    for (uint32_t i = 0; clip->triangle_count && i < clip->vertex_count; i++)
        top = fmaxf(top, clip->positions_m[3 * i + 2]);
    return top;
}

bool wd_grow_params_resolve(struct wd_grow_params *params, const struct wd_species *species,
                            const struct wd_log *log)
{
    if (!(params->openness >= 0 && params->openness <= 1))
        return refuse(species, log, "openness", (double)params->openness, 0, 1);
    if (!(params->detail >= 0 && params->detail <= 8))
        return wd_error(log, "cannot grow %s with detail %g; allowed is 0 (meaning 1) to 8",
                        species->name, (double)params->detail);
    if (params->clip && (params->height_m != 0 || params->dbh_m != 0 || params->age_years != 0))
        return wd_error(log, "cannot grow %s to a clip volume and to a size; allowed is one of the "
                             "two", species->name);
    if (params->clip)
        params->height_m = clip_top_m(params->clip);
    if (!resolve_height(params, species, log) || !resolve_dbh(params, species, log))
        return false;
    if (params->age_years == 0)
        params->age_years = (float)wd_species_age_years(species, (double)params->height_m);
    if (params->detail == 0)
        params->detail = 1;
    return true;
}
