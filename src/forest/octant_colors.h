/* octant_colors.h: six colours for every octant of a forest, and clusters of them (Guerrero 2006,
 * rows G2 and G4). */
#ifndef WD_FOREST_OCTANT_COLORS_H
#define WD_FOREST_OCTANT_COLORS_H

#include "forest/forest.h"
#include "shared/octant.h"

enum {
    WD_OCTANT_PIXELS = 16,   /* a side of an octant's picture, where params say 0 */
    WD_CLUSTER_PIXELS = 8,   /* a side of a cell's */
    WD_CLUSTER_SIZE = 12,    /* cells a side of a cluster (the paper's) */
    WD_CLUSTER_SIZE_MAX = 32,
};

/* {0} is valid. */
struct wd_octant_bake_params {
    uint32_t pixels;       /* a side of one picture: 1 .. 64 */
    uint32_t cluster_size; /* of clusters only: 2 .. WD_CLUSTER_SIZE_MAX */
    float least_alpha;     /* of clusters only: cells whose sides all cover less are dropped;
                              0: 0.02 */
    enum wd_octant_average {
        WD_OCTANT_LAYERED, /* a parent's side: the far layer of children shows through the near */
        WD_OCTANT_PLAIN,   /* the mean of all children's sides, as in the paper */
    } average;
    const struct wd_progress *progress;
    const struct wd_log *log;
};

/* What each octant of forest->world->octree holds within its tight cube, in the octree's order:
 * trees of its own level are rendered from six sides and averaged, children are added bottom-up. */
struct wd_octant_colors {
    struct wd_octant_look *looks; /* [count] */
    uint32_t count;
    uint64_t bytes, baked_us;
    uint32_t renders; /* pictures that were taken */
};
bool wd_octant_colors_bake(struct wd_octant_colors *colors, struct wd_gpu *gpu,
                           struct wd_forest_device *forest,
                           const struct wd_octant_bake_params *params);
void wd_octant_colors_finish(struct wd_octant_colors *colors); /* accepts {0} */

/* A cell of a cluster that shows something. */
struct wd_cluster_cell {
    uint32_t at; /* x in bits 0..7, y in 8..15, z in 16..23 from the cube's least corner */
    struct wd_octant_look look;
};
/* A grid of cluster_size^3 cells over each chosen octant's cube, of all its subtree's trees. */
struct wd_octant_clusters {
    struct wd_cluster_cell *cells;
    uint32_t cell_count;
    uint32_t *first_cell; /* [octant_count + 1]: of the i-th chosen octant */
    uint32_t octant_count, cluster_size;
    uint64_t bytes, baked_us;
    uint32_t renders;
};
bool wd_octant_clusters_bake(struct wd_octant_clusters *clusters, struct wd_gpu *gpu,
                             struct wd_forest_device *forest, const uint32_t *octants,
                             uint32_t octant_count, const struct wd_octant_bake_params *params);
void wd_octant_clusters_finish(struct wd_octant_clusters *clusters); /* accepts {0} */

#endif
