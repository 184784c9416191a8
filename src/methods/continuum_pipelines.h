/* continuum_pipelines.h: what the passes of continuum run (shaders/shared/continuum.h). */
#ifndef WD_METHODS_CONTINUUM_PIPELINES_H
#define WD_METHODS_CONTINUUM_PIPELINES_H

#include "methods/tree_draw.h"
#include "shared/continuum.h"

/* What is rasterised. */
enum {
    WD_SHAPE_SPLATS,
    WD_SHAPE_SMALL, /* splats of small trees */
    WD_SHAPE_BOTH,  /* both at once, in place of these where lanes are many */
    WD_SHAPE_WOOD,
    WD_SHAPES
};

struct wd_continuum_pipelines {
    struct wd_pipeline cull, args[2]; /* [1]: that begins the second round */
    struct wd_pipeline choose[2], choose_again; /* [WD_PASS_*] */
    struct wd_pipeline sort;
    struct wd_pipeline draw[WD_SHAPES][2][2]; /* [][WD_PASS_*][1: ids of the second pass] */
    struct wd_pipeline large[2];                 /* triangles that wood's have listed; [WD_PASS_*] */
    struct wd_pipeline depth[2], resolve[2];     /* [1: wood] */
    struct wd_pipeline resolve_all;              /* in their place where targets can be stored to */
    struct wd_pipeline cascade, cascade_store;   /* one of both, likewise */
    struct wd_pipeline pyramid[WD_PYRAMID_LEVELS - 1], pyramid_of_trees; /* its finest levels */
    VkSampler nearest;
};

/* False, with a message, where the device cannot; finish all the same. */
bool wd_continuum_pipelines_init(struct wd_continuum_pipelines *pipelines, struct wd_gpu *gpu);
void wd_continuum_pipelines_finish(struct wd_continuum_pipelines *pipelines, struct wd_gpu *gpu);

#endif
