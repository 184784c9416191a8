/* continuum_forest.h: what the method `continuum` makes of a forest. */
#ifndef WD_METHODS_CONTINUUM_FOREST_H
#define WD_METHODS_CONTINUUM_FOREST_H

#include "forest/forest.h"
#include "shared/continuum.h"

/* Heights are counted in steps of so many centimetres. */
enum { WD_HEIGHT_STEPS = 256, WD_HEIGHT_STEP_CM = 25 };

struct wd_continuum_forest {
    struct wd_buffer clusters; /* struct wd_cluster[cluster_count], then those of pages */
    struct wd_buffer splats;   /* struct wd_splat[WD_SPLATS] a model */
    struct wd_buffer looks;    /* uint32_t, parallel: see shared/continuum.h */
    struct wd_buffer lit;      /* uint32_t, parallel */
    struct wd_buffer wood;     /* struct wd_splat_corner of all models, and triangles of them */
    struct wd_buffer models;   /* struct wd_splat_model a model */
    uint32_t cluster_count;
    float *grains;     /* [model]: as in struct wd_splat_model */
    float coarsest_m;  /* the greatest grain of a stored tree */
    uint32_t taller[WD_HEIGHT_STEPS]; /* [i]: stored trees of i steps and more; [0]: all */
};

/* Samples the splats of every model and gathers the trees in clusters. */
bool wd_continuum_forest_init(struct wd_continuum_forest *own, struct wd_gpu *gpu,
                              struct wd_forest_device *forest);
void wd_continuum_forest_finish(struct wd_continuum_forest *own, struct wd_gpu *gpu);

/* Clusters of trees[count] in octree order: runs of at most WD_CLUSTER_TREES that no octant's own
 * trees and descendants straddle without need. Returns their number; `*clusters` is to be freed. */
uint32_t wd_clusters_make(struct wd_cluster **clusters, const struct wd_octree *octree,
                          const struct wd_tree *trees);

#endif
