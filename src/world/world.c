#include "world/world.h"

#include <inttypes.h>
#include <stdlib.h>
#include <xxhash.h>

#include "base/memory.h"
#include "world/cover.h"
#include "world/inventory.h"
#include "world/placement.h"

static const uint64_t default_max_trees = UINT64_C(64) << 20;
enum { INVENTORY_LAYER = 255 };

/* The layer of each tree of the list: layers follow one another there. */
struct layer_ends {
    size_t *ends; /* ends[i]: trees in the list once layer i was planted */
    size_t inventory_end;
};

static bool plant_layers(const struct wd_placement_params *params, struct wd_tree_list *list,
                         struct layer_ends *layers)
{
    layers->inventory_end = list->count;
    for (size_t i = 0; i < params->scene->layer_count; i++) {
        struct wd_placement placement;
        size_t before = list->count;
        bool ok = wd_placement_init(&placement, params, i) &&
                  wd_placement_fill(&placement, params, list);
        if (ok)
            wd_info(params->log, "%s: %zu trees", placement.name, list->count - before);
        wd_placement_finish(&placement);
        if (!ok)
            return false;
        layers->ends[i] = list->count;
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
                        const struct layer_ends *layers, const struct wd_scene *scene,
                        unsigned threads)
{
    world->trees = list->trees;
    world->tree_count = list->count;
    *list = (struct wd_tree_list){0};
    wd_octree_init(&world->octree, world->trees, world->tree_count,
                   &(struct wd_octree_params){
                       .max_depth = (uint32_t)scene->methods.octree.max_depth,
                       .leaf_trees = (uint32_t)scene->methods.octree.leaf_trees,
                       .threads = threads});
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

static bool plant(struct wd_world *world, struct wd_inventory *inventories, bool fitted,
                  const struct wd_placement_params *params, struct wd_tree_list *list)
{
    const struct wd_scene *scene = params->scene;
    for (size_t i = 0; i < scene->inventory_count; i++) {
        if (!wd_inventory_plant(&inventories[i], params, i, fitted, list))
            return false;
        world->inventories[i] = inventories[i].report;
    }
    struct layer_ends layers = {.ends = wd_alloc_array(scene->layer_count, sizeof(size_t))};
    bool ok = plant_layers(params, list, &layers);
    uint64_t count = list->count;
    ok = ok && wd_progress_report(params->progress, "sorting trees", 0, count);
    if (ok) {
        index_trees(world, list, &layers, scene, params->threads);
        wd_cover_init(world);
        ok = wd_progress_report(params->progress, "sorting trees", count, count);
    }
    free(layers.ends);
    return ok;
}

static bool make(struct wd_world *world, struct wd_inventory *inventories,
                 struct wd_placement_params *params, struct wd_tree_list *list)
{
    const struct wd_scene *scene = params->scene;
    for (size_t i = 0; i < scene->inventory_count; i++)
        if (!wd_inventory_load(&inventories[i], scene, i, params->log) ||
            !wd_progress_report(params->progress, "reading inventories", i + 1,
                                scene->inventory_count))
            return false;
    bool fitted;
    if (!wd_world_make_terrain(&world->terrain, inventories, params, &fitted))
        return false;
    params->terrain = &world->terrain;
    world->inventories = wd_alloc_array(scene->inventory_count, sizeof *world->inventories);
    return plant(world, inventories, fitted, params, list);
}

bool wd_world_init(struct wd_world *world, const struct wd_scene *scene,
                   const struct wd_world_params *params)
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
    bool ok = make(world, inventories, &placement, &list);
    for (size_t i = 0; i < scene->inventory_count; i++)
        wd_inventory_finish(&inventories[i]);
    free(inventories);
    wd_tree_list_finish(&list);
    if (!ok)
        wd_world_finish(world);
    return ok;
}

void wd_world_finish(struct wd_world *world)
{
    wd_terrain_finish(&world->terrain);
    wd_octree_finish(&world->octree);
    free(world->trees);
    free(world->tree_of_id);
    free(world->species_counts);
    free(world->layer_of_tree);
    free(world->inventories);
    free(world->cover);
    *world = (struct wd_world){0};
}

uint64_t wd_world_hash(const struct wd_world *world)
{
    XXH64_state_t *state = XXH64_createState();
    XXH64_reset(state, 0);
    for (size_t id = 1; id <= world->tree_count; id++) {
        const struct wd_tree *tree = &world->trees[world->tree_of_id[id]];
        const uint32_t words[8] = {
            (uint32_t)tree->x_mm, (uint32_t)tree->y_mm, (uint32_t)tree->z_mm, tree->id,
            tree->kind,           tree->size,           tree->look,           tree->random,
        };
        unsigned char bytes[32];
        for (int i = 0; i < 32; i++)
            bytes[i] = (unsigned char)(words[i / 4] >> (i % 4 * 8));
        XXH64_update(state, bytes, sizeof bytes);
    }
    uint64_t hash = XXH64_digest(state);
    XXH64_freeState(state);
    return hash;
}
