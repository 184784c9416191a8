#include "scene/species.h"

#include <stdlib.h>

#include "base/dmath.h"
#include "base/file.h"

enum { MAX_SPECIES_BYTES = 1 << 20 };

bool wd_species_load(struct wd_species *species, const char *path, struct wd_arena *arena,
                     const struct wd_log *log)
{
    *species = (struct wd_species){0};
    char *text;
    size_t size;
    if (!wd_file_read(path, MAX_SPECIES_BYTES, log, &text, &size))
        return false;
    bool ok = wd_keys_read(&wd_species_keys, path, text, size, arena, log, species);
    free(text);
    return ok;
}

double wd_species_height_m(const struct wd_species *species, double dbh_cm)
{
    const struct wd_allometry *a = &species->allometry;
    if (!(dbh_cm > 0))
        return 1.3;
    return 1.3 + a->height_a * wd_dpow(1 - wd_dexp(-a->height_b * dbh_cm), a->height_c);
}

double wd_species_crown_m(const struct wd_species *species, double dbh_cm)
{
    const struct wd_allometry *a = &species->allometry;
    return a->crown_a + a->crown_b * wd_dpow(dbh_cm > 0 ? dbh_cm : 0, a->crown_c);
}

double wd_species_dbh_cm(const struct wd_species *species, double height_m)
{
    double low = 0.5, high = 400;
    for (int i = 0; i < 60; i++) {
        double middle = 0.5 * (low + high);
        if (wd_species_height_m(species, middle) < height_m)
            low = middle;
        else
            high = middle;
    }
    return 0.5 * (low + high);
}
