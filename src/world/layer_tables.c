/* layer_tables.c: chances as integer thresholds, crowns by height. */
#include "world/placement.h"

#include <math.h>
#include <stdlib.h>

#include "base/dmath.h"
#include "base/memory.h"

static const double hashes = 4294967296.0; /* values a hash can take */

static size_t push(struct wd_placement *placement, uint32_t word)
{
    uint32_t *slot = wd_push(placement->table, placement->table_count, placement->table_capacity);
    *slot = word;
    return placement->table_count - 1;
}

/* False when the chance is so near 1 that no threshold is needed: no hash is above it. */
static bool push_threshold(struct wd_placement *placement, double chance)
{
    double threshold = floor(chance * hashes + 0.5);
    if (threshold >= hashes)
        return false;
    push(placement, threshold > 0.0 ? (uint32_t)threshold : 0);
    return true;
}

static bool push_counts(struct wd_placement *placement, const struct wd_log *log)
{
    const struct wd_scene_layer *layer = placement->layer;
    struct wd_place_layer *to = &placement->input.layer;
    to->count_first = (uint32_t)placement->table_count;
    if (layer->placement == WD_PLACE_GRID) {
        push_threshold(placement, 1.0 - fmin(fmax(layer->density, 0.0), 1.0));
    } else if (layer->placement == WD_PLACE_POISSON) {
        if (!(layer->density >= 0.0 && layer->density <= 64.0))
            return wd_error(log, "%s: density: %g trees a square, 0 .. 64 is allowed; "
                            "take smaller squares (spacing_m)", placement->name, layer->density);
        double term = wd_dexp(-layer->density), sum = term;
        for (int count = 1; push_threshold(placement, sum) && count < 200; count++) {
            term = term * layer->density / (double)count;
            sum += term;
        }
    }
    to->count_size = (uint32_t)placement->table_count - to->count_first;
    return true;
}

double wd_crown_cm(const struct wd_species *species, double height_cm)
{
    double crown_m = wd_species_crown_of_height_m(species, height_cm * 0.01);
    return fmin(fmax(crown_m * 100.0, 1.0), 65535.0);
}

void wd_variant_range_cm(const struct wd_species *species, uint32_t range_cm[2])
{
    float range_m[2];
    wd_species_variant_range_m(species, range_m);
    range_cm[0] = (uint32_t)((double)range_m[0] * 100.0 + 0.5);
    range_cm[1] = (uint32_t)(((double)range_m[1] - (double)range_m[0]) * 100.0 + 0.5);
}

static void push_crowns(struct wd_placement *placement, const struct wd_species *species,
                        uint32_t max_cm)
{
    for (uint32_t step = 0; step <= max_cm / WD_CROWN_STEP_CM + 1; step++)
        push(placement, (uint32_t)(4.0 * wd_crown_cm(species, step * WD_CROWN_STEP_CM) + 0.5));
}

struct pick {
    uint32_t threshold, species;
};

/* Cumulative shares; species that no hash can pick are left out. */
static size_t list_picks(const struct wd_placement *placement, const struct wd_scene *scene,
                         struct pick *picks)
{
    const struct wd_scene_layer *layer = placement->layer;
    double total = 0.0, sum = 0.0, before = 0.0;
    size_t count = 0;
    for (size_t i = 0; i < layer->species_count; i++)
        total += layer->species[i].share;
    for (size_t i = 0; i < layer->species_count; i++) {
        sum += layer->species[i].share;
        double threshold = floor(sum / total * hashes + 0.5);
        if (threshold <= before)
            continue;
        picks[count].threshold = threshold >= hashes ? UINT32_MAX : (uint32_t)threshold;
        picks[count++].species = (uint32_t)wd_scene_find_species(scene, layer->species[i].name);
        before = threshold;
    }
    return count;
}

static bool check_species(const struct wd_placement *placement, const struct wd_scene *scene,
                          const struct wd_log *log)
{
    const struct wd_scene_layer *layer = placement->layer;
    double total = 0.0;
    for (size_t i = 0; i < layer->species_count; i++) {
        const struct wd_scene_share *share = &layer->species[i];
        if (wd_scene_find_species(scene, share->name) < 0)
            return wd_error(log, "%s: species \"%s\" is not in the scene",
                            placement->name, share->name);
        if (!(share->share >= 0.0 && share->share < 1e9))
            return wd_error(log, "%s: share of %s is %g, 0 or more is wanted",
                            placement->name, share->name, share->share);
        total += share->share;
    }
    if (!(total > 0.0))
        return wd_error(log, "%s: no species with a share above 0", placement->name);
    return true;
}

bool wd_layer_tables_init(struct wd_placement *placement, const struct wd_placement_params *params)
{
    struct wd_place_layer *to = &placement->input.layer;
    const struct wd_scene *scene = params->scene;
    if (!check_species(placement, scene, params->log) ||
        !push_counts(placement, params->log))
        return false;
    struct pick *picks = wd_alloc_array(placement->layer->species_count, sizeof *picks);
    size_t count = list_picks(placement, scene, picks);
    /* a canopy raster may hold any height */
    bool canopy = placement->layer->placement == WD_PLACE_CANOPY;
    uint32_t max_cm = canopy ? 12000 : to->height_min_cm + to->height_span_cm;
    uint32_t crown_size = max_cm / WD_CROWN_STEP_CM + 2;
    uint32_t first_crown = (uint32_t)(placement->table_count + count * WD_PLACE_PICK_WORDS);
    to->pick_first = (uint32_t)placement->table_count;
    to->pick_size = (uint32_t)count;
    for (size_t i = 0; i < count; i++) {
        push(placement, picks[i].threshold);
        push(placement, picks[i].species);
        push(placement, first_crown + (uint32_t)i * crown_size);
        push(placement, crown_size);
        uint32_t range_cm[2];
        wd_variant_range_cm(&scene->species[picks[i].species], range_cm);
        push(placement, range_cm[0]);
        push(placement, range_cm[1]);
    }
    for (size_t i = 0; i < count; i++)
        push_crowns(placement, &scene->species[picks[i].species], max_cm);
    free(picks);
    return true;
}
