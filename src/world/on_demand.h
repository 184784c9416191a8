/* on_demand.h: layers whose trees are a function of where they stand and are never stored: what a
 * page of such a layer holds is told by shaders/shared/page.h. */
#ifndef WD_WORLD_ON_DEMAND_H
#define WD_WORLD_ON_DEMAND_H

#include "shared/page.h"
#include "world/placement.h"

/* A layer that is planted when somebody looks. */
struct wd_demand_layer {
    struct wd_placement placement;
    uint32_t index;      /* of the scene's layers */
    uint32_t first_id;   /* of cell (0, 0) */
    uint32_t levels;     /* one page of level levels - 1 holds all of it */
    double trees;        /* expected */
    double crown_area_m2; /* mean of a tree */
    float grain_m;       /* height of a usual tree that covers as much of a picture as the mean one */
    float mean_height_m, max_height_m, max_crown_m;
};

struct wd_demand {
    struct wd_demand_layer *layers;
    uint32_t count;
    uint64_t cells; /* of all layers */
    double trees;   /* expected */
};

/* `*wanted`: grids are to be planted on demand, as the scene's "planting" says; "auto": where more
 * trees are to be expected of them than some device can hold. False: a layer cannot be made
 * ready, and it has been said why. */
bool wd_demand_wanted(const struct wd_placement_params *params, bool *wanted);

/* Takes the placement over, whose layer is the scene's. Ids begin after `stored` trees. */
void wd_demand_add(struct wd_demand *demand, struct wd_placement *placement,
                   const struct wd_scene *scene, size_t layer, size_t stored);
void wd_demand_finish(struct wd_demand *demand); /* accepts {0} */

/* For `who` needs every tree of the world by itself: whether all of them are stored, or else one
 * error. */
bool wd_demand_is_none(const struct wd_demand *demand, const char *who, const struct wd_log *log);

/* Mean probability, over `points` x `points` places of a rectangle of the ground, that a cell's tree
 * stands: density and rules. */
double wd_demand_density(const struct wd_placement *placement, const double min_m[2],
                         const double max_m[2], uint32_t points);

/* Tree `index` of a page; false: none stands there. */
bool wd_demand_tree(const struct wd_demand *demand, const struct wd_page *page, uint32_t index,
                    struct wd_tree *tree);

/* The tree of that id; false: none has it. Of worlds with more than 2^32 cells the first one. */
bool wd_demand_find(const struct wd_demand *demand, uint32_t id, struct wd_tree *tree);

#endif
