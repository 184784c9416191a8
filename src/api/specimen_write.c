/* Trees and forests as files for other programs. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "api/arguments.h"
#include "api/forest.h"
#include "api/sources.h"
#include "api/specimen.h"
#include "api/tree_list.h"
#include "base/file.h"
#include "base/memory.h"
#include "tree/export.h"
#include "tree/variant.h"

enum { DEFAULT_MAX_TREES = 1000000, GROUND_SIDE = 513 };

enum wd_result wd_specimens_write(const struct wd_specimen *const *specimens, uint32_t count,
                                  const char *path, const struct wd_log *log)
{
    if (!wd_given(path, log) || !wd_specimens_check(specimens, count, log))
        return WD_ERROR_INPUT;
    bool glb = wd_has_ending(path, ".glb");
    if (!glb && !wd_has_ending(path, ".obj")) {
        wd_error(log, "%s: trees are written as .glb or .obj", path);
        return WD_ERROR_INPUT;
    }
    if (wd_specimens_check_output(specimens, count, path) != WD_OK)
        return WD_ERROR_INPUT;
    struct wd_export_tree *trees = wd_alloc_array(count, sizeof *trees);
    for (uint32_t i = 0; i < count; i++) {
        trees[i] = (struct wd_export_tree){
            .name = specimens[i]->species.name,
            .species = &specimens[i]->species,
            .level_count = WD_SPECIMEN_LEVELS,
            .place_m = wd_specimen_place_m(specimens, i),
        };
        for (uint32_t level = 0; level < WD_SPECIMEN_LEVELS; level++)
            trees[i].levels[level] = wd_specimen_mesh(specimens[i], level);
    }
    const struct wd_export what = {.trees = trees, .tree_count = count};
    enum wd_result result = glb                               ? wd_export_glb(&what, path, log)
                            : wd_export_obj(&what, path, log) ? WD_OK
                                                              : WD_ERROR_OUTPUT;
    free(trees);
    return result;
}

/* --- a whole forest ---------------------------------------------------------------------- */

struct scene_export {
    const struct wd_forest *forest;
    struct wd_tree_model *models;
    struct wd_model *described;
    struct wd_export_tree *trees;
    struct wd_export_instance *instances; /* sorted by model */
    struct wd_export_ground ground;
    struct wd_export what;
    uint32_t model_count, variants;
};

static uint32_t model_of(const struct scene_export *export, const struct wd_tree *tree)
{
    return WD_TREE_SPECIES(*tree) * export->variants + WD_TREE_VARIANT(*tree) % export->variants;
}

static enum wd_result grow_models(struct scene_export *export, const struct wd_progress *progress,
                                  const struct wd_log *log)
{
    const struct wd_scene *scene = &export->forest->scene;
    for (uint32_t i = 0; i < export->model_count; i++) {
        if (!wd_progress_report(progress, "growing trees", i, export->model_count))
            return WD_ERROR_INTERRUPTED;
        if (!wd_variant_grow(&export->models[i], scene, i, log))
            return WD_ERROR_INPUT;
        wd_variant_describe(&export->described[i], scene, i, &export->models[i]);
    }
    return WD_OK;
}

static void place_tree(struct wd_export_instance *instance, const struct wd_tree *tree,
                       const struct wd_model *model, const double origin_m[3])
{
    const int32_t at_mm[3] = {tree->x_mm, tree->y_mm, tree->z_mm};
    for (int k = 0; k < 3; k++)
        instance->position_m[k] = (float)(at_mm[k] * 0.001 - origin_m[k]);
    float across = WD_TREE_CROWN_M(*tree) / model->crown_m;
    instance->yaw_rad = WD_TREE_YAW(*tree);
    instance->across = WD_TREE_IS_MIRRORED(*tree) ? -across : across;
    instance->up = WD_TREE_HEIGHT_M(*tree) / model->height_m;
    instance->id = tree->id;
}

/* Counting sort by model. */
static enum wd_result place_trees(struct scene_export *export, const struct wd_progress *progress)
{
    enum { TREES_A_REPORT = 100000 };
    const struct wd_world *world = &export->forest->world;
    enum wd_result result = WD_OK;
    size_t *next = wd_alloc_array(export->model_count + 1, sizeof *next);
    export->instances = wd_alloc_array(world->tree_count + 1, sizeof *export->instances);
    for (size_t i = 0; i < world->tree_count; i++)
        next[model_of(export, &world->trees[i]) + 1]++;
    for (uint32_t m = 0; m < export->model_count; m++)
        next[m + 1] += next[m];
    for (uint32_t m = 0; m < export->model_count; m++) {
        uint32_t count = (uint32_t)(next[m + 1] - next[m]);
        if (count == 0)
            continue;
        const struct wd_species *species = &export->forest->scene.species[m / export->variants];
        export->trees[export->what.tree_count++] = (struct wd_export_tree){
            .name = species->name,
            .species = species,
            .levels = {&export->models[m].full, &export->models[m].reduced},
            .level_count = 2,
            .instances = export->instances + next[m],
            .instance_count = count,
        };
    }
    for (size_t i = 0; i < world->tree_count && result == WD_OK; i++) {
        uint32_t m = model_of(export, &world->trees[i]);
        if (i % TREES_A_REPORT == 0 &&
            !wd_progress_report(progress, "placing trees", i, world->tree_count))
            result = WD_ERROR_INTERRUPTED;
        place_tree(&export->instances[next[m]++], &world->trees[i], &export->described[m],
                   export->what.origin_m);
    }
    free(next);
    return result;
}

static void ground_vertex(const struct scene_export *export, const double step_m[2], uint32_t x,
                          uint32_t y, float position[3], float normal[3])
{
    const struct wd_terrain *terrain = &export->forest->world.terrain;
    const double *origin = export->what.origin_m;
    double at[2] = {x * step_m[0], y * step_m[1]};
    double slope_x = (wd_terrain_height(terrain, at[0] + step_m[0], at[1]) -
                      wd_terrain_height(terrain, at[0] - step_m[0], at[1])) / (2 * step_m[0]);
    double slope_y = (wd_terrain_height(terrain, at[0], at[1] + step_m[1]) -
                      wd_terrain_height(terrain, at[0], at[1] - step_m[1])) / (2 * step_m[1]);
    double length = sqrt(slope_x * slope_x + slope_y * slope_y + 1);
    position[0] = (float)(at[0] - origin[0]);
    position[1] = (float)(at[1] - origin[1]);
    position[2] = (float)(wd_terrain_height(terrain, at[0], at[1]) - origin[2]);
    normal[0] = (float)(-slope_x / length);
    normal[1] = (float)(-slope_y / length);
    normal[2] = (float)(1 / length);
}

static enum wd_result make_ground(struct scene_export *export, const struct wd_progress *progress)
{
    enum { SIDE = GROUND_SIDE, QUADS = SIDE - 1 };
    const struct wd_terrain *terrain = &export->forest->world.terrain;
    const double step_m[2] = {wd_terrain_extent_x_m(terrain) / QUADS,
                              wd_terrain_extent_y_m(terrain) / QUADS};
    float(*positions)[3] = wd_alloc_array((size_t)SIDE * SIDE, sizeof *positions);
    float(*normals)[3] = wd_alloc_array((size_t)SIDE * SIDE, sizeof *normals);
    uint32_t *indices = wd_alloc_array((size_t)QUADS * QUADS, 6 * sizeof *indices), *to = indices;
    bool going = true;
    for (uint32_t y = 0; y < SIDE && going; y++) {
        going = wd_progress_report(progress, "making ground", y, SIDE);
        for (uint32_t x = 0; x < SIDE; x++) {
            uint32_t a = y * SIDE + x;
            ground_vertex(export, step_m, x, y, positions[a], normals[a]);
            if (x == QUADS || y == QUADS)
                continue;
            const uint32_t quad[6] = {a, a + 1, a + SIDE, a + SIDE, a + 1, a + SIDE + 1};
            memcpy(to, quad, sizeof quad);
            to += 6;
        }
    }
    export->ground = (struct wd_export_ground){
        .positions_m = (const float(*)[3])positions,
        .normals = (const float(*)[3])normals,
        .vertex_count = SIDE * SIDE,
        .indices = indices,
        .index_count = 6 * QUADS * QUADS,
    };
    memcpy(export->ground.color, export->forest->scene.ground.grass, sizeof export->ground.color);
    export->what.ground = &export->ground;
    return going ? WD_OK : WD_ERROR_INTERRUPTED;
}

static void finish(struct scene_export *export)
{
    for (uint32_t i = 0; i < export->model_count; i++)
        wd_tree_model_finish(&export->models[i]);
    free(export->models);
    free(export->described);
    free(export->trees);
    free(export->instances);
    free((void *)export->ground.positions_m);
    free((void *)export->ground.normals);
    free((void *)export->ground.indices);
}

enum wd_result wd_forest_write(const struct wd_forest *forest, const char *path, uint64_t max_trees,
                               const struct wd_progress *progress, const struct wd_log *log)
{
    if (!wd_given(forest, log) || !wd_given(path, log))
        return WD_ERROR_INPUT;
    const struct wd_terrain *terrain = &forest->world.terrain;
    bool csv = wd_has_ending(path, ".csv");
    uint64_t most = max_trees ? max_trees : csv ? UINT64_MAX : DEFAULT_MAX_TREES;
    struct scene_export export = {.forest = forest, .variants = (uint32_t)forest->scene.variants};
    if (!wd_demand_is_none(&forest->world.demand, path, log) ||
        !wd_scene_check_output(&forest->scene, path, log))
        return WD_ERROR_INPUT;
    if (!csv && !wd_has_ending(path, ".glb")) {
        wd_error(log, "%s: forests are written as .glb or .csv", path);
        return WD_ERROR_INPUT;
    }
    if (forest->world.tree_count > most) {
        wd_error(log, "%s: the forest has %zu trees; at most %llu are written", path,
                 forest->world.tree_count, (unsigned long long)most);
        return WD_ERROR_INPUT;
    }
    if (csv)
        return wd_tree_list_write(forest, path, progress, log);
    export.model_count = (uint32_t)forest->scene.species_file_count * export.variants;
    export.models = wd_alloc_array(export.model_count + 1, sizeof *export.models);
    export.described = wd_alloc_array(export.model_count + 1, sizeof *export.described);
    export.trees = wd_alloc_array(export.model_count + 1, sizeof *export.trees);
    double *origin = export.what.origin_m;
    origin[0] = 0.5 * wd_terrain_extent_x_m(terrain);
    origin[1] = 0.5 * wd_terrain_extent_y_m(terrain);
    origin[2] = wd_terrain_height(terrain, origin[0], origin[1]);
    enum wd_result result = grow_models(&export, progress, log);
    if (result == WD_OK)
        result = place_trees(&export, progress);
    if (result == WD_OK)
        result = make_ground(&export, progress);
    if (result == WD_OK) {
        export.what.trees = export.trees;
        export.what.progress = progress;
        export.what.crs = terrain->crs;
        origin[0] += terrain->origin_m[0]; /* what is placed is placed: this is for the reader */
        origin[1] += terrain->origin_m[1];
        result = wd_export_glb(&export.what, path, log);
    }
    finish(&export);
    return result;
}
