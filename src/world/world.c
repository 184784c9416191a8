#include "world/world.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "base/memory.h"
#include "world/cover.h"
#include "world/far_sward.h"
#include "world/inventory.h"
#include "world/placement.h"
#include "world/river.h"
#include "world/stand_ins.h"

static const uint64_t default_max_trees = UINT64_C(64) << 20;
enum { INVENTORY_LAYER = 255 };

/* The layer of each tree of the list: layers follow one another there. */
struct layer_ends {
    size_t *ends; /* ends[i]: trees in the list once layer i was planted */
    size_t inventory_end;
};

static bool plant_layer(const struct wd_placement_params *params, size_t index,
                        struct wd_tree_list *list)
{
    struct wd_placement placement;
    size_t before = list->count;
    bool ok = wd_placement_init(&placement, params, index) &&
              wd_placement_fill(&placement, params, list);
    if (ok)
        wd_info(params->log, "%s: %zu trees", placement.name, list->count - before);
    wd_placement_finish(&placement);
    return ok;
}

static bool plant_layers(const struct wd_placement_params *params, bool all,
                         struct wd_tree_list *list, struct layer_ends *layers)
{
    layers->inventory_end = list->count;
    for (size_t i = 0; i < params->scene->layer_count; i++) {
        bool now = all || params->scene->layers[i].placement != WD_PLACE_GRID;
        if (now && !plant_layer(params, i, list))
            return false;
        layers->ends[i] = list->count;
    }
    return true;
}

static void tell_unasked(const struct wd_scene *scene, const struct wd_scene_layer *layer, const char *name,
                         const struct wd_log *log)
{
    for (size_t i = 0; i < layer->species_count; i++) {
        int species = wd_scene_find_species(scene, layer->species[i].name);
        const struct wd_species *of = species >= 0 ? &scene->species[species] : NULL;
        if (of && (of->when_young || of->in_the_open)) {
            wd_warn(log, "%s: %s: is planted on demand, where \"when_young\" and \"in_the_open\" have no effect; "
                    "\"planting\": \"stored\" keeps the trees", scene->path, name);
            return;
        }
    }
}

/* After the others: their ids follow those of stored trees. */
static bool add_demand(struct wd_demand *demand, const struct wd_placement_params *params,
                       size_t stored)
{
    for (size_t i = 0; i < params->scene->layer_count; i++) {
        struct wd_placement placement;
        if (params->scene->layers[i].placement != WD_PLACE_GRID)
            continue;
        if (!wd_placement_init(&placement, params, i))
            return false;
        wd_info(params->log, "%s: planted on demand", placement.name);
        tell_unasked(params->scene, placement.layer, placement.name, params->log);
        wd_demand_add(demand, &placement, params->scene, i, stored);
    }
    return true;
}

static uint8_t layer_of(const struct layer_ends *layers, uint32_t id)
{
    if (id <= layers->inventory_end)
        return INVENTORY_LAYER;
    size_t layer = 0;
    while (id > layers->ends[layer])
        layer++;
    return (uint8_t)layer;
}

/* Takes the list's trees: octree order, and the tables beside them. */
static void index_trees(struct wd_world *world, struct wd_tree_list *list,
                        const struct layer_ends *layers, const struct wd_scene *scene)
{
    world->trees = list->trees;
    world->tree_count = list->count;
    *list = (struct wd_tree_list){0};
    wd_octree_init(&world->octree, world->trees, world->tree_count,
                   &(struct wd_octree_params){
                       .max_depth = (uint32_t)scene->methods.octree.max_depth,
                       .leaf_trees = (uint32_t)scene->methods.octree.leaf_trees});
    world->tree_of_id = wd_alloc_array(world->tree_count + 1, sizeof *world->tree_of_id);
    world->layer_of_tree = wd_alloc(world->tree_count);
    world->species_counts = wd_alloc_array(scene->species_file_count,
                                           sizeof *world->species_counts);
    for (size_t i = 0; i < world->tree_count; i++) {
        const struct wd_tree *tree = &world->trees[i];
        world->tree_of_id[tree->id] = (uint32_t)i;
        world->layer_of_tree[i] = layer_of(layers, tree->id);
        world->species_counts[WD_TREE_SPECIES(*tree)]++;
    }
}

/* Species of layers on demand, by their shares. */
static void count_expected(struct wd_world *world, const struct wd_scene *scene)
{
    for (uint32_t i = 0; i < world->demand.count; i++) {
        const struct wd_scene_layer *layer = &scene->layers[world->demand.layers[i].index];
        double total = 0.0;
        for (size_t k = 0; k < layer->species_count; k++)
            total += layer->species[k].share;
        for (size_t k = 0; k < layer->species_count; k++) {
            int species = wd_scene_find_species(scene, layer->species[k].name);
            world->species_counts[species] +=
                (uint64_t)(world->demand.layers[i].trees * layer->species[k].share / total);
        }
    }
}

static bool plant(struct wd_world *world, const struct wd_placement_params *params,
                  struct wd_tree_list *list)
{
    const struct wd_scene *scene = params->scene;
    struct layer_ends layers = {.ends = wd_alloc_array(scene->layer_count, sizeof(size_t))};
    bool on_demand;
    bool ok = wd_demand_wanted(params, &on_demand) &&
              plant_layers(params, !on_demand, list, &layers) &&
              (!on_demand || add_demand(&world->demand, params, list->count)) &&
              wd_trees_stand_in(list, layers.inventory_end, &world->tags, params);
    uint64_t count = list->count;
    ok = ok && wd_progress_report(params->progress, "sorting trees", 0, count);
    if (ok) {
        index_trees(world, list, &layers, scene);
        count_expected(world, scene);
        wd_cover_init(world, params->threads);
        wd_far_sward_init(world, scene);
        ok = wd_progress_report(params->progress, "sorting trees", count, count);
    }
    free(layers.ends);
    return ok;
}

/* Layers are made ready and no more. */
static bool check_layers(struct wd_world *world, const struct wd_placement_params *params,
                         struct wd_tree_list *list)
{
    (void)world, (void)list;
    bool ok = true;
    for (size_t i = 0; i < params->scene->layer_count; i++) {
        struct wd_placement placement;
        bool ready = wd_placement_init(&placement, params, i);
        bool canopy = ready && placement.layer->placement == WD_PLACE_CANOPY;
        ok = ready && (!canopy || wd_canopy_check(&placement, params)) && ok;
        wd_placement_finish(&placement);
    }
    return ok;
}

static bool plant_inventories(struct wd_world *world, struct wd_inventory *inventories, bool fitted,
                              const struct wd_placement_params *params, struct wd_tree_list *list)
{
    for (size_t i = 0; i < params->scene->inventory_count; i++) {
        if (!wd_inventory_plant(&inventories[i], params, i, fitted, list, &world->tags))
            return false;
        world->inventories[i] = inventories[i].report;
    }
    return true;
}

/* What becomes of the layers, once the ground is made and inventories are planted. */
typedef bool plant_function(struct wd_world *world, const struct wd_placement_params *params,
                            struct wd_tree_list *list);

static bool make(struct wd_world *world, struct wd_inventory *inventories,
                 struct wd_placement_params *params, plant_function *layers,
                 struct wd_tree_list *list)
{
    const struct wd_scene *scene = params->scene;
    bool fitted, loaded = true;
    for (size_t i = 0; i < scene->inventory_count; i++) {
        loaded = wd_inventory_load(&inventories[i], scene, i, params->log) && loaded;
        if (!wd_progress_report(params->progress, "reading inventories", i + 1, scene->inventory_count))
            return false;
    }
    if (!loaded)
        return false;
    if (!wd_world_make_terrain(&world->terrain, inventories, params, &fitted))
        return false;
    if (!wd_rivers_init(&world->terrain, scene, params->log))
        return false;
    params->terrain = &world->terrain;
    world->inventories = wd_alloc_array(scene->inventory_count, sizeof *world->inventories);
    return plant_inventories(world, inventories, fitted, params, list) &&
           layers(world, params, list);
}

static bool init(struct wd_world *world, const struct wd_scene *scene,
                 const struct wd_world_params *params, plant_function *layers)
{
    *world = (struct wd_world){0};
    world->seed = params->has_seed ? params->seed : (uint32_t)scene->seed;
    struct wd_placement_params placement = {
        .scene = scene,
        .seed = world->seed,
        .threads = params->threads,
        .max_trees = params->max_trees ? params->max_trees : default_max_trees,
        .progress = params->progress,
        .log = params->log,
    };
    if (placement.max_trees > UINT32_MAX - 1)
        placement.max_trees = UINT32_MAX - 1;
    if (scene->layer_count >= INVENTORY_LAYER)
        return wd_error(params->log, "%s: %zu layers, at most %d are allowed", scene->path,
                        scene->layer_count, INVENTORY_LAYER - 1);
    struct wd_tree_list list = {0};
    for (size_t i = 0; i < params->tree_count; i++)
        wd_tree_list_add(&list, &params->trees[i]);
    struct wd_inventory *inventories = wd_alloc_array(scene->inventory_count, sizeof *inventories);
    bool ok = make(world, inventories, &placement, layers, &list);
    for (size_t i = 0; i < scene->inventory_count; i++)
        wd_inventory_finish(&inventories[i]);
    free(inventories);
    wd_tree_list_finish(&list);
    if (!ok)
        wd_world_finish(world);
    return ok;
}

bool wd_world_init(struct wd_world *world, const struct wd_scene *scene,
                   const struct wd_world_params *params)
{
    return init(world, scene, params, plant);
}

bool wd_world_check(struct wd_world *world, const struct wd_scene *scene,
                    const struct wd_world_params *params)
{
    return init(world, scene, params, check_layers);
}

void wd_world_finish(struct wd_world *world)
{
    wd_terrain_finish(&world->terrain);
    wd_octree_finish(&world->octree);
    free(world->trees);
    free(world->tree_of_id);
    free(world->species_counts);
    free(world->layer_of_tree);
    wd_tree_tags_finish(&world->tags);
    free(world->inventories);
    free(world->cover);
    free(world->sward);
    wd_demand_finish(&world->demand);
    wd_sky_map_finish(&world->sky);
    *world = (struct wd_world){0};
}

bool wd_world_has_trees(const struct wd_world *world)
{
    return world->tree_count > 0 || world->demand.count > 0;
}

bool wd_world_find_tree(const struct wd_world *world, uint32_t id, struct wd_tree *tree)
{
    if (id == 0 || id > world->tree_count)
        return wd_demand_find(&world->demand, id, tree);
    *tree = world->trees[world->tree_of_id[id]];
    return true;
}

/* The same on machines of either byte order. */
static void hash_words(XXH64_state_t *state, const uint32_t *words, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const unsigned char bytes[4] = {(unsigned char)words[i], (unsigned char)(words[i] >> 8),
                                        (unsigned char)(words[i] >> 16),
                                        (unsigned char)(words[i] >> 24)};
        XXH64_update(state, bytes, sizeof bytes);
    }
}

/* Members of 32 bits each, none of them an address. */
static void hash_layer(XXH64_state_t *state, const struct wd_place_layer *layer)
{
    static_assert(sizeof *layer % sizeof(uint32_t) == 0, "a layer is whole words");
    uint32_t words[sizeof *layer / sizeof(uint32_t)];
    memcpy(words, layer, sizeof words);
    hash_words(state, words, sizeof words / sizeof *words);
}

static void hash_map(XXH64_state_t *state, const struct wd_placement *placement)
{
    const struct wd_place_layer *layer = &placement->input.layer;
    for (size_t i = 0; i < (size_t)layer->map_width * layer->map_height; i++) {
        uint32_t word;
        memcpy(&word, &placement->map[i], sizeof word);
        hash_words(state, &word, 1);
    }
}

/* Layers on demand: their rules and what their maps and tables hold. */
static void hash_demand(XXH64_state_t *state, const struct wd_demand *demand)
{
    for (uint32_t i = 0; i < demand->count; i++) {
        const struct wd_placement *placement = &demand->layers[i].placement;
        hash_layer(state, &placement->input.layer);
        hash_words(state, &demand->layers[i].first_id, 1);
        hash_words(state, placement->table, placement->table_count);
        if (placement->map)
            hash_map(state, placement);
    }
}

uint64_t wd_world_hash(const struct wd_world *world)
{
    XXH64_state_t *state = XXH64_createState();
    XXH64_reset(state, 0);
    for (size_t id = 1; id <= world->tree_count; id++) {
        const struct wd_tree *tree = &world->trees[world->tree_of_id[id]];
        const uint32_t words[7] = {
            (uint32_t)tree->x_mm, (uint32_t)tree->y_mm, (uint32_t)tree->z_mm, tree->id,
            tree->kind,           tree->size,           tree->look,
        };
        hash_words(state, words, 7);
    }
    hash_demand(state, &world->demand);
    uint64_t hash = XXH64_digest(state);
    XXH64_freeState(state);
    return hash;
}
