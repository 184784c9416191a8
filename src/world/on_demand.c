#include "world/on_demand.h"

#include <math.h>
#include <stdlib.h>

#include "base/log.h"
#include "base/memory.h"

/* Half of what a device that binds 128 MiB at once can hold. */
static const double MOST_STORED = 4.0 * 1024.0 * 1024.0;

double wd_demand_density(const struct wd_placement *placement, const double min_m[2],
                         const double max_m[2], uint32_t points)
{
    const struct wd_place_input *input = &placement->input;
    double sum = 0.0, planted = fmin(fmax(placement->layer->density, 0.0), 1.0);
    for (uint32_t i = 0; i < points * points; i++) {
        double at_mm[2];
        for (int axis = 0; axis < 2; axis++) {
            uint32_t step = axis ? i / points : i % points;
            at_mm[axis] =
                1000.0 * (min_m[axis] + (step + 0.5) / points * (max_m[axis] - min_m[axis]));
            at_mm[axis] = fmin(fmax(at_mm[axis], 0.0), input->layer.extent_mm[axis]);
        }
        sum += (double)wd_place_odds_at(input, (int32_t)at_mm[0], (int32_t)at_mm[1], -1.0f).chance;
    }
    return planted * sum / ((double)points * points);
}

/* Of all the ground. */
static double all_trees(const struct wd_placement *placement)
{
    const struct wd_place_layer *numbers = &placement->input.layer;
    const double extent_m[2] = {numbers->extent_mm[0] * 0.001, numbers->extent_mm[1] * 0.001};
    return (double)numbers->columns * numbers->rows *
           wd_demand_density(placement, (double[2]){0.0, 0.0}, extent_m, 512);
}

static double grid_cells(const struct wd_scene_layer *layer, const struct wd_terrain *terrain)
{
    double spacing_m = layer->spacing_m > 0.0 ? layer->spacing_m : 1.0;
    return wd_terrain_extent_x_m(terrain) / spacing_m * wd_terrain_extent_y_m(terrain) / spacing_m *
           layer->density;
}

/* Adds what is to be expected by density and rules. */
static bool add_expected(const struct wd_placement_params *params, size_t layer, double *trees)
{
    struct wd_placement placement;
    bool ok = wd_placement_init(&placement, params, layer);
    if (ok)
        *trees += all_trees(&placement);
    wd_placement_finish(&placement);
    return ok;
}

bool wd_demand_wanted(const struct wd_placement_params *params, bool *wanted)
{
    const struct wd_scene *scene = params->scene;
    double most = 0.0, trees = 0.0;
    *wanted = scene->planting == WD_PLANTING_ON_DEMAND;
    if (scene->planting != WD_PLANTING_AUTO)
        return true;
    for (size_t i = 0; i < scene->layer_count; i++)
        if (scene->layers[i].placement == WD_PLACE_GRID)
            most += grid_cells(&scene->layers[i], params->terrain);
    if (most <= MOST_STORED)
        return true;
    for (size_t i = 0; i < scene->layer_count; i++)
        if (scene->layers[i].placement == WD_PLACE_GRID && !add_expected(params, i, &trees))
            return false;
    *wanted = trees > MOST_STORED;
    return true;
}

/* --- layers ------------------------------------------------------------------------------- */

static uint32_t level_count(const struct wd_place_layer *layer)
{
    uint32_t levels = 1, cells = layer->columns > layer->rows ? layer->columns : layer->rows;
    while ((uint64_t)WD_PAGE_SIDE << (levels - 1) < cells)
        levels++;
    return levels;
}

/* Sizes of its trees: over the shares of species, heights drawn evenly. */
static void describe_trees(struct wd_demand_layer *added, const struct wd_scene *scene)
{
    enum { STEPS = 8 };
    const struct wd_scene_layer *layer = &scene->layers[added->index];
    const struct wd_place_layer *numbers = &added->placement.input.layer;
    double total = 0.0, aspect = (numbers->aspect_min + 0.5 * numbers->aspect_span) / 1024.0;
    for (size_t i = 0; i < layer->species_count; i++) {
        int index = wd_scene_find_species(scene, layer->species[i].name);
        double share = layer->species[i].share / STEPS;
        for (int step = 0; step < STEPS; step++) {
            double height_cm = numbers->height_min_cm + (step + 0.5) / STEPS * numbers->height_span_cm;
            double crown_m = 0.01 * aspect * wd_crown_cm(&scene->species[index], height_cm);
            added->crown_area_m2 += share * 0.7853981633974483 * crown_m * crown_m;
            added->max_crown_m = fmaxf(added->max_crown_m, (float)crown_m);
            total += share;
        }
    }
    added->crown_area_m2 /= total;
    added->max_crown_m *= 1.5f;
    /* as continuum's covered_px, half from above; a usual tree covers a fifth of its height squared */
    double wide_m = sqrt(added->crown_area_m2 / 0.7853981633974483);
    double tall_m = 0.01 * (numbers->height_min_cm + 0.5 * numbers->height_span_cm);
    added->mean_height_m = (float)tall_m;
    double covered_m2 = 0.6 * wide_m * sqrt(0.5 * tall_m * tall_m + 0.5 * wide_m * wide_m);
    added->grain_m = (float)sqrt(covered_m2 / 0.2);
    added->max_height_m = 0.01f * (float)(numbers->height_min_cm + numbers->height_span_cm);
}

void wd_demand_add(struct wd_demand *demand, struct wd_placement *placement,
                   const struct wd_scene *scene, size_t layer, size_t stored)
{
    demand->layers = wd_realloc(demand->layers, (demand->count + 1) * sizeof *demand->layers);
    struct wd_demand_layer *added = &demand->layers[demand->count++];
    *added = (struct wd_demand_layer){.placement = *placement, .index = (uint32_t)layer};
    *placement = (struct wd_placement){0};
    const struct wd_place_layer *numbers = &added->placement.input.layer;
    uint64_t cells = (uint64_t)numbers->columns * numbers->rows;
    added->first_id = (uint32_t)(1 + stored + demand->cells);
    added->levels = level_count(numbers);
    added->trees = all_trees(&added->placement);
    describe_trees(added, scene);
    demand->cells += cells;
    demand->trees += added->trees;
}

void wd_demand_finish(struct wd_demand *demand)
{
    for (uint32_t i = 0; i < demand->count; i++)
        wd_placement_finish(&demand->layers[i].placement);
    free(demand->layers);
    *demand = (struct wd_demand){0};
}

bool wd_demand_is_none(const struct wd_demand *demand, const char *who, const struct wd_log *log)
{
    return demand->count == 0 ||
           wd_error(log,
                    "%s needs all trees in memory, and some %.0f of this world are planted on "
                    "demand: only the method continuum can do with that; ask for fewer trees, or "
                    "set \"planting\" to \"stored\"",
                    who, demand->trees);
}

/* --- trees -------------------------------------------------------------------------------- */

bool wd_demand_tree(const struct wd_demand *demand, const struct wd_page *page, uint32_t index,
                    struct wd_tree *tree)
{
    const struct wd_demand_layer *layer = &demand->layers[page->layer];
    const struct wd_place_input *input = &layer->placement.input;
    struct wd_page_cell cell = wd_page_cell_of(input, *page, index);
    *tree = wd_page_tree(input, layer->first_id, cell);
    return tree->size != 0;
}

bool wd_demand_find(const struct wd_demand *demand, uint32_t id, struct wd_tree *tree)
{
    for (uint32_t i = 0; i < demand->count; i++) {
        const struct wd_demand_layer *layer = &demand->layers[i];
        const struct wd_place_input *input = &layer->placement.input;
        uint32_t offset = id - layer->first_id; /* modulo 2^32, as ids are */
        struct wd_page_cell cell = {offset % input->layer.columns, offset / input->layer.columns};
        if (id != 0 && cell.row < input->layer.rows) {
            *tree = wd_page_tree(input, layer->first_id, cell);
            if (tree->size != 0)
                return true;
        }
    }
    return false;
}
