/* placement.h: the scene's layers as trees. What a cell holds is told by shaders/shared/placement.h;
 * here that function is given its tables and run over all cells. */
#ifndef WD_WORLD_PLACEMENT_H
#define WD_WORLD_PLACEMENT_H

#include "base/log.h"
#include "shared/placement.h"
#include "world/raster.h"

/* Trees in the order of their ids: trees[i].id is i + 1. */
struct wd_tree_list {
    struct wd_tree *trees;
    size_t count, capacity;
};

/* Adds a copy; its id becomes its place in the list. */
void wd_tree_list_add(struct wd_tree_list *list, const struct wd_tree *tree);
void wd_tree_list_finish(struct wd_tree_list *list);

struct wd_axis wd_axis_of(double cell_mm); /* 2 <= cell_mm < 2^31 */

/* What all layers of a world share. */
struct wd_placement_params {
    const struct wd_scene *scene;
    const struct wd_terrain *terrain;
    uint32_t seed;
    unsigned threads;
    uint64_t max_trees; /* of the whole list */
    const struct wd_progress *progress;
    const struct wd_log *log;
};

/* Points at the terrain's arrays. False where the terrain is too large for whole millimetres. */
bool wd_ground_input_init(struct wd_ground_input *input, const struct wd_placement_params *params);

/* A layer made ready: its numbers, probability map and tables. */
struct wd_placement {
    struct wd_place_input input;
    float *map;
    uint32_t *table;
    size_t table_count, table_capacity;
    const struct wd_scene_layer *layer;
    char name[64]; /* for messages */
};
bool wd_placement_init(struct wd_placement *placement, const struct wd_placement_params *params,
                       size_t layer_index);
void wd_placement_finish(struct wd_placement *placement);

/* Plants the layer. The same trees in the same order for any number of threads. False when there
 * are too many, or when the caller wants to stop. */
bool wd_placement_fill(const struct wd_placement *placement,
                       const struct wd_placement_params *params, struct wd_tree_list *list);

/* Parts of the above. */
bool wd_canopy_fill(const struct wd_placement *placement, const struct wd_placement_params *params,
                    struct wd_tree_list *list);
/* What the raster itself makes it say, without a tree; all of it is read. */
bool wd_canopy_check(const struct wd_placement *placement, const struct wd_placement_params *params);
bool wd_layer_map_load(struct wd_placement *placement, const struct wd_placement_params *params);
/* What a map's value says, 0..1. */
float wd_map_probability(const struct wd_scene_map *map, float value);
bool wd_layer_tables_init(struct wd_placement *placement, const struct wd_placement_params *params);
bool wd_too_many_trees(const struct wd_placement_params *params, const char *what);

/* Heights that a species' variants stand for: where they begin, and how far they reach. */
void wd_variant_range_cm(const struct wd_species *species, uint32_t range_cm[2]);

/* Crown diameter in cm of a tree of that height by its species' allometry. */
double wd_crown_cm(const struct wd_species *species, double height_cm);

#endif
