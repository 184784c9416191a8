#include "api/forest.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>

#include "api/arguments.h"
#include "api/sky_file.h"
#include "base/memory.h"
#include "tree/import.h"
#include "world/river.h"

static bool parse_seed(const char *text, uint32_t *seed, const struct wd_log *log)
{
    char *end;
    errno = 0;
    unsigned long long value = strtoull(text, &end, 10);
    if (text[0] < '0' || text[0] > '9' || *end || errno || value > UINT32_MAX)
        return wd_error(log, "seed \"%s\": a whole number from 0 to 4294967295 is wanted", text);
    *seed = (uint32_t)value;
    return true;
}

/* Tells a failure of the input from a wish to stop. */
struct watch {
    const struct wd_progress *progress;
    bool stopped;
};

static bool watch_report(void *user, const char *stage, uint64_t done, uint64_t total)
{
    struct watch *watch = user;
    if (!wd_progress_report(watch->progress, stage, done, total))
        watch->stopped = true;
    return !watch->stopped;
}

enum wd_result wd_forest_create(struct wd_forest **result, const struct wd_forest_params *params)
{
    *result = NULL;
    if (!wd_given(params, NULL) || !wd_given(params->scene_path, &params->log))
        return WD_ERROR_INPUT;
    struct wd_forest *forest = wd_alloc(sizeof *forest);
    forest->log = params->log;
    const struct wd_scene_params scene = {.data_dir = params->data_dir,
                                          .settings = params->settings};
    struct watch watch = {&params->progress, false};
    const struct wd_progress progress = {watch_report, &watch};
    struct wd_world_params world = {
        .has_seed = params->seed != NULL,
        .threads = params->threads,
        .max_trees = params->max_trees,
        .progress = &progress,
        .log = &forest->log,
    };
    enum wd_result failure = WD_ERROR_INPUT;
    if ((params->seed && !parse_seed(params->seed, &world.seed, &forest->log)) ||
        !wd_scene_load_with(&forest->scene, params->scene_path, &scene, &forest->log) ||
        !wd_forest_key_files(forest, params) ||
        !wd_species_import_models(forest->scene.species, forest->scene.species_file_count,
                                  &progress, &forest->log) ||
        !wd_world_init(&forest->world, &forest->scene, &world) ||
        !wd_scene_check_places(&forest->scene, &forest->world.terrain, &forest->log) ||
        (failure = wd_sky_file_load(&forest->world.sky, &forest->scene, &forest->log)) != WD_OK) {
        wd_forest_destroy(&forest);
        return watch.stopped ? WD_ERROR_INTERRUPTED : failure;
    }
    *result = forest;
    return WD_OK;
}

void wd_forest_destroy(struct wd_forest **forest)
{
    if (!forest || !*forest)
        return;
    wd_world_finish(&(*forest)->world);
    if (!(*forest)->scene.individuals) /* specimens keep their own */
        wd_species_drop_models((*forest)->scene.species,
                               (*forest)->scene.species_file_count);
    wd_scene_finish(&(*forest)->scene);
    free(*forest);
    *forest = NULL;
}

static uint64_t host_bytes(const struct wd_world *world)
{
    const struct wd_terrain *terrain = &world->terrain;
    uint64_t samples = (uint64_t)terrain->width * terrain->height;
    return samples * (sizeof *terrain->height_m + (terrain->hole ? 1 : 0)) +
           world->tree_count * (sizeof *world->trees + sizeof *world->tree_of_id + 1) +
           world->tags.count * sizeof *world->tags.places + world->tags.size +
           world->tags.row_count * sizeof *world->tags.rows +
           (uint64_t)world->octree.count * sizeof *world->octree.octants +
           (uint64_t)world->octree.tight_count * sizeof *world->octree.tight_trees +
           (uint64_t)world->cover_width * world->cover_height;
}

void wd_forest_get_info(const struct wd_forest *forest, struct wd_forest_info *info)
{
    const struct wd_world *world = &forest->world;
    const struct wd_terrain *terrain = &world->terrain;
    *info = (struct wd_forest_info){
        .name = forest->scene.name,
        .tree_count = world->tree_count + (uint64_t)world->demand.trees,
        .last_id = (uint32_t)fmin((double)world->tree_count + (double)world->demand.cells,
                                  (double)UINT32_MAX),
        .on_demand = world->demand.count > 0,
        .species_count = (uint32_t)forest->scene.species_file_count,
        .layer_count = (uint32_t)forest->scene.layer_count,
        .inventory_count = (uint32_t)forest->scene.inventory_count,
        .max_m = {wd_terrain_extent_x_m(terrain), wd_terrain_extent_y_m(terrain), terrain->max_m},
        .min_m = {0.0, 0.0, terrain->min_m},
        .origin_m = {terrain->origin_m[0], terrain->origin_m[1]},
        .crs = terrain->crs,
        .host_bytes = host_bytes(world),
        .hash = wd_world_hash(world),
        .seed = world->seed,
        .octant_count = world->octree.count,
        .octree_depth = world->octree.depth,
        .terrain_cell_m = terrain->cell_m,
        .terrain_ha = wd_terrain_extent_x_m(terrain) * wd_terrain_extent_y_m(terrain) * 1e-4,
    };
    if (world->octree.count) {
        const struct wd_octant *root = &world->octree.octants[0];
        for (int k = 0; k < 3; k++) {
            if (root->min_m[k] < info->min_m[k])
                info->min_m[k] = root->min_m[k];
            if (root->max_m[k] > info->max_m[k])
                info->max_m[k] = root->max_m[k];
        }
    }
}

bool wd_forest_get_species(const struct wd_forest *forest, uint32_t index,
                           struct wd_species_info *info)
{
    if (index >= forest->scene.species_file_count)
        return false;
    const struct wd_species *species = &forest->scene.species[index];
    *info = (struct wd_species_info){
        .name = forest->scene.species_files[index].name,
        .latin = species->latin,
        .tree_count = forest->world.species_counts[index],
    };
    return true;
}

bool wd_forest_get_inventory(const struct wd_forest *forest, uint32_t index,
                             struct wd_inventory_info *info)
{
    if (index >= forest->scene.inventory_count)
        return false;
    const struct wd_inventory_report *report = &forest->world.inventories[index];
    *info = (struct wd_inventory_info){
        .file = forest->scene.inventories[index].file,
        .rows = report->rows,
        .planted = report->planted,
        .dead = report->dead,
        .duplicates = report->duplicates,
        .outside = report->outside,
        .invalid = report->invalid,
    };
    return true;
}

bool wd_forest_get_tree(const struct wd_forest *forest, uint32_t id, struct wd_tree_info *info)
{
    struct wd_tree tree;
    if (!wd_world_find_tree(&forest->world, id, &tree))
        return false;
    *info = (struct wd_tree_info){
        .id = id,
        .species = WD_TREE_SPECIES(tree),
        .position_m = {tree.x_mm * 0.001, tree.y_mm * 0.001, tree.z_mm * 0.001},
        .height_m = WD_TREE_HEIGHT_CM(tree) * 0.01,
        .crown_diameter_m = WD_TREE_CROWN_CM(tree) * 0.01,
        .yaw_rad = (double)WD_TREE_YAW(tree),
    };
    return true;
}

double wd_forest_ground_m(const struct wd_forest *forest, double x_m, double y_m)
{
    return wd_terrain_height(&forest->world.terrain, x_m, y_m);
}

double wd_forest_water_m(const struct wd_forest *forest, double x_m, double y_m)
{
    const struct wd_terrain *terrain = &forest->world.terrain;
    double level_m = forest->scene.water.enabled ? forest->scene.water.level_m : -(double)INFINITY;
    if (wd_river_covers(terrain, x_m, y_m))
        level_m = fmax(level_m, (double)wd_river_level(terrain, x_m, y_m));
    return level_m > wd_terrain_height(terrain, x_m, y_m) ? level_m : -(double)INFINITY;
}

void wd_forest_get_render_defaults(const struct wd_forest *forest,
                                   struct wd_render_defaults *defaults)
{
    *defaults = (struct wd_render_defaults){
        .width = (uint32_t)forest->scene.quality.width,
        .height = (uint32_t)forest->scene.quality.height,
        .samples = (uint32_t)forest->scene.quality.samples,
        .method = forest->scene.method,
    };
}
