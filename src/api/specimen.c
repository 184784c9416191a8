#include "api/specimen.h"

#include <stdlib.h>
#include <string.h>

#include "api/arguments.h"
#include "base/file.h"
#include "base/memory.h"

/* The file of a species by name, or the file itself. */
static bool find_source(struct wd_specimen *specimen, const char *source)
{
    bool file = wd_species_is_model_file(source) || wd_has_ending(source, ".json");
    specimen->source = file ? wd_strdup(source) : wd_species_find_file(source, &specimen->log);
    return specimen->source != NULL;
}

/* A model is as it is, in any season. */
static bool check_model(const struct wd_specimen *specimen, const struct wd_specimen_params *params)
{
    const struct {
        const char *name;
        double value;
    } grown[] = {{"seed", params->seed},         {"dbh_m", params->dbh_m},   {"age_years", params->age_years},
                 {"openness", params->openness}, {"detail", params->detail}, {"month", params->month}};
    for (size_t i = 0; i < sizeof grown / sizeof *grown; i++)
        if (grown[i].value != 0)
            return wd_error(&specimen->log, "%s: found %s %g; it is a model, for which a height alone is allowed",
                            specimen->source, grown[i].name, grown[i].value);
    if (!(params->height_m >= 0 && params->height_m <= 130))
        return wd_error(&specimen->log, "%s: cannot be made %g m high; allowed is 0 to 130", specimen->source,
                        params->height_m);
    return true;
}

static bool load_species(struct wd_specimen *specimen, const struct wd_specimen_params *params)
{
    struct wd_species *species = &specimen->species;
    if (!find_source(specimen, params->source) ||
        !wd_species_load(species, specimen->source, &specimen->arena, &specimen->log))
        return false;
    if (species->model.file) {
        if (!check_model(specimen, params))
            return false;
        if (params->height_m > 0)
            species->model.height_m = (float)params->height_m;
        return wd_species_import_models(species, 1, NULL, &specimen->log);
    }
    struct wd_species whole = *species;
    return params->month == 0 ||
           wd_species_in_month(species, &whole, params->month, &specimen->log);
}

char *wd_species_names(void)
{
    struct wd_arena arena = {0};
    const char **names;
    size_t count = wd_species_list(&names, &arena), length = 1;
    for (size_t i = 0; i < count; i++)
        length += strlen(names[i]) + 1;
    char *text = wd_alloc(length), *end = text;
    for (size_t i = 0; i < count; i++)
        end = stpcpy(stpcpy(end, names[i]), "\n");
    wd_arena_finish(&arena);
    return text;
}

enum wd_result wd_specimen_create(struct wd_specimen **result,
                                  const struct wd_specimen_params *params)
{
    *result = NULL;
    if (!wd_given(params, NULL) || !wd_given(params->source, &params->log))
        return WD_ERROR_INPUT;
    struct wd_specimen *specimen = wd_alloc(sizeof *specimen);
    specimen->log = params->log;
    specimen->month = params->month;
    specimen->params = (struct wd_grow_params){
        .seed = params->seed ? params->seed : 1,
        .height_m = (float)params->height_m,
        .dbh_m = (float)params->dbh_m,
        .age_years = (float)params->age_years,
        .openness = (float)params->openness,
        .detail = (float)params->detail,
    };
    if (!load_species(specimen, params) ||
        !wd_specimen_set_clip(specimen, params->clip) ||
        !wd_tree_grow(&specimen->model, &specimen->species, &specimen->params, &specimen->log)) {
        wd_specimen_destroy(&specimen);
        return WD_ERROR_INPUT;
    }
    *result = specimen;
    return WD_OK;
}

void wd_specimen_destroy(struct wd_specimen **specimen)
{
    if (!specimen || !*specimen)
        return;
    wd_tree_model_finish(&(*specimen)->model);
    wd_species_drop_models(&(*specimen)->species, 1);
    wd_clip_mesh_finish(&(*specimen)->clip_mesh);
    wd_arena_finish(&(*specimen)->arena);
    free((*specimen)->source);
    free(*specimen);
    *specimen = NULL;
}

void wd_specimen_get_info(const struct wd_specimen *specimen, struct wd_specimen_info *info)
{
    const struct wd_tree_model *model = &specimen->model;
    *info = (struct wd_specimen_info){
        .name = specimen->species.name,
        .latin = specimen->species.latin,
        .height_m = (double)model->height_m,
        .crown_diameter_m = 2 * (double)model->crown_radius_m,
        .crown_base_m = (double)model->crown_base_m,
        .dbh_m = (double)model->dbh_m,
        .age_years = (double)model->age_years,
        .leaf_area_m2 = (double)model->leaf_area_m2,
        .level_count = WD_SPECIMEN_LEVELS,
    };
}

const struct wd_tree_mesh *wd_specimen_mesh(const struct wd_specimen *specimen, uint32_t level)
{
    return level == 0 ? &specimen->model.full : &specimen->model.reduced;
}

bool wd_specimen_get_level(const struct wd_specimen *specimen, uint32_t level,
                           struct wd_specimen_level *info)
{
    if (level >= WD_SPECIMEN_LEVELS)
        return false;
    const struct wd_tree_mesh *mesh = wd_specimen_mesh(specimen, level);
    *info = (struct wd_specimen_level){mesh->vertex_count, mesh->wood_index_count / 3,
                                       (mesh->index_count - mesh->wood_index_count) / 3};
    return true;
}

static double half_width_m(const struct wd_specimen *specimen)
{
    const struct wd_tree_mesh *mesh = &specimen->model.full;
    double low = -(double)mesh->min_m[0], high = (double)mesh->max_m[0];
    return (low > high ? low : high) + 0.05 * (double)specimen->model.height_m;
}

double wd_specimen_place_m(const struct wd_specimen *const *specimens, uint32_t index)
{
    double at = 0;
    for (uint32_t i = 1; i <= index; i++)
        at += half_width_m(specimens[i - 1]) + half_width_m(specimens[i]);
    return at;
}

bool wd_specimens_check(const struct wd_specimen *const *specimens, uint32_t count,
                        const struct wd_log *log)
{
    if (count == 0)
        return wd_error(log, "count is 0: at least one specimen is needed");
    if (!specimens)
        return wd_error(log, "specimens is NULL: a list of %u is needed", count);
    for (uint32_t i = 0; i < count; i++)
        if (!specimens[i])
            return wd_error(log, "specimens[%u] is NULL: a specimen is needed", i);
    return true;
}
