/* world.h: a scene come to life: ground, standing trees, octree. Pure CPU. */
#ifndef WD_WORLD_WORLD_H
#define WD_WORLD_WORLD_H

#include "world/octree.h"
#include "world/on_demand.h"
#include "world/sky_map.h"
#include "world/terrain.h"
#include "world/tree_tags.h"

struct wd_world_params {
    uint32_t seed;          /* used when has_seed; else the scene's */
    bool has_seed;
    unsigned threads;       /* 0: all */
    uint64_t max_trees;     /* 0: 64 million; more is an error that says so */
    const struct wd_tree *trees; /* planted first, as they are but for their ids; NULL: none */
    size_t tree_count;
    const struct wd_progress *progress;
    const struct wd_log *log;
};

/* What became of an inventory's rows: each is counted once, but with the rule "keep" those outside
 * are planted as well. invalid: without a position; duplicates: place, species, sizes and id as
 * in an earlier row. */
struct wd_inventory_report {
    uint64_t rows, planted, dead, duplicates, outside, invalid;
};

/* Local frame: metres east, north, up; local (0, 0) is the terrain's south-west corner
 * (terrain.origin_m in projected coordinates), z 0 is the terrain's vertical datum. */
struct wd_world {
    struct wd_terrain terrain;
    struct wd_tree *trees;          /* in octree order; ids 1.. follow the order of placement:
                                       inventories by row, then layers by cell */
    size_t tree_count;
    uint32_t *tree_of_id;           /* tree_of_id[id] is an index into trees; [0] unused */
    uint64_t *species_counts;       /* parallel to scene->species; of layers on demand expected */
    uint8_t *layer_of_tree;         /* parallel to trees: layer index; 255: inventory */
    struct wd_tree_tags tags;       /* by id: of inventories' trees their rows, and what they are called where a
                                       column says so */
    struct wd_inventory_report *inventories; /* parallel to scene->inventories */
    struct wd_demand demand;        /* layers of which nothing else here says anything */
    struct wd_octree octree;
    struct wd_sky_map sky;          /* {0}, or what whoever made the world has loaded into it */
    /* Canopy cover of the ground, 0..255, on a grid of cover_cell_m over the terrain, for the
     * colour of the forest floor. */
    uint8_t *cover;
    /* Crowns of what is lower, herbs and swards, over the ground that they stand on (WD_SWARD_LAYER is
     * once). NULL: there are none, or on demand. */
    uint8_t *sward;
    struct wd_far_sward {
        float albedo[3]; /* of those that fade with distance, as they are seen from above */
        float share;     /* of these in all */
        float fade_m[2]; /* distances over which they do; 0, 0: none does */
    } far_sward;
    uint32_t cover_width, cover_height;
    double cover_cell_m;
    uint32_t seed;
};

/* Reads the inventories, makes the ground, plants. Made-up ground lies where inventories with
 * projected coordinates are; flat ground of size 0 x 0 m fits the inventories with 50 m to spare,
 * and then local coordinates too count from its terrain.origin_m. The same world for any number of
 * threads. On failure, or when the progress report asks to stop, `*world` is `{0}`. */
bool wd_world_init(struct wd_world *world, const struct wd_scene *scene,
                   const struct wd_world_params *params);
/* The same without the layers' trees: their maps are read, and of canopies few of the heights. The world has its
 * terrain and the reports of inventories alone. */
bool wd_world_check(struct wd_world *world, const struct wd_scene *scene,
                    const struct wd_world_params *params);
void wd_world_finish(struct wd_world *world);

/* Whether it has any trees, stored or on demand. */
bool wd_world_has_trees(const struct wd_world *world);
/* The tree of that id, stored or on demand; false: none has it. */
bool wd_world_find_tree(const struct wd_world *world, uint32_t id, struct wd_tree *tree);

/* xxh64 over all trees in id order: equal worlds have equal hashes on every machine. Of
 * layers on demand, over what their trees follow from. */
uint64_t wd_world_hash(const struct wd_world *world);

#endif
